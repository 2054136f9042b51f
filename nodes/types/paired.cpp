#include "nodes/types/paired.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace talkgraph {

Track beginning(const Track& track, Eigen::Index frames) {
  Track t = track;
  t.values.conservativeResize(frames, Eigen::NoChange);
  while (!t.lost.empty() && t.lost.back() >= frames) t.lost.pop_back();
  return t;
}

Eigen::Index common_frames(const std::string& utterance, Eigen::Index a, const char* of_a, Eigen::Index b,
                           const char* of_b) {
  if (std::abs(a - b) > 2)
    throw std::runtime_error(fmt::format("{}: {} {}, {} {}: bring both to one rate", utterance, a, of_a, b, of_b));
  return std::min(a, b);
}

JoinedStreams side_by_side(const Collected<Track>& audio, const Collected<Track>& visual) {
  JoinedStreams both;
  Eigen::Index visual_dims = 0;
  for (std::size_t i = 0; i < audio.size(); ++i) {
    const std::string& key = audio.key(i);
    const Track* seen = visual.find(key);
    if (!seen) continue;
    const Eigen::Index frames = common_frames(key, audio[i].frames(), "audio frames", seen->frames(), "visual frames");
    const Eigen::Index dims = audio[i].dimension(), shown = seen->dimension();
    if (both.tracks.empty()) both.audio = dims, visual_dims = shown;
    const auto check = [&](const char* kind, Eigen::Index here, Eigen::Index before) {
      if (here != before)
        throw std::runtime_error(fmt::format("{}: {} {} dimensions, those before it {}: train all on the same features",
                                             key, here, kind, before));
    };
    check("audio", dims, both.audio);
    check("visual", shown, visual_dims);
    Track t = beginning(*seen, frames);
    t.names.clear();
    t.values.resize(frames, dims + shown);
    t.values << audio[i].values.topRows(frames), seen->values.topRows(frames);
    both.tracks.add(key, std::move(t));
  }
  if (both.tracks.empty())
    throw std::runtime_error("no training sequence has both sound and face: is the selection empty?");
  return both;
}

Labelled labelled(const Collected<Track>& tracks, const Collected<FrameLabels>& labels) {
  Labelled all;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const std::string& key = tracks.key(i);
    const FrameLabels* phones = labels.find(key);
    if (!phones) continue;
    Track t =
        beginning(tracks[i], common_frames(key, tracks[i].frames(), "frames", std::ssize(phones->labels), "labels"));
    for (Eigen::Index n = 0; n < t.frames(); ++n)
      if (!t.is_lost(n)) all.labels.push_back(phones->labels[static_cast<std::size_t>(n)]);
    all.tracks.add(key, std::move(t));
  }
  if (all.tracks.empty())
    throw std::runtime_error("no training sequence has both labels and frames: is the selection empty?");
  return all;
}

}  // namespace talkgraph
