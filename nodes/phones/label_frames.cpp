#include "nodes/phones/label_frames.h"

#include <algorithm>

namespace talkgraph {
namespace {

/// Differences of time below this are rounding, not a majority.
constexpr double kEqual = 1e-9;

/// The label of most of [start, end); `first` is the first phone that may reach
/// into it and moves on.
std::string majority(const std::vector<Interval>& phones, std::size_t& first, double start, double end) {
  while (first < phones.size() && phones[first].end <= start) ++first;
  std::vector<Interval> shares;  // label and time in `end`, in order of appearance
  double covered = 0;
  const auto add = [&](const std::string& label, double time) {
    auto share = std::find_if(shares.begin(), shares.end(), [&](const Interval& s) { return s.label == label; });
    if (share == shares.end()) share = shares.insert(shares.end(), {label, 0, 0});
    share->end += time;
  };
  for (std::size_t i = first; i < phones.size() && phones[i].start < end; ++i) {
    const double time = std::min(end, phones[i].end) - std::max(start, phones[i].start);
    if (time <= 0) continue;
    add(phones[i].label, time);
    covered += time;
  }
  if (end - start - covered > kEqual) add("sil", end - start - covered);
  const Interval* best = &shares.front();
  for (const auto& share : shares)
    if (share.end > best->end + kEqual) best = &share;
  return best->label;
}

}  // namespace

FrameLabels LabelFrames::operator()(const PhoneTrack& phones, const Track& like) const {
  FrameLabels labels;
  labels.rate = like.rate;
  const double half = 0.5 / like.rate.value();
  std::size_t first = 0;
  for (Eigen::Index t = 0; t < like.frames(); ++t)
    labels.labels.push_back(majority(phones.phones, first, like.time(t) - half, like.time(t) + half));
  return labels;
}

void describe(Description<LabelFrames>& d) {
  d.type("phones.label_frames").summary("one phone a frame, by majority of its time").source("Thesis §3.2");
  d.input("phones", "with their times")
      .input("like", "the track whose frames are labelled")
      .output("labels", "as many as the track has frames");
}

}  // namespace talkgraph
