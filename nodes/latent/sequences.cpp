#include "nodes/latent/sequences.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace talkgraph {

namespace {

Eigen::MatrixXd with_gaps(const Track& track, Eigen::Index frames) {
  Eigen::MatrixXd values = track.values.topRows(frames);
  for (const auto t : track.lost)
    if (t < frames) values.row(t).setConstant(std::numeric_limits<double>::quiet_NaN());
  return values;
}

}  // namespace

StateData Sequences::operator()(const Collected<Track>& audio, const Collected<Track>& visual) const {
  StateData data{label, {}, {}};
  for (std::size_t i = 0; i < audio.size(); ++i) {
    const Track* seen = visual.find(audio.key(i));
    if (!seen) continue;
    const auto [shorter, longer] = std::minmax(audio[i].frames(), seen->frames());
    if (longer - shorter > 2)
      throw std::runtime_error(fmt::format("{}: {} audio frames, {} visual frames; bring both to one rate",
                                           audio.key(i), audio[i].frames(), seen->frames()));
    if (shorter == 0) continue;
    data.audio.push_back(with_gaps(audio[i], shorter));
    data.visual.push_back(with_gaps(*seen, shorter));
  }
  if (data.audio.empty()) throw std::runtime_error("no training sequence has sound and face: is the selection empty?");
  return data;
}

void describe(Description<Sequences>& d) {
  d.type("latent.sequences").summary("all training sequences as the windows of one state");
  d.input("audio", "speech features at the video rate").input("visual", "visual parameters at that rate");
  d.output("windows", "one window a sequence, lost frames as missing values");
  d.param("label", &Sequences::label).doc("of the state");
}

}  // namespace talkgraph
