#include "nodes/phones/mouth_shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

namespace talkgraph {
namespace {

constexpr std::string_view kAny = "ABCDEFGHX";
constexpr std::string_view kOpen = "BCDEFGH";

enum class Timing { steady, diphthong, stop };

/// The shapes that a phone allows; `brief` instead of `first` where the phone
/// is shorter than `brief_below` centiseconds.
struct Rule {
  std::string_view first;
  Timing timing = Timing::steady;
  std::string_view second = "";
  int brief_below = 0;
  std::string_view brief = "";
};

const std::map<std::string_view, Rule> kRules = {
    {"iy", {"B"}},
    {"ih", {"B"}},
    {"eh", {"C"}},
    {"ae", {"C"}},
    {"aa", {"D"}},
    {"ao", {"E"}},
    {"oh", {"E"}},
    {"uh", {"F"}},
    {"uw", {"F"}},
    {"ax", {"BC"}},
    {"ah", {"D", Timing::steady, "", 20, "C"}},
    {"er", {"E", Timing::steady, "", 7, "BC"}},
    {"ey", {"C", Timing::diphthong, "B"}},
    {"ay", {"D", Timing::diphthong, "B", 20, "C"}},
    {"ow", {"E", Timing::diphthong, "F"}},
    {"aw", {"D", Timing::diphthong, "E", 30, "C"}},
    {"oy", {"E", Timing::diphthong, "B"}},
    {"ea", {"C", Timing::diphthong, "BC"}},
    {"ia", {"B", Timing::diphthong, "BC"}},
    {"ua", {"F", Timing::diphthong, "BC"}},
    {"p", {"A", Timing::stop, kAny}},
    {"b", {"A", Timing::stop, kAny}},
    {"t", {"BF", Timing::stop, kOpen}},
    {"d", {"BF", Timing::stop, kOpen}},
    {"k", {"BCEFH", Timing::stop, kOpen}},
    {"g", {"BCEFH", Timing::stop, kOpen}},
    {"ch", {"BF"}},
    {"jh", {"BF"}},
    {"f", {"G"}},
    {"v", {"G"}},
    {"th", {"BF"}},
    {"dh", {"BF"}},
    {"s", {"BF"}},
    {"z", {"BF"}},
    {"sh", {"BF"}},
    {"zh", {"BF"}},
    {"hh", {kAny}},
    {"m", {"A"}},
    {"n", {"BCFH"}},
    {"ng", {"BCEF"}},
    {"l", {"H", Timing::steady, "", 20, "BEFH"}},
    {"r", {"BEF"}},
    {"y", {"BCF"}},
    {"w", {"F"}},
    {"breath", {"C"}},
};

struct Geometry {
  double opening;
  double rounding;
};

Geometry geometry(char shape) {
  switch (shape) {
    case 'B':
      return {0.25, 0};
    case 'C':
      return {0.55, 0};
    case 'D':
      return {1, 0};
    case 'E':
      return {0.6, 0.6};
    case 'F':
      return {0.3, 1};
    case 'G':
      return {0.15, 0};
    case 'H':
      return {0.55, 0.1};
    default:
      return {0, 0};
  }
}

char nearest(char shape, std::string_view allowed) {
  if (allowed.find(shape) != std::string_view::npos) return shape;
  const Geometry from = geometry(shape);
  const auto distance = [&](char c) {
    const Geometry to = geometry(c);
    return std::hypot(to.opening - from.opening, to.rounding - from.rounding);
  };
  return *std::min_element(allowed.begin(), allowed.end(), [&](char a, char b) { return distance(a) < distance(b); });
}

/// From `start` (centiseconds) on one of the allowed shapes is shown.
struct Cue {
  int start;
  std::string_view allowed;
};

void add(std::vector<Cue>& cues, int start, std::string_view allowed) {
  start = std::max(start, 0);
  while (!cues.empty() && cues.back().start >= start) cues.pop_back();
  cues.push_back({start, allowed});
}

int centiseconds(double seconds) { return static_cast<int>(std::lround(seconds * 100)); }

std::vector<Cue> cues_of(const std::vector<Interval>& phones) {
  constexpr int kLongPause = 25;
  std::vector<Cue> cues;
  int previous = 0;
  for (std::size_t i = 0; i < phones.size(); ++i) {
    const int start = centiseconds(phones[i].start);
    const int length = centiseconds(phones[i].end) - start;
    if (phones[i].label == "sil") {
      const bool idle = i == 0 || i + 1 == phones.size() || length >= kLongPause;
      add(cues, start, idle ? "X" : "B");
      previous = length;
      continue;
    }
    const auto found = kRules.find(phones[i].label);
    if (found == kRules.end())
      throw std::runtime_error("\"" + phones[i].label +
                               "\" is neither a CMU nor a BEEP phone, so it has no mouth shape");
    const Rule& rule = found->second;
    const std::string_view first = length < rule.brief_below ? rule.brief : rule.first;
    if (rule.timing == Timing::stop) {
      add(cues, start - std::clamp(previous / 2, 4, 12), first);
      add(cues, start, rule.second);
    } else {
      add(cues, start, first);
      if (rule.timing == Timing::diphthong && length >= 2) add(cues, start + length * 6 / 10, rule.second);
    }
    previous = length;
  }
  return cues;
}

}  // namespace

std::vector<Interval> mouth_shapes(const PhoneTrack& track) {
  constexpr int kShortest = 3;
  std::vector<Interval> shapes;
  if (track.phones.empty()) return shapes;
  const int end = centiseconds(track.phones.back().end);
  const std::vector<Cue> cues = cues_of(track.phones);
  char shape = 'X';
  for (std::size_t i = 0; i < cues.size(); ++i) {
    const int until = i + 1 < cues.size() ? cues[i + 1].start : end;
    if (until - cues[i].start < kShortest && !shapes.empty()) {
      shapes.back().end = until / 100.0;
      continue;
    }
    shape = nearest(shape, cues[i].allowed);
    if (!shapes.empty() && shapes.back().label[0] == shape)
      shapes.back().end = until / 100.0;
    else
      shapes.push_back({std::string(1, shape), shapes.empty() ? 0 : cues[i].start / 100.0, until / 100.0});
  }
  return shapes;
}

}  // namespace talkgraph
