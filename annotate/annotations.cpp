#include "annotate/annotations.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "graph/key.h"
#include "graph/output_file.h"
#include "nodes/corpus/landmarks.h"
#include "nodes/corpus/text.h"
#include "nodes/write/landmarks.h"

namespace talkgraph::annotate {
namespace {

namespace fs = std::filesystem;
constexpr auto done_ending = ".pts", draft_ending = ".draft";

bool has_ending(const fs::path& file, const char* ending) { return lower_case(file.extension().string()) == ending; }

bool is_done(const fs::path& file) { return has_ending(file, done_ending); }

bool is_annotation(const fs::path& file) {
  return (is_done(file) || has_ending(file, draft_ending)) && frame_in_name(file);
}

void give_ending(fs::path& file, const char* ending) {
  auto renamed = fs::path(file).replace_extension(ending);
  fs::rename(file, renamed);
  file = std::move(renamed);
}

/// Nothing is thrown away.
void put_aside(const fs::path& file) {
  auto aside = file;
  do aside += ".broken";
  while (fs::exists(aside));
  fs::rename(file, aside);
}

}  // namespace

std::string tag_of(const Kept& kept) {
  if (!kept.broken.empty()) return KeyMaker().add(kept.broken).key().str();
  if (!kept.annotation) return "none";
  return KeyMaker().add(pts_text(kept.annotation->points)).add(kept.annotation->done ? "done" : "draft").key().str();
}

Annotations::Annotations(fs::path folder, Eigen::Index points) : folder_(std::move(folder)), points_(points) {
  if (fs::is_directory(folder_)) sweep_parts(folder_);
}

std::vector<fs::path> Annotations::files(const std::string& clip) const {
  std::vector<fs::path> found;
  if (fs::is_directory(folder_ / clip))
    for (const auto& entry : fs::directory_iterator(folder_ / clip))
      if (is_annotation(entry.path())) found.push_back(entry.path());
  return found;
}

std::vector<fs::path> Annotations::files(const std::string& clip, std::int64_t frame) const {
  auto found = files(clip);
  std::erase_if(found, [&](const fs::path& file) { return frame_in_name(file) != frame; });
  std::sort(found.begin(), found.end());
  return found;
}

Kept Annotations::read_unlocked(const std::string& clip, std::int64_t frame) const try {
  const auto found = files(clip, frame);
  if (found.empty()) return {};
  const auto& file = found.front();
  if (found.size() > 1)
    return {{},
            fmt::format("{}: {} is of frame {} too; remove one of them", file.string(), found[1].filename().string(),
                        frame)};
  Annotation annotation{read_pts(file.string()), is_done(file)};
  if (annotation.points.rows() != points_)
    return {{},
            fmt::format("{}: holds {} points, the scheme has {}", file.string(), annotation.points.rows(), points_)};
  return {std::move(annotation), ""};
} catch (const std::runtime_error& e) {
  return {{}, e.what()};
}

Kept Annotations::read(const std::string& clip, std::int64_t frame) const {
  const std::lock_guard lock(mutex_);
  return read_unlocked(clip, frame);
}

Annotations::Written Annotations::write(const std::string& clip, std::int64_t frame, const Annotation& next,
                                        const std::string& tag) {
  const std::lock_guard lock(mutex_);
  auto before = read_unlocked(clip, frame);
  if (tag_of(before) != tag) return {false, std::move(before)};
  if (!before.broken.empty())
    for (const auto& file : files(clip, frame)) put_aside(file);
  const auto there = files(clip, frame);
  auto file = there.empty() ? folder_ / clip / fmt::format("{:06}{}", frame, next.done ? done_ending : draft_ending)
                            : there.front();
  // A frame that is done becomes a draft first, and a draft done last: at no time are there two files, or none.
  if (!next.done && is_done(file)) give_ending(file, draft_ending);
  write_file(file, pts_text(next.points));
  if (next.done && !is_done(file)) give_ending(file, done_ending);
  return {true, read_unlocked(clip, frame)};
}

std::vector<std::int64_t> Annotations::frames(const std::string& clip) const {
  std::set<std::int64_t> found;
  for (const auto& file : files(clip)) found.insert(*frame_in_name(file));
  return {found.begin(), found.end()};
}

}  // namespace talkgraph::annotate
