#include "annotate/annotations.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "graph/key.h"
#include "graph/output_file.h"
#include "nodes/corpus/landmarks.h"
#include "nodes/write/landmarks.h"

namespace talkgraph::annotate {
namespace {

namespace fs = std::filesystem;
constexpr auto done_ending = ".pts", draft_ending = ".draft";

fs::path file_of(const fs::path& folder, const std::string& clip, std::int64_t frame, bool done) {
  return folder / clip / fmt::format("{:06}{}", frame, done ? done_ending : draft_ending);
}

bool is_number(const std::string& text) {
  return !text.empty() && text.size() < 12 && text.find_first_not_of("0123456789") == std::string::npos;
}

/// Of two files of a frame, left when a process was killed between writing one and removing the other, the draft
/// counts.
void remove_doubles(const fs::path& folder) {
  std::vector<fs::path> doubles;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == draft_ending)
      if (const auto other = fs::path(entry.path()).replace_extension(done_ending); fs::exists(other))
        doubles.push_back(other);
  for (const auto& file : doubles) fs::remove(file);
}

}  // namespace

std::string tag_of(const std::optional<Annotation>& annotation) {
  if (!annotation) return "none";
  return KeyMaker().add(pts_text(annotation->points)).add(annotation->done ? "done" : "draft").key().str();
}

Annotations::Annotations(fs::path folder, Eigen::Index points) : folder_(std::move(folder)), points_(points) {
  if (!fs::is_directory(folder_)) return;
  sweep_parts(folder_);
  remove_doubles(folder_);
}

std::optional<Annotation> Annotations::read_unlocked(const std::string& clip, std::int64_t frame) const {
  for (const bool done : {false, true}) {
    const auto file = file_of(folder_, clip, frame, done);
    if (!fs::exists(file)) continue;
    Annotation found{read_pts(file.string()), done};
    if (found.points.rows() != points_)
      throw std::runtime_error(
          fmt::format("{}: holds {} points, the scheme has {}", file.string(), found.points.rows(), points_));
    return found;
  }
  return {};
}

std::optional<Annotation> Annotations::read(const std::string& clip, std::int64_t frame) const {
  const std::lock_guard lock(mutex_);
  return read_unlocked(clip, frame);
}

Annotations::Written Annotations::write(const std::string& clip, std::int64_t frame, const Annotation& next,
                                        const std::string& tag) {
  const std::lock_guard lock(mutex_);
  auto before = read_unlocked(clip, frame);
  if (tag_of(before) != tag) return {false, std::move(before)};
  write_file(file_of(folder_, clip, frame, next.done), pts_text(next.points));
  if (before && before->done != next.done) fs::remove(file_of(folder_, clip, frame, before->done));
  return {true, read_unlocked(clip, frame)};
}

std::vector<std::int64_t> Annotations::frames(const std::string& clip) const {
  std::set<std::int64_t> found;
  if (!fs::is_directory(folder_ / clip)) return {};
  for (const auto& entry : fs::directory_iterator(folder_ / clip)) {
    const auto& file = entry.path();
    if ((file.extension() == done_ending || file.extension() == draft_ending) && is_number(file.stem().string()))
      found.insert(std::stoll(file.stem().string()));
  }
  return {found.begin(), found.end()};
}

}  // namespace talkgraph::annotate
