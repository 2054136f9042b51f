#include "annotate/project.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <set>
#include <stdexcept>

#include "graph/output_file.h"
#include "nodes/corpus/labels.h"
#include "nodes/corpus/manifest.h"
#include "nodes/corpus/text.h"

namespace talkgraph::annotate {
namespace {

namespace fs = std::filesystem;

/// Bytes before a place in its text, whose columns count characters.
std::size_t offset_of(const Place& place, const std::string& text) {
  std::size_t at = 0;
  for (int line = 1; line < place.line; ++line) at = text.find('\n', at) + 1;
  const auto continues = [&](std::size_t i) { return i < text.size() && (text[i] & 0xc0) == 0x80; };
  for (int column = 1; column < place.column; ++column)
    for (++at; continues(at);) ++at;
  return at;
}

/// Puts the member "landmarks" before another one, which keeps its place in a line of its own.
void tell_manifest(const std::string& manifest, const Place& before, const Json& landmarks) {
  std::string text = read_text_file(manifest);
  const auto at = offset_of(before, text);
  const auto line = text.rfind('\n', at) + 1;  // 0 in the first line
  const std::string indent = text.substr(line, at - line);
  const bool alone = line > 0 && indent.find_first_not_of(" \t") == std::string::npos;
  text.insert(at, fmt::format("\"landmarks\": {},{}", landmarks.dump(), alone ? "\n" + indent : " "));
  write_file(manifest, text);
}

/// The folder of annotations as the manifest has it; it is told where it says nothing.
LandmarkFolder landmark_folder(const std::string& manifest, const std::string& scheme, Diagnostics& diagnostics) {
  auto folder = read_landmark_folder(manifest, diagnostics);
  const auto wanted = scheme.ends_with(".json") ? scheme_text(scheme, diagnostics) : scheme;
  if (!diagnostics.ok()) return folder;
  if (!folder.path.empty()) {
    if (folder.scheme.empty()) folder.scheme = "ibug68";
    if (!scheme.empty() && wanted != folder.scheme)
      throw std::invalid_argument(manifest + ": names another point scheme; change it there, with another folder");
    return folder;
  }
  folder.scheme = wanted.empty() ? "ibug68" : wanted;
  if (!find_scheme(folder.scheme)) throw std::invalid_argument(unknown_scheme(folder.scheme));
  const auto home = fs::absolute(manifest).parent_path();
  constexpr auto name = "annotated";
  const auto in_manifest =
      scheme.ends_with(".json") ? fs::relative(fs::absolute(scheme), home).string() : folder.scheme;
  tell_manifest(manifest, folder.place, {{"folder", name}, {"scheme", in_manifest}});
  folder.path = (home / name).string();
  return folder;
}

bool is_ours(const ManifestClip& clip, const LandmarkFolder& folder) {
  return clip.landmarks.path.empty() || fs::path(clip.landmarks.path).parent_path() == fs::path(folder.path);
}

std::vector<Clip> clips_to_annotate(const std::vector<ManifestClip>& all, const LandmarkFolder& folder) {
  std::vector<Clip> clips;
  for (const auto& clip : all) {
    if (clip.split != "train" || clip.video.empty() || !is_ours(clip, folder)) continue;
    clips.push_back({clip.id, [clip] { return open_pictures(clip); }, {}});
    if (!clip.phones.empty()) clips.back().phones = read_phones(clip.phones);
  }
  return clips;
}

/// The frames chosen, then those that have an annotation although they are not among them.
std::vector<Frame> all_frames(const std::vector<Clip>& clips, const Annotations& annotations,
                              const ProjectOptions& options) {
  auto frames = choose_frames(clips, options.frames, options.seed);
  std::set<std::pair<std::size_t, std::int64_t>> chosen;
  for (const auto& frame : frames) chosen.emplace(frame.clip, frame.number);
  for (std::size_t c = 0; c < clips.size(); ++c)
    for (const auto number : annotations.frames(clips[c].id))
      if (!chosen.contains({c, number})) frames.push_back({c, number, ""});
  return frames;
}

}  // namespace

std::unique_ptr<Project> Project::open(const std::string& manifest, const ProjectOptions& options,
                                       Diagnostics& diagnostics) {
  const auto all = read_manifest(manifest, diagnostics);
  if (!diagnostics.ok()) return nullptr;
  const auto folder = landmark_folder(manifest, options.scheme, diagnostics);
  if (!diagnostics.ok()) return nullptr;
  auto clips = clips_to_annotate(all, folder);
  if (clips.empty())
    throw std::runtime_error(
        manifest +
        ": there is no clip to annotate: none of the split \"train\" has a \"video\" and no landmarks of its own");
  return std::unique_ptr<Project>(
      new Project(manifest, std::move(clips), *find_scheme(folder.scheme), folder.scheme, folder.path, options));
}

FolderLock::FolderLock(const fs::path& folder) {
  fs::create_directories(folder);
  descriptor_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ >= 0 && flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  const bool taken = errno == EWOULDBLOCK;
  if (descriptor_ >= 0) close(descriptor_);
  throw std::runtime_error(folder.string() + (taken ? ": is being annotated by another talkgraph already; open its page"
                                                    : ": cannot be locked"));
}

FolderLock::~FolderLock() { close(descriptor_); }

Project::Project(std::string manifest, std::vector<Clip> clips, PointScheme scheme, std::string scheme_name,
                 fs::path folder, const ProjectOptions& options)
    : manifest_(std::move(manifest)),
      clips_(std::move(clips)),
      scheme_(std::move(scheme)),
      scheme_name_(std::move(scheme_name)),
      lock_(folder),
      annotations_(std::move(folder), scheme_.points()),
      frames_(all_frames(clips_, annotations_, options)),
      beginner_(scheme_.mean) {}

void Project::read_clip(std::size_t clip) {
  std::set<std::int64_t> wanted;
  for (const auto& frame : frames_)
    if (frame.clip == clip) wanted.insert(frame.number);
  const Video video = clips_[clip].video();
  const auto reader = video.source->open();
  cv::Mat picture;
  for (std::int64_t n = 0; n <= *wanted.rbegin(); ++n) {
    if (!reader->next(picture))
      throw std::runtime_error(fmt::format("{}: has no frame {}", video.source->name(), *wanted.rbegin()));
    if (wanted.contains(n)) pictures_[{clip, n}] = picture.clone();
  }
}

cv::Mat Project::picture(std::size_t frame) {
  const std::lock_guard lock(pictures_mutex_);
  const std::pair key(frames_[frame].clip, frames_[frame].number);
  if (!pictures_.contains(key)) read_clip(key.first);
  return pictures_.at(key);
}

std::optional<Annotation> Project::annotation(std::size_t frame) const {
  return annotations_.read(clip(frame), frames_[frame].number);
}

Annotations::Written Project::annotate(std::size_t frame, const Annotation& next, const std::string& tag) {
  if (next.points.rows() != scheme_.points())
    throw std::invalid_argument(fmt::format("{} points are needed, got {}", scheme_.points(), next.points.rows()));
  const cv::Size size = picture(frame).size();
  const Eigen::RowVector2d limit(size.width, size.height);
  for (Eigen::Index p = 0; p < next.points.rows(); ++p) {
    const Eigen::RowVector2d place = next.points.row(p);
    if (!place.allFinite() || (place.array() < -limit.array()).any() || (place.array() > 2 * limit.array()).any())
      throw std::invalid_argument(fmt::format("point {} is far outside the picture", p));
    if (next.done && ((place.array() < 0).any() || (place.array() > limit.array() - 1).any()))
      throw std::invalid_argument(fmt::format("point {} lies outside the picture: nothing could be learnt from it", p));
  }
  return annotations_.write(clip(frame), frames_[frame].number, next, tag);
}

Beginning Project::begin(std::size_t frame) {
  std::vector<Example> examples;
  std::string state;
  for (std::size_t other = 0; other < frames_.size(); ++other) {
    const auto known = other == frame ? std::nullopt : annotation(other);
    if (!known || !known->done) continue;
    examples.push_back({picture(other), known->points});
    state += tag_of(known) + " ";
  }
  return beginner_.begin(picture(frame), examples, state, scheme_name_);
}

}  // namespace talkgraph::annotate
