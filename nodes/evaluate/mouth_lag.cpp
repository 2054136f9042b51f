#include "nodes/evaluate/mouth_lag.h"

#include <cmath>

#include "nodes/evaluate/lips.h"

namespace talkgraph {
namespace {

Eigen::VectorXd envelope(const Audio& audio, const Rational& fps, Eigen::Index frames) {
  Eigen::VectorXd out(frames);
  for (Eigen::Index t = 0; t < frames; ++t) {
    const auto at = [&](Eigen::Index n) {
      return std::min<Eigen::Index>(audio.samples.size(),
                                    std::lround(static_cast<double>(n) / fps.value() * audio.rate));
    };
    const auto from = at(t), n = at(t + 1) - from;
    const double power = n > 0 ? audio.samples.segment(from, n).squaredNorm() / static_cast<double>(n) : 0;
    out[t] = std::log10(power + 1e-6);
  }
  return out;
}

double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::VectorXd x = a.array() - a.mean(), y = b.array() - b.mean();
  const double product = x.norm() * y.norm();
  return product > 1e-9 ? x.dot(y) / product : NAN;
}

}  // namespace

std::optional<Scores> MouthLag::operator()(const LandmarkTrack& landmarks, const Audio& audio) const {
  const Eigen::VectorXd opening = point_distance(landmarks, upper, lower);
  const auto frames = opening.size();
  const Eigen::VectorXd sound = envelope(audio, landmarks.rate, frames);
  Scores best;
  for (int lag = -max_lag; lag <= max_lag; ++lag) {
    const auto n = frames - std::abs(lag);
    if (n < 3) continue;
    const double c = correlation(opening.segment(std::max(lag, 0), n), sound.segment(std::max(-lag, 0), n));
    if (std::isnan(c)) return {};
    if (lag == 0) best.values["in_time"] = c;
    if (best.values.contains("correlation") && c <= best.values["correlation"]) continue;
    best.values["correlation"] = c;
    best.values["lag"] = lag;
  }
  if (best.values.empty()) return {};
  return best;
}

void describe(Description<MouthLag>& d) {
  d.type("evaluate.mouth_lag").summary("lag between the opening of the mouth and the sound");
  d.input("landmarks", "of the face, recorded or synthesised")
      .input("audio", "the speech")
      .output("scores",
              "lag (frames; above 0: the mouth is late), correlation at that lag, in_time (correlation without a lag)");
  d.param("max_lag", &MouthLag::max_lag).within(0, 100).unit("frames").doc("longest shift tried");
  d.param("upper", &MouthLag::upper).at_least(0).doc("point in the middle of the inner upper lip");
  d.param("lower", &MouthLag::lower).at_least(0).doc("point in the middle of the inner lower lip");
}

}  // namespace talkgraph
