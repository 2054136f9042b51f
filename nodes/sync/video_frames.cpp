#include "nodes/sync/video_frames.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace talkgraph {
namespace {

// A frame begun is a frame: a clip lasts as long as its sound.
Eigen::Index frames_in(double seconds, const Rational& fps) {
  return std::max<Eigen::Index>(1, static_cast<Eigen::Index>(std::ceil(seconds * fps.value() - 1e-6)));
}

}  // namespace

Eigen::Index video_frames(const Track& track, const Audio* audio, const Rational& fps) {
  const double reach = 2 * track.start + static_cast<double>(track.frames() - 1) / track.rate.value();
  const double seconds = audio ? audio->seconds() : reach;
  const double tolerance = 2 / fps.value() + 2 / track.rate.value() + 2 * std::abs(track.start);
  if (std::abs(seconds - reach) > tolerance)
    throw std::runtime_error("sound of " + std::to_string(seconds) + " s beside a track of " + std::to_string(reach) +
                             " s: both must be of one utterance");
  return frames_in(seconds, fps);
}

Eigen::Index video_frames(const Audio& audio, const Rational& fps) { return frames_in(audio.seconds(), fps); }

double video_time(Eigen::Index n, const Rational& fps) { return (static_cast<double>(n) + 0.5) / fps.value(); }

void check_finite(const Track& track) {
  if (track.frames() < 1) throw std::runtime_error("a track without frames cannot be brought to the video rate");
  if (!track.values.allFinite())
    throw std::runtime_error("a track with NaN or infinite values: look at the stage before");
}

Track unfilled(const Track& track, const Audio* audio, const Rational& rate) {
  check_finite(track);
  Track out;
  out.rate = rate;
  out.start = video_time(0, rate);
  out.names = track.names;
  out.values.resize(video_frames(track, audio, rate), track.dimension());
  return out;
}

}  // namespace talkgraph
