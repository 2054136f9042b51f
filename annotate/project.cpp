#include "annotate/project.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <set>
#include <stdexcept>

#include "graph/key.h"
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
std::string with_landmarks(std::string text, const Place& before, const Json& landmarks) {
  const auto at = offset_of(before, text);
  const auto line = text.rfind('\n', at) + 1;  // 0 in the first line
  const std::string indent = text.substr(line, at - line);
  const bool alone = line > 0 && indent.find_first_not_of(" \t") == std::string::npos;
  return text.insert(at, fmt::format("\"landmarks\": {},{}", landmarks.dump(), alone ? "\n" + indent : " "));
}

/// Writes a file anew with the rights that it had, also through a symbolic link.
void rewrite_file(const std::string& path, const std::string& text) {
  if (access(path.c_str(), W_OK) != 0)
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
  OutputFile whole(fs::canonical(path));
  write_file(whole.part(), text);
  fs::permissions(whole.part(), fs::status(path).permissions());
  whole.finish();
}

/// "annotated" beside manifest.json; manifests of other names have folders of their own.
std::string folder_beside(const fs::path& manifest) {
  if (manifest.filename() == "manifest.json") return "annotated";
  const auto name = manifest.extension() == ".json" ? manifest.stem() : manifest.filename();
  return name.string() + "-annotated";
}

bool is_ours(const ManifestClip& clip, const fs::path& folder) {
  return clip.landmarks.path.empty() || fs::path(clip.landmarks.path).parent_path() == folder;
}

/// Opened once, when first asked for.
std::function<Video()> pictures_of(const ManifestClip& clip) {
  return [clip, video = Video()]() mutable {
    if (!video.source) video = open_pictures(clip);
    return video;
  };
}

std::vector<Clip> clips_to_annotate(const std::vector<ManifestClip>& all, const fs::path& folder) {
  std::vector<Clip> clips;
  for (const auto& clip : all) {
    if (clip.split != "train" || clip.video.empty() || !is_ours(clip, folder)) continue;
    clips.push_back({clip.id, pictures_of(clip), {}});
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

/// Throws std::runtime_error if no file can be made in a folder.
void check_writable(const fs::path& folder) {
  const OutputFile probe(folder / "probe");
  errno = 0;
  if (!std::ofstream(probe.part()))
    throw std::runtime_error(fmt::format("{}: cannot be written to: {}", folder.string(), std::strerror(errno)));
}

}  // namespace

/// Where annotations are, as the manifest says it or will be told.
struct Project::Destination {
  fs::path folder;
  std::string scheme;  ///< as landmarks carry it
  Json untold;

  static Destination find(const std::string& manifest, const std::string& scheme, Diagnostics& diagnostics) {
    const auto said = read_landmark_folder(manifest, diagnostics);
    const bool own = scheme.ends_with(".json");
    const auto wanted = own ? scheme_text(scheme, diagnostics) : scheme;
    if (!diagnostics.ok()) return {};
    const std::string usual = "ibug68";
    if (!said.path.empty()) {
      const auto& there = said.scheme.empty() ? usual : said.scheme;
      if (!scheme.empty() && wanted != there)
        throw std::invalid_argument(manifest + ": names another point scheme; change it there, with another folder");
      return {said.path, there, {}};
    }
    const auto chosen = wanted.empty() ? usual : wanted;
    if (!find_scheme(chosen)) throw std::invalid_argument(unknown_scheme(chosen));
    const auto home = fs::absolute(manifest).parent_path();
    const auto name = folder_beside(manifest);
    const auto named = own ? fs::relative(fs::absolute(scheme), home).string() : chosen;
    return {home / name, chosen, {{"folder", name}, {"scheme", named}}};
  }
};

std::unique_ptr<Project> Project::open(const std::string& manifest, const ProjectOptions& options,
                                       Diagnostics& diagnostics) {
  const auto all = read_manifest(manifest, diagnostics);
  if (!diagnostics.ok()) return nullptr;
  auto destination = Destination::find(manifest, options.scheme, diagnostics);
  if (!diagnostics.ok()) return nullptr;
  auto clips = clips_to_annotate(all, destination.folder);
  if (clips.empty())
    throw std::runtime_error(
        manifest +
        ": there is no clip to annotate: none of the split \"train\" has a \"video\" and no landmarks of its own");
  return std::unique_ptr<Project>(new Project(manifest, std::move(clips), std::move(destination), options));
}

void Project::tell_manifest() const {
  if (untold_.is_null()) return;
  Diagnostics diagnostics;
  const auto said = read_landmark_folder(manifest_, diagnostics);
  if (!diagnostics.ok() || !said.path.empty())
    throw std::runtime_error(manifest_ + ": was changed by another program just now; start again");
  rewrite_file(manifest_, with_landmarks(read_text_file(manifest_), said.place, untold_));
}

FolderLock::FolderLock(const fs::path& folder) {
  check_writable(folder);
  descriptor_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ >= 0 && flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  const bool taken = errno == EWOULDBLOCK;
  if (descriptor_ >= 0) close(descriptor_);
  throw std::runtime_error(folder.string() + (taken ? ": is being annotated by another talkgraph already; open its page"
                                                    : ": cannot be locked"));
}

FolderLock::~FolderLock() { close(descriptor_); }

Project::Project(std::string manifest, std::vector<Clip> clips, Destination destination, const ProjectOptions& options)
    : manifest_(std::move(manifest)),
      clips_(std::move(clips)),
      scheme_(*find_scheme(destination.scheme)),
      scheme_name_(std::move(destination.scheme)),
      untold_(std::move(destination.untold)),
      lock_(destination.folder),
      annotations_(std::move(destination.folder), scheme_.points()),
      frames_(all_frames(clips_, annotations_, options)),
      beginner_(scheme_.mean) {
  const auto where = fs::canonical(folder()).string();
  std::map<std::size_t, Key> pictures;
  for (const auto& [c, number, phone] : frames_) {
    const auto& id = clips_[c].id;
    if (!pictures.contains(c)) {
      pictures[c] = clips_[c].video().source->key();
      if (fs::exists(folder() / id)) check_writable(folder() / id);
    }
    KeyMaker maker;
    maker.add(where).add(scheme_name_).add(id).add(pictures[c]).add(std::to_string(number));
    keys_.push_back(maker.key().str());
  }
}

std::optional<std::size_t> Project::find(const std::string& key) const {
  const auto found = std::find(keys_.begin(), keys_.end(), key);
  return found == keys_.end() ? std::nullopt : std::optional<std::size_t>(found - keys_.begin());
}

bool Project::has_frame(std::size_t clip, std::int64_t from, std::int64_t to) const {
  return std::any_of(frames_.begin(), frames_.end(), [&](const Frame& frame) {
    return frame.clip == clip && frame.number >= from && frame.number < to;
  });
}

void Project::read(std::size_t frame, Film& film, const Context& context) {
  const auto [clip, number, phone] = frames_[frame];
  const auto length = source(frame).frames();
  if (film.next > number || number >= length) return;
  if (!film.reader) film.reader = source(frame).open();
  for (cv::Mat picture; film.next <= number && film.reader->next(picture); ++film.next) {
    context.check_cancelled();
    if (has_frame(clip, film.next, film.next + 1)) film.pictures[film.next] = picture.clone();
  }
  if (!has_frame(clip, film.next, length)) film.reader.reset();
}

cv::Mat Project::picture(std::size_t frame, const Context& context) {
  const std::lock_guard lock(films_mutex_);
  auto& film = films_[frames_[frame].clip];
  const auto number = frames_[frame].number;
  try {
    read(frame, film, context);
  } catch (const std::runtime_error&) {
    film.reader.reset();
    film.next = 0;
    throw;
  }
  const auto found = film.pictures.find(number);
  if (found == film.pictures.end())
    throw std::runtime_error(fmt::format("{}: has no frame {}", source(frame).name(), number));
  return found->second;
}

Kept Project::kept(std::size_t frame) const {
  const auto number = frames_[frame].number, length = source(frame).frames();
  if (number >= length)
    return {{},
            fmt::format("{}: there is a file of frame {}, and the clip has the frames 0 to {}; remove the file",
                        (folder() / clip(frame)).string(), number, length - 1)};
  return annotations_.read(clip(frame), number);
}

Annotations::Written Project::annotate(std::size_t frame, const Annotation& next, const std::string& tag) {
  if (next.points.rows() != scheme_.points())
    throw std::invalid_argument(fmt::format("{} points are needed, got {}", scheme_.points(), next.points.rows()));
  const cv::Size size = source(frame).size();
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

Beginning Project::begin(std::size_t frame, const Context& context) {
  std::vector<Example> examples;
  std::string state;
  for (std::size_t other = 0; other < frames_.size(); ++other) {
    const auto known = other == frame ? Kept() : kept(other);
    if (!known.annotation || !known.annotation->done) continue;
    examples.push_back({picture(other, context), known.annotation->points});
    state += tag_of(known) + " ";
  }
  return beginner_.begin(picture(frame, context), examples, state, scheme_name_, context);
}

}  // namespace talkgraph::annotate
