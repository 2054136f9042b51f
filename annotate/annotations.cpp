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

}  // namespace

std::string tag_of(const std::optional<Annotation>& annotation) {
  if (!annotation) return "none";
  return KeyMaker().add(pts_text(annotation->points)).add(annotation->done ? "done" : "draft").key().str();
}

Annotations::Annotations(fs::path folder, Eigen::Index points) : folder_(std::move(folder)), points_(points) {
  if (fs::is_directory(folder_)) sweep_parts(folder_);
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
  const auto draft = file_of(folder_, clip, frame, false), done = file_of(folder_, clip, frame, true);
  // A frame that is done becomes a draft first, and a draft done last: at no time are there two files, or none.
  if (before && before->done && !next.done) fs::rename(done, draft);
  const bool from_draft = before && !before->done && next.done;
  write_file(next.done && !from_draft ? done : draft, pts_text(next.points));
  if (from_draft) fs::rename(draft, done);
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
