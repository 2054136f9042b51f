#include "nodes/corpus/manifest_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "nodes/corpus/ids.h"
#include "nodes/corpus/text.h"
#include "nodes/types/scheme.h"

namespace talkgraph {
namespace {

namespace fs = std::filesystem;
using Kind = LocatedJson::Kind;

/// Reads the members of one JSON object, complaining of what is wrong with them.
class Members {
 public:
  Members(const LocatedJson& json, const fs::path& folder, Diagnostics& diagnostics, std::vector<std::string> known)
      : json_(json), folder_(folder), diagnostics_(diagnostics) {
    for (const auto& member : json.members)
      if (std::find(known.begin(), known.end(), member.key) == known.end())
        diagnostics.error(member.key_place,
                          fmt::format("unknown member \"{}\"{}", member.key, did_you_mean(member.key, known)));
  }

  bool has(const char* key) const { return json_.find(key); }
  const LocatedJson& at(const char* key) const { return json_.find(key)->value; }

  void text(const char* key, std::string& value) const {
    if (!has(key)) return;
    if (!at(key).is(Kind::text)) return wrong_kind(key, "a text");
    value = at(key).scalar.get<std::string>();
  }

  void rate(const char* key, std::optional<Rational>& value) const {
    if (!has(key)) return;
    const LocatedJson& json = at(key);
    if (!json.is(Kind::number) && !json.is(Kind::text)) return wrong_kind(key, "a rate such as 25 or \"30000/1001\"");
    try {
      const auto rate = Rational::parse(json.is(Kind::text) ? json.scalar.get<std::string>() : json.scalar.dump());
      if (rate.num() <= 0) throw std::invalid_argument("must be positive");
      value = rate;
    } catch (const std::invalid_argument& e) {
      diagnostics_.error(json.place, fmt::format("\"{}\": {}", key, e.what()));
    }
  }

  /// A file (or folder, where one may stand) that must be there; its ending must be
  /// one of `endings`, unless that is empty.
  void path(const char* key, std::string& value, const std::vector<std::string>& endings, bool folder_too) const {
    std::string name;
    text(key, name);
    if (name.empty()) return;
    const fs::path full = (folder_ / name).lexically_normal();
    const std::string ending = lower_case(full.extension().string());
    if (fs::is_directory(full) ? !folder_too : !fs::is_regular_file(full))
      diagnostics_.error(at(key).place,
                         fmt::format("there is no {} \"{}\"", folder_too ? "file or folder" : "file", full.string()));
    else if (!endings.empty() && !fs::is_directory(full) &&
             std::find(endings.begin(), endings.end(), ending) == endings.end())
      diagnostics_.error(at(key).place, fmt::format("\"{}\" must end in one of {}", key, fmt::join(endings, ", ")));
    value = full.string();
  }

  void flag(const char* key, bool& value) const {
    if (!has(key)) return;
    if (!at(key).is(Kind::boolean)) return wrong_kind(key, "true or false");
    value = at(key).scalar.get<bool>();
  }

  void wrong_kind(const char* key, const char* expected) const {
    diagnostics_.error(at(key).place,
                       fmt::format("\"{}\": {} is expected, got {}", key, expected, at(key).kind_name()));
  }

  void error(std::string text) const { diagnostics_.error(json_.place, std::move(text)); }
  Members within(const char* key, std::vector<std::string> known) const {
    return {at(key), folder_, diagnostics_, std::move(known)};
  }

 private:
  const LocatedJson& json_;
  const fs::path& folder_;
  Diagnostics& diagnostics_;
};

void read_visual(const Members& clip, ManifestClip& out) {
  if (!clip.has("visual")) return;
  if (!clip.at("visual").is(Kind::object)) return clip.wrong_kind("visual", "an object with \"file\" and \"rate\"");
  const Members visual = clip.within("visual", {"file", "rate", "dataset"});
  if (!visual.has("file")) visual.error("\"visual\" needs a \"file\"");
  visual.path("file", out.visual, {".csv", ".npy", ".h5", ".hdf5"}, false);
  visual.rate("rate", out.visual_rate);
  visual.text("dataset", out.visual_dataset);
  if (!out.visual_rate) out.visual_rate = out.rate;
  if (!out.visual_rate) visual.error("\"visual\" needs a \"rate\", frames per second");
}

/// The name of a built-in scheme, or the text of the scheme file named.
void read_scheme(const Members& landmarks, const fs::path& folder, std::string& scheme, Diagnostics& diagnostics) try {
  landmarks.text("scheme", scheme);
  if (scheme.empty()) return;
  if (scheme.ends_with(".json")) {
    std::string path;
    landmarks.path("scheme", path, {}, false);
    scheme = fs::is_regular_file(folder / scheme) ? scheme_text(path, diagnostics) : "";
  } else if (!find_scheme(scheme)) {
    diagnostics.error(landmarks.at("scheme").place, unknown_scheme(scheme));
  }
} catch (const std::runtime_error& e) {  // of a scheme as a text
  diagnostics.error(landmarks.at("scheme").place, e.what());
}

void read_landmarks(const Members& clip, const fs::path& folder, LandmarkFiles& out, Diagnostics& diagnostics) {
  if (!clip.has("landmarks")) return;
  const std::vector<std::string> endings{".csv", ".h5", ".hdf5"};
  if (clip.at("landmarks").is(Kind::text)) return clip.path("landmarks", out.path, endings, true);
  if (!clip.at("landmarks").is(Kind::object))
    return clip.wrong_kind("landmarks", "a file, or an object with \"file\" and \"scheme\"");
  const Members landmarks = clip.within("landmarks", {"file", "scheme", "dataset", "sparse"});
  landmarks.path("file", out.path, endings, true);
  landmarks.text("dataset", out.dataset);
  landmarks.flag("sparse", out.sparse);
  read_scheme(landmarks, folder, out.scheme, diagnostics);
}

/// A transcript that ends in .txt names a file, any other is the text itself.
void read_transcript(const Members& clip, ManifestClip& out) {
  clip.text("transcript", out.transcript);
  if (!lower_case(out.transcript).ends_with(".txt")) return;
  out.transcript.clear();
  clip.path("transcript", out.transcript_file, {}, false);
}

void check_id(const Members& clip, const std::string& id) {
  if (id.empty()) return clip.error("a clip needs an \"id\"");
  if (!is_id(id))
    clip.error("an \"id\" names files: at most 100 bytes, without '/' and control characters, not beginning with '.'");
}

ManifestClip read_clip(const LocatedJson& json, const fs::path& folder, const std::optional<Rational>& rate,
                       Diagnostics& diagnostics) {
  const Members clip(json, folder, diagnostics,
                     {"id", "split", "rate", "video", "audio", "visual", "phones", "words", "transcript", "landmarks"});
  ManifestClip out;
  out.rate = rate;
  clip.text("id", out.id);
  clip.text("split", out.split);
  clip.rate("rate", out.rate);
  clip.path("video", out.video, {}, true);
  clip.path("audio", out.audio, {}, false);
  clip.path("phones", out.phones, {".lab", ".textgrid", ".align"}, false);
  clip.path("words", out.words, {".lab", ".textgrid", ".align"}, false);
  read_visual(clip, out);
  read_landmarks(clip, folder, out.landmarks, diagnostics);
  read_transcript(clip, out);
  check_id(clip, out.id);
  const bool folder_of_pictures = fs::is_directory(out.video);
  if (out.audio.empty() && (out.video.empty() || folder_of_pictures))
    clip.error("a clip needs sound: \"audio\", or a \"video\" file with a sound track");
  if (folder_of_pictures && !out.rate) clip.error("a folder of pictures needs a \"rate\", frames per second");
  if (!out.landmarks.path.empty() && out.video.empty() && !out.rate)
    clip.error("landmarks without a \"video\" need a \"rate\", frames per second");
  if (out.landmarks.sparse && out.video.empty()) clip.error("\"sparse\" landmarks need a \"video\"");
  return out;
}

LandmarkFolder read_landmark_folder(const Members& manifest, const fs::path& folder, Diagnostics& diagnostics) {
  LandmarkFolder out;
  if (!manifest.has("landmarks")) return out;
  if (!manifest.at("landmarks").is(Kind::object))
    return manifest.wrong_kind("landmarks", "an object with \"folder\" and \"scheme\""), out;
  const Members landmarks = manifest.within("landmarks", {"folder", "scheme"});
  landmarks.text("folder", out.path);
  if (out.path.empty()) return landmarks.error("\"landmarks\" needs a \"folder\""), out;
  fs::path path = (folder / out.path).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  out.path = path.string();
  read_scheme(landmarks, folder, out.scheme, diagnostics);
  return out;
}

bool holds_points(const fs::path& folder) {
  if (!fs::is_directory(folder)) return false;
  const fs::directory_iterator entries(folder);
  return std::any_of(begin(entries), end(entries),
                     [](const auto& entry) { return lower_case(entry.path().extension().string()) == ".pts"; });
}

/// Landmarks of some frames in a folder of the clip's name, unless the clip has its own.
void take_annotated(const LandmarkFolder& from, ManifestClip& clip) {
  const fs::path folder = fs::path(from.path) / clip.id;
  if (from.path.empty() || clip.id.empty() || clip.video.empty() || !clip.landmarks.path.empty()) return;
  if (holds_points(folder)) clip.landmarks = {.path = folder.string(), .scheme = from.scheme, .sparse = true};
}

std::optional<LocatedJson> read_object(const std::string& file, Diagnostics& diagnostics) {
  const auto source = std::make_shared<SourceText>(SourceText{file, read_text_file(file)});
  auto json = parse_json(source, diagnostics);
  if (!json || json->is(Kind::object)) return json;
  diagnostics.error(json->place, "a manifest is an object with a list \"clips\"");
  return {};
}

}  // namespace

std::vector<ManifestClip> read_manifest(const std::string& file, Diagnostics& diagnostics) {
  std::vector<ManifestClip> clips;
  const auto json = read_object(file, diagnostics);
  if (!json) return clips;
  const fs::path folder = fs::absolute(file).parent_path();
  const Members manifest(*json, folder, diagnostics, {"$schema", "description", "rate", "landmarks", "clips"});
  std::optional<Rational> rate;
  manifest.rate("rate", rate);
  if (!manifest.has("clips")) return manifest.error("a manifest needs a list \"clips\""), clips;
  if (!manifest.at("clips").is(Kind::array)) return manifest.wrong_kind("clips", "a list of clips"), clips;
  const auto annotated = read_landmark_folder(manifest, folder, diagnostics);
  std::map<std::string, int> lines;
  for (const auto& item : manifest.at("clips").items) {
    if (!item.is(Kind::object)) {
      diagnostics.error(item.place, "a clip is an object with an \"id\"");
      continue;
    }
    clips.push_back(read_clip(item, folder, rate, diagnostics));
    const std::string& id = clips.back().id;
    const auto [other, fresh] = lines.emplace(id, item.place.line);
    if (!fresh && !id.empty())
      diagnostics.error(item.find("id")->value.place,
                        fmt::format("the clip in line {} has the id \"{}\" already", other->second, id));
    take_annotated(annotated, clips.back());
  }
  return clips;
}

LandmarkFolder read_landmark_folder(const std::string& file, Diagnostics& diagnostics) {
  const auto json = read_object(file, diagnostics);
  if (!json) return {};
  const fs::path folder = fs::absolute(file).parent_path();
  Diagnostics told_already;
  const Members manifest(*json, folder, told_already, {});
  auto found = read_landmark_folder(manifest, folder, diagnostics);
  const auto* member = json->find(manifest.has("landmarks") ? "landmarks" : "clips");
  if (member) found.place = member->key_place;
  return found;
}

std::string scheme_text(const std::string& path, Diagnostics& diagnostics) {
  const auto source = std::make_shared<SourceText>(SourceText{path, read_text_file(path)});
  return parse_scheme(source, diagnostics) ? parse_json(source, diagnostics)->plain().dump() : "";
}

}  // namespace talkgraph
