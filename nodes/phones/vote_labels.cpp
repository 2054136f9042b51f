#include "nodes/phones/vote_labels.h"

#include "nodes/phones/label_frames.h"
#include "nodes/phones/time_labels.h"

namespace talkgraph {

FrameLabels VoteLabels::operator()(const FrameLabels& labels, const Track& like) const {
  return LabelFrames{}(TimeLabels{}(labels), like);
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
