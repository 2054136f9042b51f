#include "cli/corpus.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <stdexcept>

#include "graph/output_file.h"
#include "nodes/corpus/manifest_file.h"
#include "nodes/corpus/new_manifest.h"
#include "nodes/corpus/text.h"
#include "nodes/types/median.h"
#include "nodes/types/recording.h"
#include "nodes/types/visemes.h"

namespace talkgraph::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* parts[] = {"transcript", "words", "phones", "landmarks"};
constexpr double tolerance = 0.25;       ///< seconds that sound and picture may differ by, as in corpus.parts
constexpr double least_frames = 25;      ///< of a clip whose lag is asked for
constexpr double colour_tolerance = 30;  ///< grey levels that the mean of a colour may differ from most clips'

double value(const Scores& scores, const std::string& name) {
  const auto at = scores.values.find(name);
  return at == scores.values.end() ? NAN : at->second;
}

/// How many clips have which value, the most frequent first.
std::vector<std::pair<double, int>> census(const std::vector<ClipFindings>& clips, const std::string& name) {
  std::map<double, int> counts;
  for (const auto& clip : clips)
    if (const double v = value(clip.findings, name); !std::isnan(v)) ++counts[v];
  std::vector<std::pair<double, int>> out(counts.begin(), counts.end());
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  return out;
}

/// Correlations by lag in frames.
using Lags = std::map<int, double>;

/// Nothing of a clip that is too short to tell.
Lags lags_of(const ClipFindings& clip) {
  Lags out;
  if (!(value(clip.findings, "frames") >= least_frames)) return out;
  for (const auto& [name, r] : clip.findings.values)
    if (name.starts_with("lag ")) out[std::stoi(name.substr(4))] = r;
  return out;
}

std::pair<int, double> peak(const Lags& lags) {
  const auto best = std::max_element(lags.begin(), lags.end(), [](auto a, auto b) { return a.second < b.second; });
  return *best;
}

/// The mean correlation of all clips at the lags that all have; nothing without a clip.
struct Offset {
  Lags mean;
  int clips = 0;
  double frames = 0;  ///< of these clips
};

/// Whether there is enough to tell the best lag from chance. By it three clips of GRID s1 with landmarks, 225 frames,
/// are within two frames in 995 of 1000 draws, ten clips without landmarks in 997.
bool is_clear(const Offset& offset) {
  constexpr double enough = 200, alike = 3, deviations = 3;  // about three neighbouring frames say what one would
  return offset.frames >= enough && peak(offset.mean).second > deviations / std::sqrt(offset.frames / alike);
}

Offset mean_lags(const std::vector<ClipFindings>& clips) {
  Offset out;
  std::map<int, int> counts;
  for (const auto& clip : clips) {
    const auto lags = lags_of(clip);
    if (lags.empty()) continue;
    ++out.clips;
    out.frames += value(clip.findings, "frames");
    for (const auto& [lag, r] : lags) out.mean[lag] += r, ++counts[lag];
  }
  for (const auto& [lag, count] : counts) {
    if (count == out.clips)
      out.mean[lag] /= count;
    else
      out.mean.erase(lag);
  }
  return out;
}

/// The top of the parabola through the peak and its neighbours, frames.
double between_frames(const Lags& lags, int at) {
  const auto before = lags.find(at - 1), after = lags.find(at + 1);
  if (before == lags.end() || after == lags.end()) return at;
  const double curve = before->second - 2 * lags.at(at) + after->second;
  return curve < 0 ? at + 0.5 * (before->second - after->second) / curve : at;
}

/// What most clips are like, where a single one may be otherwise.
struct Usual {
  double fps = 0;
  std::map<std::string, double> colours;  ///< medians
  Offset offset;
};

Usual usual_of(const std::vector<ClipFindings>& clips) {
  Usual out;
  if (const auto fps = census(clips, "fps"); !fps.empty()) out.fps = fps.front().first;
  for (const char* colour : {"red", "green", "blue"}) {
    std::vector<double> all;
    for (const auto& clip : clips)
      if (const double v = value(clip.findings, colour); !std::isnan(v)) all.push_back(v);
    if (all.empty()) continue;
    out.colours[colour] = median(all);
  }
  out.offset = mean_lags(clips);
  return out;
}

std::string share(double count, double of, const char* what) { return fmt::format("{:g} of {:g} {}", count, of, what); }

std::vector<std::string> problems_of(const ClipFindings& clip, const Usual& usual) {
  std::vector<std::string> out = clip.faults;
  const auto get = [&](const char* name) { return value(clip.findings, name); };
  const double frames = get("frames");
  if (get("damaged") > 0)
    out.push_back(share(get("damaged"), frames, "frames are damaged") +
                  fmt::format(" ({:g} to {:g})", get("damaged_from"), get("damaged_to")));
  if (get("sound_peak") < 1e-3) out.push_back("the sound is silent");
  if (std::abs(get("sound_seconds") - get("picture_seconds")) > tolerance)
    out.push_back(
        fmt::format("the sound lasts {:.2f} s, the picture {:.2f} s", get("sound_seconds"), get("picture_seconds")));
  if (!std::isnan(get("fps")) && get("fps") != usual.fps)
    out.push_back(fmt::format("{:.6g} frames a second, most clips have {:.6g}", get("fps"), usual.fps));
  for (const auto& [colour, median] : usual.colours)
    if (const double v = get(colour.c_str()); std::abs(v - median) > colour_tolerance)
      out.push_back(
          fmt::format("the picture's {} is {:.0f}, of most clips {:.0f}: are its colours right?", colour, v, median));
  if (std::abs(get("landmark_frames") - frames) > 2)
    out.push_back(fmt::format("landmarks of {:g} frames, the picture has {:g}", get("landmark_frames"), frames));
  if (get("landmark_gaps") > 0 && !clip.annotated)
    out.push_back(share(get("landmark_gaps"), get("landmark_frames"), "frames lack landmarks"));
  if (const auto lags = lags_of(clip); !lags.empty() && is_clear(usual.offset)) {
    const int expected = peak(usual.offset.mean).first;
    const auto [lag, r] = peak(lags);
    const bool clear = r >= 0.5 && lags.contains(expected) && r >= lags.at(expected) + 0.25;
    if (std::abs(lag - expected) >= 4 && clear)
      out.push_back(fmt::format("the picture seems to be {} frames {} against the other clips",
                                std::abs(lag - expected), lag > expected ? "late" : "early"));
  }
  return out;
}

/// The phones that a corpus can have: CMU's, and BEEP's where a label is of BEEP alone.
std::vector<std::string> phone_set(const std::map<std::string, double>& seen) {
  constexpr std::string_view beep_alone[] = {"ax", "ea", "ia", "oh", "ua"};
  const auto is_beep_alone = [&](std::string_view phone) {
    return std::find(std::begin(beep_alone), std::end(beep_alone), phone) != std::end(beep_alone);
  };
  const bool beep = std::any_of(seen.begin(), seen.end(), [&](const auto& p) { return is_beep_alone(p.first); });
  std::vector<std::string> out;
  for (const auto& [phone, viseme] : kVisemes)
    if (beep || !is_beep_alone(phone)) out.emplace_back(phone);
  std::sort(out.begin(), out.end());
  return out;
}

Json counts(const std::vector<std::pair<double, int>>& census) {
  Json out = Json::array();
  for (const auto& [v, count] : census) out.push_back({{"value", v}, {"clips", count}});
  return out;
}

std::string duration(double seconds) {
  const auto whole = std::lround(seconds);
  return whole < 60 ? fmt::format("{} s", whole) : fmt::format("{} min {} s", whole / 60, whole % 60);
}

/// "25 (256), 30 (2)", a single one without its count.
std::string census_text(const Json& census) {
  std::vector<std::string> out;
  for (const auto& entry : census)
    out.push_back(census.size() == 1
                      ? fmt::format("{:.6g}", entry["value"].get<double>())
                      : fmt::format("{:.6g} ({})", entry["value"].get<double>(), entry["clips"].get<int>()));
  return fmt::format("{}", fmt::join(out, ", "));
}

std::string some_of(const Json& names) {
  constexpr std::size_t most = 5;
  std::string out;
  for (std::size_t i = 0; i < names.size() && i < most; ++i) out += (i ? ", " : "") + names[i].get<std::string>();
  return names.size() > most ? out + ", ..." : out;
}

std::string lacking_text(const Json& report) {
  std::string out;
  const auto all = report["clips"].size();
  for (const char* part : parts) {
    const auto& names = report["lacking"][part];
    const auto annotated = part == std::string_view("landmarks") ? report["annotated"].size() : 0;
    const auto extra = annotated ? fmt::format("; in {} of some frames", annotated) : "";
    if (names.empty())
      out += fmt::format("  {:<12} all clips{}\n", part, extra);
    else if (names.size() == all)
      out += fmt::format("  {:<12} none\n", part);
    else
      out += fmt::format("  {:<12} {} of {} clips, not {}{}\n", part, all - names.size(), all, some_of(names), extra);
  }
  return out;
}

std::string phone_text(const Json& report) {
  std::string out;
  int column = 0;
  for (const auto& [phone, count] : report["phones"].items())
    out += fmt::format("{}{:<3}{:>6}", column++ % 10 == 0 ? "\n  " : "  ", phone, count.get<double>());
  return out + "\n";
}

std::string offset_text(const Json& offset) {
  if (offset.is_null()) return "not known: too little that is seen moving with the sound\n";
  const double frames = offset["frames"];
  const std::string where = std::abs(frames) < 1 ? "in time" : frames > 0 ? "the mouth is late" : "the mouth is early";
  return fmt::format("{:+.1f} frames, {:+.0f} ms: {} (correlation {:.2f}, {} clips)\n", frames,
                     offset["milliseconds"].get<double>(), where, offset["correlation"].get<double>(),
                     offset["clips"].get<int>());
}

/// A table of all clips, a line each.
std::string clip_table(const Json& report) {
  std::size_t width = 16;
  for (const auto& clip : report["clips"]) width = std::max(width, clip["id"].get_ref<const std::string&>().size());
  std::string out = fmt::format("{:<{}} {:<11} {:>8} {:>8} {:>9} {:>8} {:>8}\n", "clip", width, "split", "sound s",
                                "frames", "frames/s", "damaged", "lag");
  for (const auto& clip : report["clips"]) {
    const auto number = [&](const char* name, const char* format) {
      const auto& f = clip["findings"];
      return f.contains(name) ? fmt::format(fmt::runtime(format), f[name].get<double>()) : std::string("-");
    };
    out += fmt::format("{:<{}} {:<11} {:>8} {:>8} {:>9} {:>8} {:>8}\n", clip["id"].get<std::string>(), width,
                       clip["split"].get<std::string>(), number("sound_seconds", "{:.2f}"), number("frames", "{:g}"),
                       number("fps", "{:.6g}"), number("damaged", "{:g}"),
                       clip["lag"].is_null() ? "-" : fmt::format("{:+d}", clip["lag"].get<int>()));
  }
  return out;
}

/// The node that reads the corpus.
Json source_node(const std::string& source) {
  const auto path = fs::absolute(source).string();
  const bool folder = fs::is_directory(source);
  return {{"type", folder ? "corpus.grid" : "corpus.manifest"},
          {"params", {{folder ? "folder" : "file", path}, {"lenient", true}}}};
}

Json graph_of(const std::string& source) {
  return {{"nodes",
           {{"recordings", source_node(source)},
            {"inspect", {{"type", "corpus.inspect"}, {"in", {{"recording", "recordings"}}}}}}},
          {"outputs", {{"recordings", "recordings"}, {"findings", "inspect.findings"}, {"phones", "inspect.phones"}}}};
}

/// Throws std::invalid_argument unless the source is a manifest or a folder of GRID.
void check_source(const std::string& source) {
  const fs::path folder = source;
  if (!fs::exists(source))
    throw std::invalid_argument(source + ": there is no such manifest, nor folder of the GRID corpus");
  if (!is_utf8(fs::absolute(source).string()))
    throw std::invalid_argument(source + ": this name, or that of a folder it lies in, is not UTF-8; rename it");
  if (!fs::is_directory(source) || fs::exists(folder / "split.json")) return;
  if (fs::exists(folder / "manifest.json"))
    throw std::invalid_argument(
        fmt::format("{}: is a folder; its manifest is {}", source, (folder / "manifest.json").string()));
  throw std::invalid_argument(
      fmt::format("{}: is a folder, but not of the GRID corpus, which has a split.json; "
                  "talkgraph corpus new {} makes a manifest of the clips in it",
                  source, source));
}

/// The clips whose landmarks are of some frames only.
std::set<std::string> annotated_clips(const std::string& source) {
  std::set<std::string> out;
  if (fs::is_directory(source)) return out;
  Diagnostics diagnostics;
  for (const auto& clip : read_manifest(source, diagnostics))
    if (clip.landmarks.sparse) out.insert(clip.id);
  if (!diagnostics.ok()) throw std::runtime_error(diagnostics.str());
  return out;
}

/// What corpus.inspect did not come to find in a clip.
Scores parts_of(const Recording& recording) {
  return {{{"transcript", recording.transcript.has_value()},
           {"words", recording.words.has_value()},
           {"phones", recording.phones.has_value()},
           {"landmarks", recording.landmarks.has_value()}}};
}

std::vector<ClipFindings> findings_of(const RunResult& result, const std::set<std::string>& annotated) {
  const auto by_id = [&](const char* output) {
    std::map<std::string, const Scores*> out;
    for (const auto& [id, v] : result.output(output).items) out[id] = &v.get<Scores>();
    return out;
  };
  const auto findings = by_id("findings"), phones = by_id("phones");
  std::vector<ClipFindings> out;
  for (const auto& [id, v] : result.output("recordings").items) {
    const auto& recording = v.get<Recording>();
    const auto found = findings.find(id), counted = phones.find(id);
    out.push_back({id, recording.split, found == findings.end() ? parts_of(recording) : *found->second,
                   counted == phones.end() ? Scores{} : *counted->second, recording.faults, annotated.contains(id)});
    for (const auto& failure : result.failures)
      if (failure.item == id) out.back().faults.push_back(failure.cause);
  }
  return out;
}

}  // namespace

Json corpus_report(const std::vector<ClipFindings>& clips) {
  Json report = {{"clips", Json::array()},
                 {"unread", Json::array()},
                 {"annotated", Json::array()},
                 {"splits", Json::object()},
                 {"phones", Json::object()}};
  const Usual usual = usual_of(clips);
  const Offset& offset = usual.offset;
  std::map<std::string, double> phones;
  double sound = 0, picture = 0;
  for (const char* part : parts) report["lacking"][part] = Json::array();
  for (const auto& clip : clips) {
    const auto lags = lags_of(clip);
    Json findings = Json::object();
    for (const auto& [name, v] : clip.findings.values)
      if (!name.starts_with("lag ")) findings[name] = v;
    report["clips"].push_back({{"id", clip.id},
                               {"split", clip.split},
                               {"findings", findings},
                               {"lag", lags.empty() ? Json() : Json(peak(lags).first)},
                               {"problems", problems_of(clip, usual)}});
    if (!clip.faults.empty()) report["unread"].push_back(clip.id);
    if (clip.annotated) report["annotated"].push_back(clip.id);
    report["splits"][clip.split] = report["splits"].value(clip.split, 0) + 1;
    for (const char* part : parts)
      if (!(value(clip.findings, part) > 0)) report["lacking"][part].push_back(clip.id);
    for (const auto& [phone, count] : clip.phones.values) phones[phone] += count;
    const auto seconds = [&](const char* name) {
      const double s = value(clip.findings, name);
      return std::isnan(s) ? 0 : s;
    };
    sound += seconds("sound_seconds");
    picture += seconds("picture_seconds");
  }
  report["sound_seconds"] = sound;
  report["picture_seconds"] = picture;
  report["fps"] = counts(census(clips, "fps"));
  report["sound_rate"] = counts(census(clips, "sound_rate"));
  report["missing_phones"] = Json::array();
  for (const auto& phone : phone_set(phones)) {
    if (!phones.contains(phone)) report["missing_phones"].push_back(phone);
    report["phones"][phone] = phones.contains(phone) ? phones[phone] : 0;
  }
  report["offset"] = nullptr;
  if (is_clear(offset)) {
    const auto [lag, r] = peak(offset.mean);
    const double frames = between_frames(offset.mean, lag);
    report["offset"] = {
        {"frames", frames}, {"milliseconds", 1000 * frames / usual.fps}, {"correlation", r}, {"clips", offset.clips}};
  }
  return report;
}

std::string report_text(const Json& report) {
  if (report["clips"].empty()) return "no clip could be read\n";
  std::vector<std::string> splits;
  for (const auto& [split, count] : report["splits"].items())
    splits.push_back(fmt::format("{} {}", count.get<int>(), split));
  std::string out = clip_table(report);
  out += fmt::format("\n{} clips ({}), {} of sound, {} of pictures\n", report["clips"].size(), fmt::join(splits, ", "),
                     duration(report["sound_seconds"]), duration(report["picture_seconds"]));
  out +=
      fmt::format("frames a second: {}; sound: {} Hz\n", census_text(report["fps"]), census_text(report["sound_rate"]));
  out += "sound against picture: " + offset_text(report["offset"]);
  out += "what clips have:\n" + lacking_text(report);
  out += fmt::format("phones: {} of {} occur", report["phones"].size() - report["missing_phones"].size(),
                     report["phones"].size());
  if (!report["missing_phones"].empty()) {
    std::vector<std::string> missing = report["missing_phones"];
    out += fmt::format("; missing: {}", fmt::join(missing, " "));
  }
  out += phone_text(report);
  std::string problems;
  for (const auto& clip : report["clips"])
    for (const auto& problem : clip["problems"])
      problems += fmt::format("  {}: {}\n", clip["id"].get<std::string>(), problem.get<std::string>());
  return out + (problems.empty() ? "nothing is wrong with any clip\n" : "look at:\n" + problems);
}

int check_corpus(const CorpusCommand& command, RunCommand run, const Registry& registry) {
  check_source(command.source);
  const auto annotated = annotated_clips(command.source);
  Diagnostics diagnostics;
  const auto graph = load_graph_text(command.source, graph_of(command.source).dump(), registry, diagnostics);
  if (!graph) throw std::logic_error(diagnostics.str());
  run.keep_going = true;
  const Outcome outcome = run_graph(*graph, run);
  if (!outcome.result) return outcome.code;
  const Json report = corpus_report(findings_of(*outcome.result, annotated));
  fmt::print("{}",
             command.json ? report.dump(1, ' ', false, Json::error_handler_t::replace) + "\n" : report_text(report));
  return report["clips"].empty() || !report["unread"].empty() ? failed : outcome.code;
}

int new_corpus(const CorpusCommand& command) {
  const fs::path folder = command.source;
  const fs::path file = command.output.empty() ? folder / "manifest.json" : fs::path(command.output);
  if (fs::exists(file) && !command.overwrite)
    throw std::invalid_argument(file.string() + ": is there already; --overwrite replaces it, -o names another");
  if (fs::absolute(file).lexically_normal().parent_path() != fs::absolute(folder / "").lexically_normal().parent_path())
    throw std::invalid_argument(file.string() + ": a manifest lies in the folder of its clips");
  NewManifest make{command.validation, command.test, {}};
  if (!command.rate.empty()) {
    make.rate = Rational::parse(command.rate);
    if (make.rate->num() <= 0)
      throw std::invalid_argument("--rate: frames per second must be above 0, got " + command.rate);
  }
  const auto made = make(folder);
  write_file(file, made.manifest.dump(1) + "\n");
  for (const auto& note : made.notes) fmt::print(stderr, "{}\n", note);
  fmt::print(stderr, "{} clips; talkgraph corpus check {} looks them over\n", made.manifest["clips"].size(),
             file.string());
  fmt::print("{}\n", file.string());
  return success;
}

}  // namespace talkgraph::cli
