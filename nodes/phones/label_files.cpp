#include "nodes/phones/label_files.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace talkgraph {
namespace {

[[noreturn]] void complain(const std::string& name, int line, const std::string& what) {
  throw std::runtime_error(fmt::format("{}:{}: {}", name, line, what));
}

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

void append(std::vector<Interval>& intervals, Interval next, const std::string& name, int line) {
  if (next.end < next.start) complain(name, line, "the interval ends before it starts");
  if (!intervals.empty() && next.start < intervals.back().end - 1e-6)
    complain(name, line, "the interval starts before the one above ends");
  intervals.push_back(std::move(next));
}

std::string quoted(const std::string& label) {
  std::string text = "\"";
  for (const char c : label) text += c == '"' ? "\"\"" : std::string(1, c);
  return text + '"';
}

/// The inverse, of a text in quotes.
std::string unquoted(std::string_view text) {
  std::string label;
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    label += text[i];
    if (text[i] == '"' && text[i + 1] == '"') ++i;
  }
  return label;
}

/// Intervals with the gaps filled by empty ones, from 0 to `end`.
std::vector<Interval> without_gaps(const std::vector<Interval>& intervals, double end) {
  std::vector<Interval> whole;
  double at = 0;
  for (const auto& interval : intervals) {
    if (interval.start > at) whole.push_back({"", at, interval.start});
    whole.push_back(interval);
    at = interval.end;
  }
  if (end > at || whole.empty()) whole.push_back({"", at, end});
  return whole;
}

/// The numbers, quoted texts and <flags> of a TextGrid; the words between them
/// ("xmin =", "intervals [3]:") only help human readers.
class TextGridTokens {
 public:
  TextGridTokens(std::string_view text, const std::string& name) : text_(text), name_(name) {
    if (text_.starts_with("\xef\xbb\xbf")) text_.remove_prefix(3);
  }

  int line() const { return line_; }

  std::string text() {
    skip();
    if (text_.empty() || text_[0] != '"') complain(name_, line_, "a text in quotes is expected");
    std::string value;
    for (std::size_t i = 1; i < text_.size(); ++i) {
      if (text_[i] == '\n') ++line_;
      if (text_[i] != '"') {
        value += text_[i];
      } else if (i + 1 < text_.size() && text_[i + 1] == '"') {
        value += text_[++i];
      } else {
        text_.remove_prefix(i + 1);
        return value;
      }
    }
    complain(name_, line_, "the file ends inside a text");
  }

  double real() {
    skip();
    const auto value = number(word());
    if (!value) complain(name_, line_, "a number is expected");
    return *value;
  }

  void flag() {
    skip();
    if (word() != "<exists>") complain(name_, line_, "<exists> is expected: the TextGrid has no tiers");
  }

 private:
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

  std::string_view word() {
    std::size_t end = 0;
    while (end < text_.size() && !is_space(text_[end])) ++end;
    const std::string_view value = text_.substr(0, end);
    text_.remove_prefix(end);
    return value;
  }

  void skip() {
    while (!text_.empty()) {
      const char c = text_[0];
      if (c == '"' || c == '<' || c == '-' || (c >= '0' && c <= '9')) return;
      if (is_space(c)) {
        line_ += c == '\n';
        text_.remove_prefix(1);
      } else {
        word();
      }
    }
  }

  std::string_view text_;
  const std::string& name_;
  int line_ = 1;
};

LabelTier interval_tier(TextGridTokens& tokens, const std::string& name) {
  LabelTier tier{tokens.text(), {}};
  tokens.real();
  tokens.real();
  const double count = tokens.real();
  for (int i = 0; i < count; ++i) {
    const double start = tokens.real();
    const double end = tokens.real();
    std::string label = tokens.text();
    append(tier.intervals, {label.empty() ? "sil" : std::move(label), start, end}, name, tokens.line());
  }
  return tier;
}

void skip_point_tier(TextGridTokens& tokens) {
  tokens.text();
  tokens.real();
  tokens.real();
  const double count = tokens.real();
  for (int i = 0; i < count; ++i) {
    tokens.real();
    tokens.text();
  }
}

}  // namespace

std::string htk_labels(const std::vector<Interval>& intervals) {
  std::string text;
  for (const auto& i : intervals)
    text += fmt::format("{} {} {}\n", std::llround(i.start * 1e7), std::llround(i.end * 1e7), i.label);
  return text;
}

std::string csv_labels(const std::vector<Interval>& intervals) {
  std::string text = "start,end,label\n";
  for (const auto& i : intervals) {
    const bool plain = i.label.find_first_of(",\"") == std::string::npos;
    text += fmt::format("{:.9g},{:.9g},{}\n", i.start, i.end, plain ? i.label : quoted(i.label));
  }
  return text;
}

std::string text_grid(const std::vector<LabelTier>& tiers) {
  double end = 0;
  for (const auto& tier : tiers)
    if (!tier.intervals.empty()) end = std::max(end, tier.intervals.back().end);
  std::string text = fmt::format(
      "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n\nxmin = 0\nxmax = {:.9g}\ntiers? <exists>\nsize = {}\n"
      "item []:\n",
      end, tiers.size());
  for (std::size_t t = 0; t < tiers.size(); ++t) {
    const auto intervals = without_gaps(tiers[t].intervals, end);
    text += fmt::format(
        "    item [{}]:\n        class = \"IntervalTier\"\n        name = {}\n        xmin = 0\n        xmax = {:.9g}\n"
        "        intervals: size = {}\n",
        t + 1, quoted(tiers[t].name), end, intervals.size());
    for (std::size_t i = 0; i < intervals.size(); ++i)
      text += fmt::format(
          "        intervals [{}]:\n            xmin = {:.9g}\n            xmax = {:.9g}\n            text = {}\n",
          i + 1, intervals[i].start, intervals[i].end, quoted(intervals[i].label));
  }
  return text;
}

std::vector<Interval> parse_htk_labels(std::string_view text, const std::string& name) {
  std::vector<Interval> intervals;
  std::istringstream lines{std::string(text)};
  std::string line;
  for (int n = 1; std::getline(lines, line); ++n) {
    std::istringstream words(line);
    std::string start, end, label;
    if (!(words >> start) || start == "#!MLF!#" || start[0] == '"' || start == ".") continue;
    words >> end >> label;
    const auto from = number(start), to = number(end);
    if (!from || !to || label.empty()) complain(name, n, "\"start end label\" is expected, times in 100 ns");
    append(intervals, {label, *from * 1e-7, *to * 1e-7}, name, n);
  }
  return intervals;
}

std::vector<Interval> parse_csv_labels(std::string_view text, const std::string& name) {
  std::vector<Interval> intervals;
  std::istringstream lines{std::string(text)};
  std::string line;
  for (int n = 1; std::getline(lines, line); ++n) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || (n == 1 && line == "start,end,label")) continue;
    std::istringstream cells(line);
    std::string start, end, label;
    std::getline(cells, start, ',');
    std::getline(cells, end, ',');
    std::getline(cells, label);
    if (label.size() > 1 && label.front() == '"' && label.back() == '"') label = unquoted(label);
    const auto from = number(start), to = number(end);
    if (!from || !to || label.empty()) complain(name, n, "\"start,end,label\" is expected, times in seconds");
    append(intervals, {label, *from, *to}, name, n);
  }
  return intervals;
}

std::vector<LabelTier> parse_text_grid(std::string_view text, const std::string& name) {
  if (text.starts_with("\xfe\xff") || text.starts_with("\xff\xfe"))
    complain(name, 1, "the TextGrid is in UTF-16; save it as UTF-8 (Praat: Text writing preferences)");
  if (text.starts_with("ooBinaryFile"))
    complain(name, 1, "the TextGrid is in Praat's binary format; save it as a text file (Praat: Save as text file)");
  TextGridTokens tokens(text, name);
  if (tokens.text() != "ooTextFile" || tokens.text() != "TextGrid") complain(name, 1, "this is not a Praat TextGrid");
  tokens.real();
  tokens.real();
  tokens.flag();
  const double count = tokens.real();
  std::vector<LabelTier> tiers;
  for (int t = 0; t < count; ++t) {
    const std::string kind = tokens.text();
    if (kind == "IntervalTier")
      tiers.push_back(interval_tier(tokens, name));
    else if (kind == "TextTier")
      skip_point_tier(tokens);
    else
      complain(name, tokens.line(), "unknown kind of tier \"" + kind + "\"");
  }
  return tiers;
}

}  // namespace talkgraph
