#include "nodes/corpus/labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "nodes/corpus/text.h"
#include "nodes/phones/label_files.h"
#include "nodes/types/visemes.h"

namespace talkgraph {
namespace {

bool is_pause(const std::string& label) {
  static const std::vector<std::string> pauses = {"", "sil", "sp", "pau", "spn", "#", "##", "h#", "<p:>", "<sil>", "_"};
  return std::find(pauses.begin(), pauses.end(), label) != pauses.end();
}

/// The tier of that name ("words", or "speaker - words" as aligners write it).
const LabelTier& find_tier(const std::vector<LabelTier>& tiers, const std::string& wanted, const std::string& path) {
  std::string names;
  for (const auto& tier : tiers) {
    const std::string name = lower_case(tier.name);
    if (name == wanted || name.ends_with(" " + wanted)) return tier;
    names += (names.empty() ? "\"" : ", \"") + tier.name + "\"";
  }
  if (tiers.size() == 1) return tiers[0];
  throw std::runtime_error(fmt::format("{}: has no interval tier \"{}\"; it has {}", path, wanted,
                                       names.empty() ? "no interval tier at all" : names));
}

}  // namespace

std::string normalised_phone(const std::string& label) {
  std::string phone = lower_case(label);
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!phone.empty() && blank(phone.back())) phone.pop_back();
  phone.erase(phone.begin(), std::find_if_not(phone.begin(), phone.end(), blank));
  if (is_pause(phone)) return "sil";
  if (phone.size() > 1 && phone.back() >= '0' && phone.back() <= '2') phone.pop_back();
  return phone;
}

std::vector<Interval> parse_grid_align(const std::string& text, const std::string& name) {
  std::vector<Interval> intervals;
  for (const auto& line : lines_of(text)) {
    const auto words = words_of(line.text);
    if (words.size() != 3)
      complain(name, line.number, fmt::format("\"start end word\" is expected, got \"{}\"", line.text));
    const double start = number_in(words[0], name, line.number) / 25000;
    const double end = number_in(words[1], name, line.number) / 25000;
    if (end < start) complain(name, line.number, "the interval ends before it starts");
    if (start < (intervals.empty() ? 0 : intervals.back().end))
      complain(name, line.number, "the interval starts before the one above ends");
    intervals.push_back({words[2], start, end});
  }
  return intervals;
}

std::vector<Interval> read_intervals(const std::string& path, const std::string& tier) {
  const std::string ending = lower_case(std::filesystem::path(path).extension().string());
  const std::string text = read_text_file(path);
  if (ending == ".lab") return parse_htk_labels(text, path);
  if (ending == ".align") return parse_grid_align(text, path);
  if (ending == ".textgrid") return find_tier(parse_text_grid(text, path), tier, path).intervals;
  throw std::runtime_error(path + ": labels are read from .lab, .TextGrid and .align files");
}

PhoneTrack read_phones(const std::string& path) {
  PhoneTrack track;
  const auto add = [&](const std::string& label, double start, double end) {
    auto& phones = track.phones;
    if (label == "sil" && !phones.empty() && phones.back().label == "sil")
      phones.back().end = end;
    else if (end > start)
      phones.push_back({label, start, end});
  };
  for (const auto& interval : read_intervals(path, "phones")) {
    const double at = track.phones.empty() ? 0 : track.phones.back().end;
    if (interval.start > at) add("sil", at, interval.start);
    const std::string phone = normalised_phone(interval.label);
    if (!is_phone(phone))
      throw std::runtime_error(
          fmt::format("{}: \"{}\" at {:.3f} s is no CMU or BEEP phone", path, interval.label, interval.start));
    add(phone, interval.start, interval.end);
  }
  if (track.phones.empty()) throw std::runtime_error(path + ": holds no labels");
  return track;
}

WordTrack read_words(const std::string& path) {
  WordTrack track;
  for (const auto& interval : read_intervals(path, "words")) {
    const std::string word = lower_case(interval.label);
    track.words.push_back({is_pause(word) ? "sil" : word, interval.start, interval.end});
  }
  if (track.words.empty()) throw std::runtime_error(path + ": holds no labels");
  return track;
}

Transcript transcript_of(const WordTrack& words) {
  Transcript transcript;
  for (const auto& word : words.words) {
    if (word.label == "sil") continue;
    if (!transcript.text.empty()) transcript.text += ' ';
    transcript.text += word.label;
  }
  return transcript;
}

}  // namespace talkgraph
