#include "nodes/mapping/dpds_decode.h"

#include <numbers>

#include "nodes/latent/sequences.h"
#include "nodes/mapping/scaling.h"

namespace talkgraph {

namespace {

/// The likeliest paths to all states of a frame.
struct Front {
  Eigen::VectorXd scores;  ///< K
  Eigen::MatrixXd points;  ///< x_t, K × D
};

class ApproximateViterbi {
 public:
  explicit ApproximateViterbi(const Dpds& model)
      : model_(model),
        transitions_(model.chain.transitions.array().log()),
        constant_((2 * std::numbers::pi * model.noise.array()).log().sum()),
        precision_(model.noise.cwiseInverse()) {}

  Front begin() const { return {model_.chain.start.array().log(), model_.first}; }

  /// The paths one frame on, and the state that each came from.
  Front advance(const Front& front, std::vector<Eigen::Index>& from) const {
    Front next = front;
    for (Eigen::Index k = 0; k < next.scores.size(); ++k) {
      Eigen::Index best = 0;
      next.scores[k] = (front.scores + transitions_.col(k)).maxCoeff(&best);
      next.points.row(k) = front.points.row(best).cwiseProduct(model_.prediction.row(k)) + model_.offset.row(k);
      from[static_cast<std::size_t>(k)] = best;
    }
    return next;
  }

  void observe(Front& front, const Eigen::RowVectorXd& frame) const {
    const Eigen::VectorXd distances = (front.points.rowwise() - frame).cwiseAbs2() * precision_.transpose();
    front.scores.array() -= 0.5 * (distances.array() + constant_);
  }

 private:
  const Dpds& model_;
  Eigen::MatrixXd transitions_;
  double constant_;
  Eigen::RowVectorXd precision_;
};

}  // namespace

FrameLabels DecodeDpds::operator()(const Dpds& model, const Track& visual) const {
  FrameLabels decoded{{}, visual.rate};
  if (visual.frames() == 0) return decoded;
  require_frames_of(visual, model.first.cols(), "the deterministic process dynamical system");
  const Eigen::MatrixXd frames = scaled(model.visual, visual.values);
  const ApproximateViterbi viterbi(model);
  const std::vector<Eigen::Index> none(model.chain.phones.size());
  std::vector<std::vector<Eigen::Index>> from(static_cast<std::size_t>(frames.rows()), none);
  Front front = viterbi.begin();
  for (Eigen::Index t = 0; t < frames.rows(); ++t) {
    if (t > 0) front = viterbi.advance(front, from[static_cast<std::size_t>(t)]);
    if (!visual.is_lost(t)) viterbi.observe(front, frames.row(t));
  }
  Eigen::Index state = 0;
  front.scores.maxCoeff(&state);
  decoded.labels.resize(from.size());
  for (std::size_t t = from.size(); t-- > 0;) {
    decoded.labels[t] = model.chain.phones[static_cast<std::size_t>(state)];
    state = from[t][static_cast<std::size_t>(state)];
  }
  return decoded;
}

void describe(Description<DecodeDpds>& d) {
  d.type("mapping.dpds_decode").version(1);
  d.summary("the phones of a face by a deterministic process dynamical system");
  d.source("Thesis §5.1.2; Englebienne 2009");
  d.input("model", "of mapping.dpds")
      .input("visual", "visual parameters that the model was trained on")
      .output("labels", "the likeliest phone of each frame, by approximate Viterbi");
}

}  // namespace talkgraph
