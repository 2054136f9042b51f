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

/// Tells two states of a frame apart; of a frame without annotation: "none".
std::string tag_of(const std::optional<Annotation>& annotation);

/// Annotations in files, which are all that is kept: FOLDER/CLIP/000012.pts of a frame that is done, 000012.draft of
/// one that is not, both as nodes/write/landmarks.h has them. A file appears whole or not at all. May be used by any
/// threads.
class Annotations {
 public:
  /// Removes what a process that was killed left unfinished.
  Annotations(std::filesystem::path folder, Eigen::Index points);

  const std::filesystem::path& folder() const { return folder_; }

  /// Nothing if there is none. Throws std::runtime_error that names a file that is malformed or of another number of
  /// points.
  std::optional<Annotation> read(const std::string& clip, std::int64_t frame) const;

  /// Keeps `next` if the frame still has the state `tag`; gives the state that it then has. Throws std::runtime_error
  /// that names a file that cannot be written.
  struct Written {
    bool kept = false;
    std::optional<Annotation> now;
  };
  Written write(const std::string& clip, std::int64_t frame, const Annotation& next, const std::string& tag);

  /// Numbers of the frames of a clip that have an annotation, ascending.
  std::vector<std::int64_t> frames(const std::string& clip) const;

 private:
  std::optional<Annotation> read_unlocked(const std::string& clip, std::int64_t frame) const;

  const std::filesystem::path folder_;
  const Eigen::Index points_;
  mutable std::mutex mutex_;
};

}  // namespace talkgraph::annotate
