#include "nodes/mapping/dpds_decode.h"

#include <limits>
#include <numbers>
#include <stdexcept>

#include "nodes/latent/sequences.h"
#include "nodes/mapping/scaling.h"
#include "nodes/types/best_path.h"

namespace talkgraph {

namespace {

constexpr double kNone = -std::numeric_limits<double>::infinity();  ///< score of a path whose points have overflowed

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
  Front advance(const Front& front, Origins& from) const {
    Front next = front;
    for (Eigen::Index k = 0; k < next.scores.size(); ++k) {
      next.scores[k] = (front.scores + transitions_.col(k)).maxCoeff(&from[k]);
      next.points.row(k) = front.points.row(from[k]).cwiseProduct(model_.prediction.row(k)) + model_.offset.row(k);
    }
    return next;
  }

  void observe(Front& front, const Eigen::RowVectorXd& frame) const {
    const Eigen::VectorXd distances = (front.points.rowwise() - frame).cwiseAbs2() * precision_.transpose();
    front.scores.array() -= 0.5 * (distances.array() + constant_);
    front.scores = front.scores.array().isFinite().select(front.scores, kNone);
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
  std::vector<Origins> from(static_cast<std::size_t>(frames.rows()), Origins::Zero(model.first.rows()));
  Front front = viterbi.begin();
  for (Eigen::Index t = 0; t < frames.rows(); ++t) {
    if (t > 0) front = viterbi.advance(front, from[static_cast<std::size_t>(t)]);
    if (!visual.is_lost(t)) viterbi.observe(front, frames.row(t));
  }
  Eigen::Index last = 0;
  if (!(front.scores.maxCoeff(&last) > kNone))
    throw std::runtime_error(
        "the points of the deterministic process dynamical system grow beyond all bounds before the track ends: train "
        "it with a `bound` below 1");
  for (const Eigen::Index phone : trace_back(from, last))
    decoded.labels.push_back(model.chain.phones[static_cast<std::size_t>(phone)]);
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
