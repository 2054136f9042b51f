#include "nodes/corpus/files.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <stdexcept>

#include "nodes/media/audio_file.h"

namespace talkgraph {
namespace {

std::string unique_id(const std::string& stem, std::set<std::string>& taken) {
  std::string id = stem;
  for (int n = 2; !taken.insert(id).second; ++n) id = fmt::format("{}-{}", stem, n);
  return id;
}

}  // namespace

Stream<Recording> SoundFiles::operator()() const {
  if (!transcripts.empty() && transcripts.size() != files.size())
    throw std::invalid_argument(
        fmt::format("{} files but {} transcripts: give one for each file, or none", files.size(), transcripts.size()));
  std::vector<Item<Recording>> items;
  std::set<std::string> taken;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string& path = files[i].path;
    if (!std::filesystem::is_regular_file(path)) throw std::runtime_error(path + ": there is no such file");
    Recording recording;
    recording.id = unique_id(std::filesystem::path(path).stem().string(), taken);
    recording.audio = [path] { return read_audio(path); };
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
  d.output("recording");
  d.param("files", &SoundFiles::files).required().doc("sound files, or videos whose sound is taken");
  d.param("transcripts", &SoundFiles::transcripts).doc("what is said, one text a file; may be empty");
}

}  // namespace talkgraph
