#pragma once

#include "nodes/types/audio.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Video frames in sound of this length: seconds × fps rounded up, at least 1. The
/// length is that of `audio`, or as far as `track` reaches where there is none,
/// the last centre lying as far from the end as the first from the beginning.
/// Throws std::runtime_error if sound and track are clearly not of one utterance.
Eigen::Index video_frames(const Track& track, const Audio* audio, const Rational& fps);

/// In the sound alone.
Eigen::Index video_frames(const Audio& audio, const Rational& fps);

/// Centre of video frame n, seconds: (n + ½) / fps.
double video_time(Eigen::Index n, const Rational& fps);

/// The track at the video rate, with a row a video frame that is still to be computed. Errors of video_frames and
/// check_finite.
Track unfilled(const Track& track, const Audio* audio, const Rational& rate);

/// Throws std::runtime_error if a track is empty or holds NaN or infinity.
void check_finite(const Track& track);

}  // namespace talkgraph
