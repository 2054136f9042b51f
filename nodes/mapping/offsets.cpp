#include "nodes/mapping/offsets.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "nodes/mapping/leave_one_out.h"
#include "nodes/sync/shift.h"

namespace talkgraph {
namespace {

constexpr double step = 0.125;

Eigen::MatrixXd centred(const Eigen::MatrixXd& values) { return values.rowwise() - values.colwise().mean(); }

/// Frames by which the track must be moved to come nearest to what is predicted at some of its frames.
double lateness(const Track& track, const HeldOut& held, const Eigen::RowVectorXd& weights, double largest) {
  const Eigen::MatrixXd predicted = centred(held.predicted);
  double best = 0, nearest = std::numeric_limits<double>::infinity();
  const auto steps = static_cast<int>(std::floor(largest / step));
  for (int i = 0; i <= 2 * steps; ++i) {
    const double late = step * (i % 2 ? -(i + 1) / 2 : i / 2);  // 0 first, so that it wins where all are alike
    const Eigen::MatrixXd moved = centred(shifted(track, late).values(held.frames, Eigen::all));
    const double distance = (moved - predicted).colwise().squaredNorm().dot(weights);
    if (distance < nearest) {
      nearest = distance;
      best = late;
    }
  }
  return best;
}

/// 1 / variance of each visual parameter over all frames, 0 for a constant one.
Eigen::RowVectorXd inverse_variance(const Collected<Track>& visual, const std::vector<HeldOut>& held) {
  Eigen::RowVectorXd squares = Eigen::RowVectorXd::Zero(held[0].predicted.cols());
  double frames = 0;
  for (const auto& h : held) {
    squares += centred(visual.find(h.key)->values(h.frames, Eigen::all)).colwise().squaredNorm();
    frames += static_cast<double>(h.frames.size());
  }
  return (squares.array() > 0).select(frames * squares.cwiseInverse(), 0.0);
}

}  // namespace

Table EstimateOffsets::operator()(const Collected<Track>& audio, const Collected<PhoneTrack>& phones,
                                  const Collected<Track>& visual, Context& context) const {
  const auto held = leave_one_out(process, audio, phones, visual, context);
  const auto weights = inverse_variance(visual, held);
  Table table{"Offsets between pictures and sound", "utterance", {late_column}, {}, {}};
  for (const auto& h : held) {
    const Track& track = *visual.find(h.key);
    table.rows.push_back(h.key);
    table.cells.push_back({h.frames.empty() ? 0 : lateness(track, h, weights, largest) / track.rate.value()});
  }
  return table;
}

void describe(Description<EstimateOffsets>& d) {
  d.type("mapping.offsets").stored();
  d.summary("how late the pictures of each training utterance are, by soft contexts learnt from the others");
  d.input("audio", "speech features at the video rate of the training utterances")
      .input("phones", "their phones with times")
      .input("visual", "their visual parameters, normalised")
      .output("offsets", "an utterance a row: late, s");
  d.param("largest", &EstimateOffsets::largest).at_least(0).unit("frames").doc("offset that is looked for");
}

}  // namespace talkgraph
