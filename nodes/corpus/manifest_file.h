#pragma once

#include <optional>
#include <string>
#include <vector>

#include "graph/json.h"
#include "graph/rational.h"
#include "nodes/corpus/landmarks.h"

namespace talkgraph {

/// One clip of a manifest; paths are absolute, or empty where nothing is given.
struct ManifestClip {
  std::string id;
  std::string split = "train";
  std::string video;  ///< file, or folder of pictures
  std::string audio;
  std::string words;
  std::string phones;
  LandmarkFiles landmarks;
  std::string visual, visual_dataset = "visual";
  std::optional<Rational> visual_rate;
  std::string transcript, transcript_file;  ///< one of them, or none
  std::optional<Rational> rate;             ///< of a folder of pictures, of landmarks, of a visual track
};

/// Where the manifest has landmarks of some frames: a folder a clip below `path`, called by the clip's id.
struct LandmarkFolder {
  std::string path;
  std::string scheme;  ///< as in LandmarkTrack; may be empty
  Place place;         ///< of the member "landmarks", else of "clips"
};

/// Reads a manifest; whatever is wrong goes to `diagnostics`. Throws
/// std::runtime_error if there is no such file.
std::vector<ManifestClip> read_manifest(const std::string& file, Diagnostics& diagnostics);

/// What the manifest says beside its clips; no path if it says nothing. Errors as above.
LandmarkFolder read_landmark_folder(const std::string& file, Diagnostics& diagnostics);

/// A scheme file in one line, as landmarks carry it. Errors as above.
std::string scheme_text(const std::string& file, Diagnostics& diagnostics);

}  // namespace talkgraph
