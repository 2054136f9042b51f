#include "study/story.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <tuple>

#include "nodes/statistics/intervals.h"
#include "study/tables.h"

namespace talkgraph::study {
namespace {

using Kind = Comparison::Kind;
constexpr std::size_t most_named = 4;

std::string people_text(std::size_t n) { return n == 1 ? "1 person" : fmt::format("{} people", n); }

/// Lines are not broken between the number and its unit.
std::string share_text(double share) { return fmt::format("{:.0f}\u00a0%", 100 * share); }

std::string what_is_said(const Measure& measure, bool synthetic) {
  const std::string clips = synthetic ? "synthetic clips" : "real clips";
  switch (measure.test->kind) {
    case TestKind::turing:
      return fmt::format("of {} were taken for real", clips);
    case TestKind::intelligibility:
      return fmt::format("of sentences were read right off {}", clips);
    default:
      return fmt::format("mean {} of {}, of {:.0f}", plain_name(measure.question->id), clips, measure.most());
  }
}

/// "naturalness of LIPS, static eyes (3.10 against 3.63, p < 0.01)"
std::string named(const Comparison& c, const Measure& measure) {
  const std::string of = measure.is_share() ? c.of : plain_name(measure.question->id) + " of " + c.of;
  return fmt::format("{} ({} against {}, {})", of, score_text(mean_of(values_of(c.first)), measure),
                     score_text(mean_of(values_of(c.second)), measure), p_text(c.p_corrected));
}

std::string sides_of(const Comparison& c) {
  switch (c.kind) {
    case Kind::clips:
      return "Real and synthetic clips";
    case Kind::clips_in_groups:
      return "Within a group of people, real and synthetic clips";
    case Kind::eyes:
      return "Recorded and static eyes";
    case Kind::plays:
      return "Clips seen once and replayed ones";
    default:
      return fmt::format("People of “{}” and “{}”", c.first_name, c.second_name);
  }
}

/// What tests of one kind in one test of the study say.
std::string verdict(const Findings& findings, std::vector<const Comparison*> of) {
  std::erase_if(of, [](const Comparison* c) { return std::isnan(c->p_corrected); });
  if (of.empty()) return "";
  std::stable_sort(of.begin(), of.end(),
                   [](const Comparison* a, const Comparison* b) { return a->p_corrected < b->p_corrected; });
  const auto differ = static_cast<std::size_t>(
      std::count_if(of.begin(), of.end(), [&](const Comparison* c) { return findings.differs(*c); }));
  const std::string sides = sides_of(*of.front());
  const std::string comparisons = of.size() == 1 ? "one comparison" : fmt::format("{} comparisons", of.size());
  if (differ == 0)
    return fmt::format("{}: no difference was found in {} (corrected {}).", sides, comparisons,
                       p_text(of.front()->p_corrected));
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(differ, most_named); ++i)
    names.push_back(named(*of[i], findings.measures[of[i]->measure]));
  const std::string more = differ > most_named ? fmt::format("; and {} more", differ - most_named) : "";
  const std::string of_them = of.size() == 1 ? "" : fmt::format("{} of ", differ);
  return fmt::format("{} differ in {}{}: {}{}.", sides, of_them, comparisons, fmt::join(names, "; "), more);
}

/// The last row of confusions: all clips.
struct Confused {
  double share, low, high, answers;

  std::string text() const {
    return fmt::format("{} of answers ({:.0f} to {:.0f}\u00a0%)", share_text(share), 100 * low, 100 * high);
  }
};

Confused confused(const Measure& measure, double confidence, bool synthetic) {
  const auto cells = confusions(measure, confidence).cells.back();
  const std::size_t at = synthetic ? 0 : 4;
  return {cells[at], cells[at + 1], cells[at + 2], cells[at + 3]};
}

std::string confusion_text(const Measure& measure, double confidence) {
  const Confused synthetic = confused(measure, confidence, true), real = confused(measure, confidence, false);
  std::vector<std::string> parts;
  if (synthetic.answers > 0) parts.push_back("synthetic clips were taken for real in " + synthetic.text());
  if (real.answers > 0) parts.push_back("real clips were taken for synthetic in " + real.text());
  return capital(fmt::format("{}.", fmt::join(parts, ", ")));
}

/// Of synthetic or of real clips: the share of answers that took them for real, or the mean of people's mean scores.
/// NaN where there are none.
double score_of(const Findings& findings, const Measure& measure, bool synthetic) {
  if (measure.test->kind == TestKind::turing) {
    const double share = confused(measure, findings.options.confidence, synthetic).share;
    return synthetic ? share : 1 - share;
  }
  std::vector<Score> scores;
  for (const auto& s : measure.scores)
    if (s.clip->synthetic == synthetic) scores.push_back(s);
  return mean_of(values_of(means_of(scores)));
}

/// Says which side of a comparison no clip of the study is on.
std::string missing_side(const Test& test) {
  const auto synthetic = [](const Clip& c) { return c.synthetic; };
  if (std::all_of(test.clips.begin(), test.clips.end(), synthetic))
    return "All its clips are synthetic: there are no real ones to compare them with.";
  if (std::none_of(test.clips.begin(), test.clips.end(), synthetic))
    return "All its clips are real: there are no synthetic ones to compare them with.";
  return "";
}

std::vector<std::string> story_of(const Findings& findings, const Test& test) {
  std::vector<std::string> sentences;
  std::map<std::tuple<Kind, std::string, std::string>, std::vector<const Comparison*>> kinds;
  bool answered = false;
  for (std::size_t m = 0; m < findings.measures.size(); ++m) {
    const Measure& measure = findings.measures[m];
    if (measure.test != &test || measure.scores.empty()) continue;
    answered = true;
    if (test.kind == TestKind::turing) sentences.push_back(confusion_text(measure, findings.options.confidence));
    for (const auto& c : findings.comparisons)
      if (c.measure == m) kinds[{c.kind, c.first_name, c.second_name}].push_back(&c);
  }
  if (!answered) return {"It was not answered yet."};
  sentences.push_back(missing_side(test));
  const auto before = sentences.size();
  for (const auto& [sides, comparisons] : kinds) {
    sentences.push_back(verdict(findings, comparisons));
    if (std::get<Kind>(sides) == Kind::eyes && sentences.back() != "")
      sentences.push_back("Static eyes do not blink, and may be half shut, being those of the mean face.");
  }
  if (std::all_of(sentences.begin() + static_cast<std::ptrdiff_t>(before), sentences.end(),
                  [](const std::string& s) { return s.empty(); }))
    sentences.emplace_back("There are too few answers to test anything.");
  std::erase(sentences, "");
  return sentences;
}

std::string date_text(std::int64_t seconds) {
  const std::tm day = fmt::gmtime(static_cast<std::time_t>(seconds));
  return fmt::format("{} {:%B %Y}", day.tm_mday, day);
}

}  // namespace

std::string score_text(double score, const Measure& measure) {
  if (std::isnan(score)) return "–";
  return measure.is_share() ? share_text(score) : fmt::format("{:.2f}", score);
}

std::string measure_text(const Measure& measure) {
  switch (measure.test->kind) {
    case TestKind::turing:
      return "taken for real";
    case TestKind::intelligibility:
      return "read right";
    default:
      return plain_name(measure.question->id);
  }
}

std::string capital(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string p_text(double p) {
  if (std::isnan(p)) return "–";
  for (const double level : {0.001, 0.01, 0.05})
    if (p < level) return fmt::format("p\u00a0<\u00a0{}", level);
  return fmt::format("p\u00a0>\u00a0{:.2f}", (std::ceil(100 * p - 1e-9) - 1) / 100);
}

std::vector<Headline> headlines(const Findings& findings) {
  std::vector<Headline> all;
  for (const auto& measure : findings.measures) {
    if (measure.scores.empty()) continue;
    const double real = score_of(findings, measure, false), synthetic = score_of(findings, measure, true);
    const bool of_synthetic = !std::isnan(synthetic);
    std::vector<std::string> beside;
    if (of_synthetic && !std::isnan(real)) beside.push_back("real clips: " + score_text(real, measure));
    if (!std::isnan(measure.chance())) beside.push_back("chance: " + score_text(measure.chance(), measure));
    all.push_back({score_text(of_synthetic ? synthetic : real, measure), what_is_said(measure, of_synthetic),
                   fmt::format("{}", fmt::join(beside, ", "))});
  }
  return all;
}

std::vector<Chapter> story(const Findings& findings) {
  std::vector<Chapter> chapters;
  for (const auto& test : findings.study->tests) chapters.push_back({test.title, story_of(findings, test)});
  return chapters;
}

std::string about_people(const Findings& findings, const Answers& answers) {
  if (findings.took_part == 0) return "Nobody has taken part yet.";
  std::string text = people_text(findings.took_part) + " took part";
  std::int64_t first = 0, last = 0;
  for (const auto& a : answers.answers) {
    if (a.given <= 0) continue;
    first = first == 0 ? a.given : std::min(first, a.given), last = std::max(last, a.given);
  }
  if (first > 0) {
    const std::string from = date_text(first), to = date_text(last);
    text += from == to ? " on " + from : fmt::format(" from {} to {}", from, to);
  }
  text += fmt::format("; {} finished. ", findings.finished);
  std::size_t given = 0;
  for (const auto& measure : findings.measures) given += measure.scores.size();
  text += findings.options.finished_only
              ? fmt::format("Only the answers of those count here: {}.", given)
              : fmt::format("The answers of {} count here, {} in all, however far each came.",
                            people_text(findings.people.size()), given);
  return text;
}

}  // namespace talkgraph::study
