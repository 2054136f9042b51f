#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "nodes/types/audio.h"
#include "nodes/types/phones.h"
#include "nodes/types/shape.h"
#include "nodes/types/track.h"
#include "nodes/types/video.h"

namespace talkgraph {

/// One utterance of a corpus. Sound and pictures are read when asked for:
/// `audio` and `video` may be called from any thread; both throw
/// std::runtime_error that names the file.
struct Recording {
  std::string id;
  std::string split;  ///< "train", "validation", "test", or what the manifest says
  std::function<Audio()> audio;
  std::function<Video()> video;  ///< empty where there are no pictures
  std::function<Key()> key;      ///< changes whenever sound or pictures do; empty: they are read to tell
  std::optional<Track> visual;   ///< ready-made visual track instead of, or beside, pictures
  std::optional<Transcript> transcript;
  std::optional<WordTrack> words;
  std::optional<PhoneTrack> phones;
  std::optional<LandmarkTrack> landmarks;
  std::vector<std::string> faults;  ///< what of it cannot be read and why, where a corpus is lenient
};
template <>
inline constexpr PortType port_type<Recording>{"Recording", 2};
void fields(Archive& ar, Recording& r);

}  // namespace talkgraph
