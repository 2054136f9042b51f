#include "nodes/evaluate/mouth_lag.h"

#include <cmath>

#include "nodes/evaluate/lag.h"
#include "nodes/evaluate/lips.h"

namespace talkgraph {

std::optional<Scores> MouthLag::operator()(const LandmarkTrack& landmarks, const Audio& audio) const {
  const Eigen::VectorXd opening = point_distance(landmarks, upper, lower);
  const Eigen::VectorXd all = lag_correlations(opening, sound_envelope(audio, landmarks.rate, opening.size()), max_lag);
  Scores best;
  for (int lag = -max_lag; lag <= max_lag; ++lag) {
    const double c = all(lag + max_lag);
    if (std::isnan(c)) continue;
    if (lag == 0) best.values["in_time"] = c;
    if (best.values.contains("correlation") && c <= best.values["correlation"]) continue;
    best.values["correlation"] = c;
    best.values["lag"] = lag;
  }
  if (!best.values.contains("in_time")) return {};
  return best;
}

void describe(Description<MouthLag>& d) {
  d.type("evaluate.mouth_lag").version(2).summary("lag between the opening of the mouth and the sound");
  d.input("landmarks", "of the face, recorded or synthesised")
      .input("audio", "the speech")
      .output("scores",
              "lag: shift at which mouth and sound correlate most, frames, above 0 if the mouth is late; correlation: "
              "that of mouth and sound at this shift; in_time: correlation of mouth and sound without a shift");
  d.param("max_lag", &MouthLag::max_lag).within(0, 100).unit("frames").doc("longest shift tried");
  d.param("upper", &MouthLag::upper).doc("point in the middle of the inner upper lip, by its name in the point scheme");
  d.param("lower", &MouthLag::lower).doc("point in the middle of the inner lower lip");
}

}  // namespace talkgraph
