#include "nodes/corpus/files.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <stdexcept>

#include "nodes/corpus/ids.h"
#include "nodes/media/audio_file.h"

namespace talkgraph {
namespace {

void check_files(const std::vector<FilePath>& files) {
  std::string complaints;
  for (const auto& file : files)
    if (!std::filesystem::exists(file.path) || std::filesystem::is_directory(file.path))
      complaints +=
          fmt::format("{}{}: {}", complaints.empty() ? "" : "\n", file.path,
                      std::filesystem::exists(file.path) ? "is a folder; name its files" : "there is no such file");
  if (!complaints.empty()) throw std::runtime_error(complaints);
}

}  // namespace

Stream<Recording> SoundFiles::operator()() const {
  if (!transcripts.empty() && transcripts.size() != files.size())
    throw std::invalid_argument(
        fmt::format("{} files but {} transcripts: give one for each file, or none", files.size(), transcripts.size()));
  check_files(files);
  std::vector<Item<Recording>> items;
  std::set<std::string> taken;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string& path = files[i].path;
    Recording recording;
    recording.id = unique_id(std::filesystem::path(path).stem().string(), taken);
    recording.audio = [path] { return read_audio(path); };
    recording.key = [path] { return file_key(path); };
    if (!transcripts.empty() && !transcripts[i].empty()) recording.transcript = Transcript{transcripts[i]};
    items.push_back({recording.id, recording});
  }
  const std::size_t count = items.size();
  return Stream<Recording>(
      [items = std::move(items), i = std::size_t{0}]() mutable -> std::optional<Item<Recording>> {
        if (i == items.size()) return {};
        return items[i++];
      },
      count);
}

void describe(Description<SoundFiles>& d) {
  d.type("corpus.files").summary("speech files without pictures");
  d.output("recording", "one item a file, by its name");
  d.param("files", &SoundFiles::files).required().doc("sound files, or videos whose sound is taken");
  d.param("transcripts", &SoundFiles::transcripts).doc("what is said, one text a file; may be empty");
}

}  // namespace talkgraph
