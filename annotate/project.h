#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "annotate/annotations.h"
#include "annotate/beginning.h"
#include "annotate/frames.h"
#include "graph/json.h"
#include "nodes/types/scheme.h"

namespace talkgraph::annotate {

/// Holds a folder, which it makes, against other processes and projects. Throws std::runtime_error if one has it or
/// nothing can be written there.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

struct ProjectOptions {
  int frames = 20;  ///< to annotate
  std::uint64_t seed = 1;
  std::string scheme = {};  ///< name or file of a point scheme; empty: as the manifest says, else "ibug68"
};

/// The frames of a manifest's clips that a person annotates: those of the split "train" that have pictures and no
/// landmarks of their own. May be used by any threads.
class Project {
 public:
  /// What is wrong with the manifest goes to `diagnostics`; then, null. Throws std::runtime_error if there is no clip
  /// to annotate or a file cannot be read or written. Changes no file.
  static std::unique_ptr<Project> open(const std::string& manifest, const ProjectOptions& options,
                                       Diagnostics& diagnostics);
  /// Where the manifest does not yet say where annotations are, it is told: "landmarks": {"folder": "annotated", ...}.
  /// Throws std::runtime_error if it cannot be written.
  void tell_manifest() const;

  const std::string& manifest() const { return manifest_; }
  const PointScheme& scheme() const { return scheme_; }
  const std::vector<Frame>& frames() const { return frames_; }
  const std::string& clip(std::size_t frame) const { return clips_[frames_[frame].clip].id; }
  const std::filesystem::path& folder() const { return annotations_.folder(); }
  /// Names folder, scheme, pictures, clip and number of a frame: what is meant for it meets no other.
  const std::string& key(std::size_t frame) const { return keys_[frame]; }
  std::optional<std::size_t> find(const std::string& key) const;

  /// Decoded when first asked for, with those of its clip before it. Throws std::runtime_error that names the video.
  cv::Mat picture(std::size_t frame, const Context& context = {});
  /// A frame of which there is a file although its clip is shorter is broken.
  Kept kept(std::size_t frame) const;
  /// Throws std::invalid_argument unless the points are the scheme's in number, near the picture, and, for a frame that
  /// is done, in it: nothing is learnt from a face that leaves the picture.
  Annotations::Written annotate(std::size_t frame, const Annotation& next, const std::string& tag);
  /// Points to begin with; never the frame's own annotation.
  Beginning begin(std::size_t frame, const Context& context = {});

 private:
  struct Destination;
  /// How far a clip has been read, and the pictures of its frames so far.
  struct Film {
    std::unique_ptr<VideoSource::Reader> reader;
    std::int64_t next = 0;
    std::map<std::int64_t, cv::Mat> pictures;
  };
  Project(std::string manifest, std::vector<Clip> clips, Destination destination, const ProjectOptions& options);
  const VideoSource& source(std::size_t frame) const { return *clips_[frames_[frame].clip].video().source; }
  /// Whether one of a clip's frames `from` to `to` - 1 is to be annotated.
  bool has_frame(std::size_t clip, std::int64_t from, std::int64_t to) const;
  void read(std::size_t frame, Film& film, const Context& context);

  const std::string manifest_;
  const std::vector<Clip> clips_;
  const PointScheme scheme_;
  const std::string scheme_name_;  ///< as landmarks carry it
  const Json untold_;              ///< what the manifest does not say yet, or null
  const FolderLock lock_;
  Annotations annotations_;
  std::vector<Frame> frames_;
  std::vector<std::string> keys_;
  Beginner beginner_;
  std::mutex films_mutex_;
  std::map<std::size_t, Film> films_;  ///< by clip
};

}  // namespace talkgraph::annotate
