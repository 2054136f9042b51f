#include "nodes/speech/place.h"

#include <algorithm>
#include <cmath>

#include "nodes/types/visemes.h"

namespace talkgraph {

Eigen::MatrixXd places(const Track& like, double end, double time) {
  Eigen::MatrixXd p(like.frames(), 2);
  for (Eigen::Index t = 0; t < like.frames(); ++t) {
    const double at = like.time(t);
    p.row(t) << std::exp(-(at - like.start) / time), std::exp(-std::max(0.0, end - at) / time);
  }
  return p;
}

Track PlaceInRecording::operator()(const FrameLabels& labels) const {
  const auto last = std::ranges::find_if(labels.labels.rbegin(), labels.labels.rend(),
                                         [](const auto& label) { return !is_pause(label); });
  const auto spoken = last != labels.labels.rend() ? labels.labels.rend() - last : std::ssize(labels.labels);
  Track out;
  out.rate = labels.rate;
  out.start = 0.5 / labels.rate.value();
  out.names = {"begun", "ending"};
  out.values.resize(std::ssize(labels.labels), 2);
  out.values = weight * places(out, static_cast<double>(spoken) / labels.rate.value(), time);
  return out;
}

void describe(Description<PlaceInRecording>& d) {
  d.type("speech.place").summary("how near each frame is to where its recording begins and where speech ends");
  d.input("labels", "phone of every frame").output("track", "T x 2: weight exp(-t / time) for both distances in time");
  d.param("time", &PlaceInRecording::time).positive().unit("s").doc("in which they fall to 1/e");
  d.param("weight", &PlaceInRecording::weight)
      .positive()
      .doc("factor on both, where distances to other features are to be measured");
}

}  // namespace talkgraph
