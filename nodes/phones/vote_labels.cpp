#include "nodes/phones/vote_labels.h"

#include "nodes/phones/label_frames.h"

namespace talkgraph {

FrameLabels VoteLabels::operator()(const FrameLabels& labels, const Track& like) const {
  PhoneTrack phones;
  const double rate = labels.rate.value();
  for (std::size_t n = 0; n < labels.labels.size(); ++n)
    phones.phones.push_back({labels.labels[n], static_cast<double>(n) / rate, static_cast<double>(n + 1) / rate});
  return LabelFrames{}(phones, like);
}

void describe(Description<VoteLabels>& d) {
  d.type("phones.vote_labels")
      .summary("labels at 100 Hz, or another rate, brought to the frames of a track by majority");
  d.source("Thesis §3.2");
  d.input("labels", "at their own rate")
      .input("like", "the track whose frames are labelled")
      .output("voted", "as many as the track has frames");
}

}  // namespace talkgraph
