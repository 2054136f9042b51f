#include "nodes/phones/time_labels.h"

namespace talkgraph {

PhoneTrack TimeLabels::operator()(const FrameLabels& labels) const {
  PhoneTrack track;
  const double rate = labels.rate.value();
  for (std::size_t n = 0; n < labels.labels.size(); ++n) {
    const std::string& label = labels.labels[n];
    const double start = static_cast<double>(n) / rate, end = static_cast<double>(n + 1) / rate;
    if (track.phones.empty() || track.phones.back().label != label) track.phones.push_back({label, start, end});
    track.phones.back().end = end;
  }
  return track;
}

void describe(Description<TimeLabels>& d) {
  d.type("phones.time_labels").summary("phones with their times from one label a frame");
  d.input("labels", "at any rate").output("phones", "one for each run of equal labels");
}

}  // namespace talkgraph
