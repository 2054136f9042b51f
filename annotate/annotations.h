#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "nodes/types/shape.h"

namespace talkgraph::annotate {

/// The landmarks of one frame as a person left them.
struct Annotation {
  Shape points;       ///< pixels from 0
  bool done = false;  ///< else a draft, which nothing is learnt from
};

/// What there is of one frame.
struct Kept {
  std::optional<Annotation> annotation;
  std::string broken;  ///< why what is there cannot be used, with the name of the file; else empty
};

/// Tells two states of a frame apart; of a frame of which there is nothing: "none".
std::string tag_of(const Kept& kept);

/// Annotations in files, which are all that is kept: FOLDER/CLIP/000012.pts of a frame that is done, 000012.draft of
/// one that is not, both as nodes/write/landmarks.h has them. A file of another number of digits, 12.pts, counts as
/// well and keeps its name; two files of one frame are broken. A file appears whole or not at all. May be used by any
/// threads.
class Annotations {
 public:
  /// Removes what a process that was killed left unfinished.
  Annotations(std::filesystem::path folder, Eigen::Index points);

  const std::filesystem::path& folder() const { return folder_; }

  Kept read(const std::string& clip, std::int64_t frame) const;

  /// Keeps `next` if the frame still has the state `tag`; gives the state that it then has. A broken file is put aside
  /// as 000012.pts.broken. Throws std::runtime_error that names a file that cannot be written.
  struct Written {
    bool kept = false;
    Kept now;
  };
  Written write(const std::string& clip, std::int64_t frame, const Annotation& next, const std::string& tag);

  /// Numbers of the frames of a clip that have an annotation, ascending.
  std::vector<std::int64_t> frames(const std::string& clip) const;

 private:
  std::vector<std::filesystem::path> files(const std::string& clip) const;
  std::vector<std::filesystem::path> files(const std::string& clip, std::int64_t frame) const;
  Kept read_unlocked(const std::string& clip, std::int64_t frame) const;

  const std::filesystem::path folder_;
  const Eigen::Index points_;
  mutable std::mutex mutex_;
};

}  // namespace talkgraph::annotate
