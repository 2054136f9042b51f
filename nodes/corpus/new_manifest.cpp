#include "nodes/corpus/new_manifest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "nodes/corpus/ids.h"
#include "nodes/corpus/labels.h"
#include "nodes/corpus/text.h"
#include "nodes/media/video_file.h"
#include "nodes/types/visemes.h"

namespace talkgraph {
namespace {

namespace fs = std::filesystem;

constexpr const char* video_endings[] = {".mp4",  ".mov", ".mkv", ".avi", ".mpg", ".mpeg",
                                         ".webm", ".m4v", ".wmv", ".flv", ".ogv", ".mts"};
constexpr const char* sound_endings[] = {".wav", ".flac", ".ogg"};

std::string ending_of(const fs::path& path) { return lower_case(path.extension().string()); }

template <std::size_t N>
bool has_ending(const fs::path& path, const char* const (&endings)[N]) {
  return std::find(std::begin(endings), std::end(endings), ending_of(path)) != std::end(endings);
}

bool is_landmark_table(const fs::path& file) {
  const auto lines = lines_of(read_text_file(file.string()));
  const auto names = lines.empty() ? std::vector<std::string>{} : split(lines[0].text, ',');
  return std::find(names.begin(), names.end(), "x0") != names.end();
}

/// Files and folders of one name, endings left out.
struct Group {
  std::optional<fs::path> video, pictures, sound, landmarks;
  std::vector<fs::path> labels, texts;
};

using Groups = std::map<std::string, Group>;

/// The path below the folder without its ending, "/" as separator.
std::string name_of(const fs::path& path, const fs::path& folder, bool is_folder) {
  const fs::path below = path.lexically_relative(folder);
  return (is_folder ? below : below.parent_path() / below.stem()).generic_string();
}

void sort_in_file(const fs::path& path, const fs::path& folder, Groups& groups, std::vector<std::string>& notes) {
  auto& group = groups[name_of(path, folder, false)];
  const auto ending = ending_of(path);
  const auto take = [&](std::optional<fs::path>& place) {
    if (place)
      notes.push_back(fmt::format("{}: passed over, {} has the same name", path.string(), place->string()));
    else
      place = path;
  };
  if (has_ending(path, video_endings))
    take(group.video);
  else if (has_ending(path, sound_endings))
    take(group.sound);
  else if (ending == ".csv" && is_landmark_table(path))
    take(group.landmarks);
  else if (ending == ".txt")
    group.texts.push_back(path);
  else if (ending == ".lab" || ending == ".textgrid" || ending == ".align")
    group.labels.push_back(path);
}

bool holds_pictures(const fs::path& folder) {
  std::error_code unreadable;
  const fs::directory_iterator entries(folder, unreadable);
  return std::any_of(begin(entries), end(entries),
                     [](const auto& entry) { return is_picture_name(entry.path().filename().string()); });
}

/// All files and folders below a folder, but for hidden ones and what is told in the notes.
void list(const fs::path& folder, std::vector<fs::path>& all, std::vector<std::string>& notes) {
  std::error_code error;
  const fs::directory_iterator entries(folder, error);
  if (error) notes.push_back(fmt::format("{}: passed over, {}", folder.string(), error.message()));
  for (const auto& entry : entries) {
    const auto& path = entry.path();
    const std::string name = path.filename().string();
    if (name.starts_with('.')) continue;
    if (!is_utf8(name)) {
      notes.push_back(path.string() + ": passed over, its name is not UTF-8; rename it");
      continue;
    }
    all.push_back(path);
    if (entry.is_directory(error) && !entry.is_symlink(error)) list(path, all, notes);
  }
}

void sort_in(const fs::path& path, const fs::path& folder, Groups& groups, std::vector<std::string>& notes) try {
  constexpr std::string_view marks = "-landmarks";
  if (fs::is_regular_file(path)) return sort_in_file(path, folder, groups, notes);
  if (!fs::is_directory(path)) return;
  const auto name = name_of(path, folder, true);
  if (name.ends_with(marks))
    groups[name.substr(0, name.size() - marks.size())].landmarks = path;
  else if (holds_pictures(path))
    groups[name].pictures = path;
} catch (const std::runtime_error& e) {
  notes.push_back(fmt::format("{}: passed over; {}", path.string(), e.what()));
}

/// All that may belong to clips, in the order of names.
Groups groups_in(const fs::path& folder, std::vector<std::string>& notes) {
  std::vector<fs::path> all;
  list(folder, all, notes);
  std::sort(all.begin(), all.end());
  Groups groups;
  for (const auto& path : all) sort_in(path, folder, groups, notes);
  return groups;
}

std::vector<Interval> intervals(const fs::path& file, const char* tier) try {
  return read_intervals(file.string(), tier);
} catch (const std::runtime_error&) {
  return {};
}

bool are_phones(const std::vector<Interval>& labels) {
  const auto is_known = [](const Interval& i) { return is_phone(normalised_phone(i.label)); };
  return std::all_of(labels.begin(), labels.end(), is_known);
}

/// "start end label".
bool has_times(const std::string& line) {
  const auto is_time = [](const std::string& word) {
    return word.find_first_not_of("0123456789.") == std::string::npos;
  };
  const auto words = words_of(line);
  return words.size() > 2 && is_time(words[0]) && is_time(words[1]);
}

/// A .lab without times, as aligners take them, is a transcript.
std::optional<std::string> plain_text(const fs::path& file) {
  if (ending_of(file) != ".lab") return {};
  std::string all;
  for (const auto& line : lines_of(read_text_file(file.string()))) {
    if (has_times(line.text)) return {};
    all += (all.empty() ? "" : " ") + line.text;
  }
  if (!is_utf8(all)) throw std::runtime_error("it is not UTF-8");
  return all;
}

void add_labels(const fs::path& file, const std::string& name, Json& clip, std::vector<std::string>& notes) try {
  if (const auto text = plain_text(file)) {
    clip["transcript"] = *text;
    return;
  }
  bool taken = false;
  for (const char* tier : {"phones", "words"}) {
    const auto labels = intervals(file, tier);
    if (labels.empty() || are_phones(labels) != (tier == std::string_view("phones")) || clip.contains(tier)) continue;
    clip[tier] = name;
    taken = true;
  }
  if (!taken) notes.push_back(fmt::format("{}: passed over, neither phones nor words with times", file.string()));
} catch (const std::runtime_error& e) {
  notes.push_back(fmt::format("{}: passed over; {}", file.string(), e.what()));
}

Json clip_of(std::string id, const Group& group, const fs::path& folder, std::vector<std::string>& notes) {
  const auto relative = [&](const fs::path& path) { return path.lexically_relative(folder).generic_string(); };
  Json clip = {{"id", std::move(id)}, {"video", relative(group.video ? *group.video : *group.pictures)}};
  if (group.sound) clip["audio"] = relative(*group.sound);
  if (group.landmarks) clip["landmarks"] = relative(*group.landmarks);
  for (const auto& file : group.labels) add_labels(file, relative(file), clip, notes);
  if (!group.texts.empty()) clip["transcript"] = relative(group.texts.front());
  return clip;
}

/// Every so manieth clip, so that `share` of them are chosen, from the middle of each stretch.
bool is_chosen(std::size_t i, double share, double phase) {
  return std::floor((static_cast<double>(i) + 1) * share + phase) > std::floor(static_cast<double>(i) * share + phase);
}

}  // namespace

NewManifest::Out NewManifest::operator()(const fs::path& given) const {
  if (!fs::is_directory(given)) throw std::runtime_error(given.string() + ": there is no such folder");
  const fs::path folder = fs::absolute(given).lexically_normal();
  Out out;
  const auto groups = groups_in(folder, out.notes);
  std::vector<std::string> names;
  for (const auto& [name, group] : groups) {
    if (group.video || (group.pictures && group.sound && rate)) {
      names.push_back(name);
    } else if (group.pictures) {
      out.notes.push_back(fmt::format("{}: passed over, a folder of pictures needs {}", group.pictures->string(),
                                      group.sound ? "--rate, its frames per second" : "its sound beside it"));
    }
  }
  if (names.empty())
    throw std::runtime_error(given.string() + ": no videos, nor folders of pictures with sound beside them" +
                             (out.notes.empty() ? "" : "; " + out.notes.front()));
  std::sort(names.begin(), names.end(), natural_less);
  Json clips = Json::array();
  std::set<std::string> ids;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    clips.push_back(clip_of(unique_id(names[i], ids), groups.at(names[i]), folder, out.notes));
    if (names.size() < 10) continue;
    if (is_chosen(i, test, 0.5))
      clips.back()["split"] = "test";
    else if (is_chosen(kept++, test < 1 ? validation / (1 - test) : 0, 0.5))
      clips.back()["split"] = "validation";
  }
  if (rate) out.manifest["rate"] = rate->str();
  out.manifest["clips"] = clips;
  return out;
}

}  // namespace talkgraph
