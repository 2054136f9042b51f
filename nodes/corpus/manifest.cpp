#include "nodes/corpus/manifest.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "nodes/corpus/faults.h"
#include "nodes/corpus/labels.h"
#include "nodes/corpus/tables.h"
#include "nodes/corpus/text.h"
#include "nodes/media/audio_file.h"
#include "nodes/media/video_file.h"

namespace talkgraph {
namespace {

Track read_visual(const ManifestClip& clip) {
  NumberTable table = read_table(clip.visual, clip.visual_dataset);
  return {std::move(table.values), *clip.visual_rate, 0.5 / clip.visual_rate->value(), std::move(table.names)};
}

/// The transcript as given, else from the word times.
std::optional<Transcript> transcript(const ManifestClip& clip, const std::optional<WordTrack>& words) {
  if (!clip.transcript_file.empty()) return Transcript{read_text_file(clip.transcript_file)};
  if (!clip.transcript.empty()) return Transcript{clip.transcript};
  if (words) return transcript_of(*words);
  return {};
}

Recording with_labels(const ManifestClip& clip) {
  Recording recording;
  recording.id = clip.id;
  recording.split = clip.split;
  attempt(recording, [&] {
    if (!clip.phones.empty()) recording.phones = read_phones(clip.phones);
  });
  attempt(recording, [&] {
    if (!clip.words.empty()) recording.words = read_words(clip.words);
  });
  attempt(recording, [&] { recording.transcript = transcript(clip, recording.words); });
  return recording;
}

/// Adds sound, pictures and tracks, which are too large to be read before they are asked for.
void add_media(const ManifestClip& clip, Recording& recording) {
  recording.audio = [path = clip.audio.empty() ? clip.video : clip.audio] { return read_audio(path); };
  if (!clip.video.empty()) recording.video = [clip] { return open_pictures(clip); };
  recording.key = [clip] {
    return KeyMaker().add(file_key(clip.audio)).add(file_key(clip.video)).add(clip.rate ? clip.rate->str() : "").key();
  };
  attempt(recording, [&] {
    if (!clip.visual.empty()) recording.visual = read_visual(clip);
  });
  attempt(recording, [&] {
    if (clip.landmarks.path.empty()) return;
    const Rational rate = clip.rate ? *clip.rate : recording.video().source->rate();
    recording.landmarks = read_landmarks(clip.landmarks, rate, recording.video);
  });
}

/// Throws what is wrong with the labels of all.
void refuse_faults(const std::vector<Recording>& recordings) {
  std::string complaints;
  for (const auto& recording : recordings)
    if (const auto text = faults_text(recording); !text.empty()) complaints += (complaints.empty() ? "" : "\n") + text;
  if (!complaints.empty()) throw std::runtime_error(complaints);
}

}  // namespace

Video open_pictures(const ManifestClip& clip) {
  return std::filesystem::is_directory(clip.video) ? open_frame_folder(clip.video, *clip.rate) : open_video(clip.video);
}

Stream<Recording> Manifest::operator()() const {
  Diagnostics diagnostics;
  auto clips = read_manifest(file.path, diagnostics);
  if (!diagnostics.ok()) throw std::runtime_error(diagnostics.str());
  std::vector<Recording> recordings;
  for (const auto& clip : clips) recordings.push_back(with_labels(clip));
  if (!lenient) refuse_faults(recordings);
  const std::size_t count = clips.size();
  return Stream<Recording>(
      [clips = std::move(clips), recordings = std::move(recordings), lenient = lenient,
       i = std::size_t{0}]() mutable -> std::optional<Item<Recording>> {
        if (i == clips.size()) return {};
        const std::size_t n = i++;
        add_media(clips[n], recordings[n]);
        if (!lenient) refuse_faults(recordings[n]);
        return Item<Recording>{clips[n].id, std::move(recordings[n])};
      },
      count);
}

void describe(Description<Manifest>& d) {
  d.type("corpus.manifest").summary("any recordings, as a JSON file describes them");
  d.output("recording", "one item a clip");
  d.param("file", &Manifest::file).required().doc("the manifest; docs/manifest.md says what stands in it");
  d.param("lenient", &Manifest::lenient).doc(lenient_doc);
}

}  // namespace talkgraph
