#include "nodes/mapping/slds_decode.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "nodes/latent/lds.h"
#include "nodes/latent/sequences.h"
#include "nodes/mapping/scaling.h"
#include "nodes/mapping/slds.h"
#include "nodes/types/best_path.h"

namespace talkgraph {

namespace {

constexpr double kNone = -std::numeric_limits<double>::infinity();

/// The likeliest path to a phone of a frame: what a filter along it knows of the state, and its score.
struct Path {
  LdsBelief belief;
  double score = kNone;  ///< log-likelihood of the frames, and log-probability of the phones
};

class ApproximateViterbi {
 public:
  ApproximateViterbi(const Slds& model, SldsStream stream)
      : start_(model.chain.start.array().log()), transitions_(model.chain.transitions.array().log()) {
    const Eigen::Index heard = model.audio.mean.size(), seen = model.visual.mean.size();
    const bool audio = stream == SldsStream::audio;
    for (const std::string& phone : model.chain.phones)
      filters_.emplace_back(observed_part(system_of(model, phone), audio ? 0 : heard, audio ? heard : seen));
  }

  std::vector<Path> begin(const Eigen::RowVectorXd* frame) const {
    std::vector<Path> paths;
    for (std::size_t k = 0; k < filters_.size(); ++k) {
      LdsBelief belief = filters_[k](nullptr, frame);
      const double score = start_[static_cast<Eigen::Index>(k)] + belief.log_likelihood;
      paths.push_back({std::move(belief), score});
    }
    return paths;
  }

  /// The paths one frame on, and the phone that each came from.
  std::vector<Path> advance(const std::vector<Path>& before, const Eigen::RowVectorXd* frame, Origins& from) const {
    std::vector<Path> paths(before.size());
    for (std::size_t k = 0; k < paths.size(); ++k)
      for (std::size_t j = 0; j < before.size(); ++j) {
        if (!(before[j].score > kNone)) continue;
        LdsBelief belief = filters_[k](&before[j].belief, frame);
        const auto origin = static_cast<Eigen::Index>(j), phone = static_cast<Eigen::Index>(k);
        const double score = before[j].score + transitions_(origin, phone) + belief.log_likelihood;
        if (!(score > paths[k].score)) continue;
        paths[k] = {std::move(belief), score};
        from[phone] = origin;
      }
    return paths;
  }

 private:
  Eigen::VectorXd start_;
  Eigen::MatrixXd transitions_;
  std::vector<LdsFilter> filters_;  ///< of each phone, of the stream alone
};

}  // namespace

FrameLabels DecodeSlds::operator()(const Slds& model, const Track& track, Context& context) const {
  FrameLabels decoded{{}, track.rate};
  if (track.frames() == 0) return decoded;
  const Scaling& scaling = stream == SldsStream::audio ? model.audio : model.visual;
  if (scaling.mean.size() == 0)
    throw std::runtime_error(stream == SldsStream::audio
                                 ? "the switching linear dynamical system gives the face alone: train it with `sound`"
                                 : "the switching linear dynamical system gives no face");
  require_frames_of(track, scaling.mean.size(), "the switching linear dynamical system");
  const Eigen::MatrixXd frames = scaled(scaling, track.values);
  const ApproximateViterbi viterbi(model, stream);
  const auto phones = static_cast<Eigen::Index>(model.chain.phones.size());
  std::vector<Origins> from(static_cast<std::size_t>(frames.rows()), Origins::Zero(phones));
  std::vector<Path> paths;
  for (Eigen::Index t = 0; t < frames.rows(); ++t) {
    context.check_cancelled();
    const Eigen::RowVectorXd row = frames.row(t);
    const Eigen::RowVectorXd* frame = track.is_lost(t) ? nullptr : &row;
    paths = t == 0 ? viterbi.begin(frame) : viterbi.advance(paths, frame, from[static_cast<std::size_t>(t)]);
  }
  const auto best = std::ranges::max_element(paths, {}, &Path::score);
  if (!(best->score > kNone))
    throw std::runtime_error(
        "the states of the switching linear dynamical system grow beyond all bounds before the track ends: train it "
        "with a `bound` below 1");
  for (const Eigen::Index phone : trace_back(from, best - paths.begin()))
    decoded.labels.push_back(model.chain.phones[static_cast<std::size_t>(phone)]);
  return decoded;
}

void describe(Description<DecodeSlds>& d) {
  d.type("mapping.slds_decode").version(1);
  d.summary("the phones of a face or of sound by a switching linear dynamical system");
  d.source("Thesis §5.1.1; Pavlovic, Rehg, Cham and Murphy 1999");
  d.input("model", "of mapping.slds")
      .input("track", "visual parameters or speech features that the model was trained on")
      .output("labels", "the likeliest phone of each frame, by approximate Viterbi");
  d.param("stream", &DecodeSlds::stream).doc("what the track is; audio needs a model with sound");
}

}  // namespace talkgraph
