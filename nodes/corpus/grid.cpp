#include "nodes/corpus/grid.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <set>
#include <stdexcept>

#include "nodes/corpus/faults.h"
#include "nodes/corpus/labels.h"
#include "nodes/corpus/landmarks.h"
#include "nodes/corpus/text.h"
#include "nodes/media/audio_file.h"
#include "nodes/media/video_file.h"

namespace talkgraph {
namespace {

namespace fs = std::filesystem;

struct Clip {
  std::string id, split;
};

/// The clips that split.json names, at most `limit` of each split.
std::vector<Clip> read_splits(const fs::path& file, int limit, Diagnostics& diagnostics) {
  const auto source = std::make_shared<SourceText>(SourceText{file.string(), read_text_file(file.string())});
  const auto parsed = parse_json(source, diagnostics);
  std::vector<Clip> clips;
  std::set<std::string> seen;
  if (!parsed) return clips;
  const LocatedJson& json = *parsed;
  if (!json.is(LocatedJson::Kind::object))
    diagnostics.error(json.place, "an object from splits to lists of clips is expected");
  for (const auto& split : json.members) {
    if (!split.value.is(LocatedJson::Kind::array)) diagnostics.error(split.value.place, "a list of clips is expected");
    int taken = 0;
    for (const auto& clip : split.value.items) {
      if (!clip.is(LocatedJson::Kind::text))
        diagnostics.error(clip.place, "the name of a clip is expected");
      else if (const auto id = clip.scalar.get<std::string>(); !seen.insert(id).second)
        diagnostics.error(clip.place, fmt::format("the clip \"{}\" stands here twice", id));
      else if (limit == 0 || taken++ < limit)
        clips.push_back({id, split.key});
    }
  }
  return clips;
}

struct Files {
  fs::path video, align, landmarks;
};

Files files_of(const fs::path& folder, const std::string& id) {
  return {folder / "video" / (id + ".mpg"), folder / "align" / (id + ".align"), folder / "landmarks" / (id + ".csv")};
}

/// Names the first of the files that are not there, and how many.
void check_files(const fs::path& folder, const std::vector<Clip>& clips, bool with_landmarks) {
  std::vector<std::string> missing;
  for (const auto& clip : clips) {
    const Files files = files_of(folder, clip.id);
    for (const auto& file : {files.video, files.align})
      if (!fs::is_regular_file(file)) missing.push_back(file.string());
    if (with_landmarks && !fs::is_regular_file(files.landmarks)) missing.push_back(files.landmarks.string());
  }
  if (missing.empty()) return;
  std::string text = fmt::format("{} files of the corpus that split.json names are missing:", missing.size());
  for (std::size_t i = 0; i < missing.size() && i < 10; ++i) text += "\n  " + missing[i];
  throw std::runtime_error(text + (missing.size() > 10 ? "\n  ..." : ""));
}

Recording read_clip(const fs::path& folder, const Clip& clip, bool with_landmarks) {
  const Files files = files_of(folder, clip.id);
  Recording recording;
  recording.id = clip.id;
  recording.split = clip.split;
  recording.audio = [path = files.video.string()] { return read_audio(path); };
  recording.video = [path = files.video.string()] { return open_video(path); };
  recording.key = [path = files.video] { return file_key(path); };
  attempt(recording, [&] {
    recording.words = read_words(files.align.string());
    recording.transcript = transcript_of(*recording.words);
  });
  attempt(recording, [&] {
    if (with_landmarks) recording.landmarks = read_landmarks({files.landmarks.string(), "ibug68"}, Rational(25));
  });
  return recording;
}

}  // namespace

Stream<Recording> Grid::operator()() const {
  const fs::path root(folder.path);
  if (!fs::is_directory(root))
    throw std::runtime_error(folder.path + ": there is no such folder; docs/grid.md says how to get the corpus");
  Diagnostics diagnostics;
  auto clips = read_splits(root / "split.json", limit, diagnostics);
  if (!diagnostics.ok()) throw std::runtime_error(diagnostics.str());
  const bool with_landmarks = fs::is_directory(root / "landmarks");
  if (!lenient) check_files(root, clips, with_landmarks);
  const std::size_t count = clips.size();
  return Stream<Recording>(
      [root, clips = std::move(clips), with_landmarks, lenient = lenient,
       i = std::size_t{0}]() mutable -> std::optional<Item<Recording>> {
        if (i == clips.size()) return {};
        auto recording = read_clip(root, clips[i++], with_landmarks);
        if (!lenient) refuse_faults(recording);
        return Item<Recording>{recording.id, std::move(recording)};
      },
      count);
}

void describe(Description<Grid>& d) {
  d.type("corpus.grid").summary("recordings of one speaker of the GRID corpus");
  d.output("recording", "one item a clip");
  d.param("folder", &Grid::folder).required().doc("holds split.json, video/, align/ and landmarks/");
  d.param("limit", &Grid::limit).at_least(0).doc("clips of each split, 0 for all");
  d.param("lenient", &Grid::lenient).doc(lenient_doc);
}

}  // namespace talkgraph
