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

/// Takes a recording apart: reads its sound, opens its video. With `check` its frames are
/// counted: landmarks must be as many (give or take 2), and of a sound that differs from the
/// picture in length by more than `tolerance` the user is warned. Throws std::runtime_error if not, if pictures or a
/// visual track have another rate than `fps`, or if labels end far from the end of the sound, as they do in
/// another unit.
struct Parts {
  Rational fps;             ///< rate that pictures and visual tracks must have; 0: any
  bool check = true;        ///< off where only the sound is used: the video is then not decoded
  double tolerance = 0.25;  ///< seconds

  RecordingParts operator()(const Recording& recording, Context& context) const;
};
void describe(Description<Parts>& d);

}  // namespace talkgraph
