#pragma once

#include <optional>

#include "graph/description.h"
#include "nodes/types/recording.h"

namespace talkgraph {

/// What a recording consists of; what it lacks is absent.
struct RecordingParts {
  Audio audio;
  std::optional<Video> video;
  std::optional<Transcript> transcript;
  std::optional<WordTrack> words;
  std::optional<PhoneTrack> phones;
  std::optional<LandmarkTrack> landmarks;
  std::optional<Track> visual;
};

/// Takes a recording apart: reads its sound, opens its video. With `check` it decodes the
/// video once: damaged frames are marked (media.check_video), landmarks must be as many as
/// frames (give or take 2, else std::runtime_error), and a sound that differs from the
/// picture in length by more than `tolerance` is reported in the log.
struct Parts {
  bool check = true;        ///< off where only the sound is used: the video is then not decoded
  double tolerance = 0.25;  ///< seconds

  RecordingParts operator()(const Recording& recording, Context& context) const;
};
void describe(Description<Parts>& d);

}  // namespace talkgraph
