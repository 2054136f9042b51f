#include "nodes/plot/contexts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "nodes/plot/marks.h"

namespace talkgraph {
namespace {

constexpr std::size_t kCircle = 16;  ///< most memories whose automaton is drawn
constexpr double kMargin = 16, kTop = 60, kRow = 19, kIndent = 18, kCharacter = 6.6, kFollowers = 330;
constexpr int kListed = 5;  ///< symbols that may follow, in text

using Memory = std::vector<std::int64_t>;

/// The states to draw, each below its suffix: those in whose memories, longer ones included, most frames were read.
std::vector<std::size_t> chosen(const Vlmm& vlmm, std::size_t most) {
  const std::size_t n = vlmm.states.size();
  std::map<Memory, std::size_t> places;
  for (std::size_t s = 0; s < n; ++s) places[vlmm.states[s].memory] = s;
  std::vector<std::int64_t> frames(n);
  for (std::size_t s = 0; s < n; ++s)
    for (Memory suffix = vlmm.states[s].memory;; suffix.erase(suffix.begin())) {
      if (const auto found = places.find(suffix); found != places.end()) frames[found->second] += frames_read(vlmm, s);
      if (suffix.empty()) break;
    }
  std::vector<std::size_t> all(n);
  std::iota(all.begin(), all.end(), 0);
  std::sort(all.begin(), all.end(), [&](std::size_t a, std::size_t b) {
    const auto rank = [&](std::size_t s) { return std::tuple(-frames[s], vlmm.states[s].memory.size(), s); };
    return rank(a) < rank(b);
  });
  all.resize(std::min(n, most));
  std::sort(all.begin(), all.end(), [&](std::size_t a, std::size_t b) {
    const Memory &left = vlmm.states[a].memory, &right = vlmm.states[b].memory;
    return std::lexicographical_compare(left.rbegin(), left.rend(), right.rbegin(), right.rend());
  });
  return all;
}

std::string name_of(const Vlmm& vlmm, std::size_t state) {
  const std::string label = memory_label(vlmm, vlmm.states[state].memory);
  return label.empty() ? "none" : label;
}

std::string followers(const Vlmm& vlmm, std::size_t state) {
  const auto& p = vlmm.states[state].probability;
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] > p[b]; });
  const auto possible = std::count_if(p.begin(), p.end(), [](double x) { return x > 0; });
  std::string text;
  for (std::ptrdiff_t i = 0; i < std::min<std::ptrdiff_t>(possible, kListed); ++i)
    text += fmt::format("{}{} {:.2f}", i ? ", " : "", vlmm.alphabet[order[static_cast<std::size_t>(i)]],
                        p[order[static_cast<std::size_t>(i)]]);
  return possible > kListed ? text + fmt::format(", {} more", possible - kListed) : text;
}

std::string draw_tree(const Vlmm& vlmm, const std::vector<std::size_t>& states, double frames_at) {
  std::string out = svg_text(0, -12, "start", "memory", " font-weight=\"bold\"") +
                    svg_text(frames_at, -12, "end", "frames", " font-weight=\"bold\"") +
                    svg_text(frames_at + 16, -12, "start", "what follows", " font-weight=\"bold\"");
  std::vector<double> line = {0};  // of the memory above, by its length
  for (std::size_t i = 0; i < states.size(); ++i) {
    const auto length = vlmm.states[states[i]].memory.size();
    const double x = kIndent * static_cast<double>(length), y = kRow * (static_cast<double>(i) + 0.5);
    line.resize(length + 1, line.back());
    line[length] = y;
    if (length > 0)
      out += svg_line(
          fmt::format("M{:.1f} {:.1f}V{:.1f}h{:.1f}", x - kIndent + 6, line[length - 1] + 7, y, kIndent - 9), "#bbb");
    out += svg_text(x, y + 4, "start", name_of(vlmm, states[i]));
    out += svg_text(frames_at, y + 4, "end", std::to_string(frames_read(vlmm, states[i])), " fill=\"#666\"");
    out += svg_text(frames_at + 16, y + 4, "start", followers(vlmm, states[i]), " fill=\"#666\"");
  }
  return out;
}

struct Point {
  double x, y;
};
Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y}; }
Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
Point operator*(double k, Point a) { return {k * a.x, k * a.y}; }
Point unit(Point a) { return 1 / std::max(std::hypot(a.x, a.y), 1e-9) * a; }

/// A curve with a head, and the text on its first third, where fewest of them meet.
std::string draw_arrow(Point from, Point by, Point by_2, Point to, const std::string& text) {
  const Point back = 7 * unit(by_2 - to), side{-0.5 * back.y, 0.5 * back.x};
  const Point third = 1. / 27 * (8 * from + 12 * by + 6 * by_2 + to);
  const Point left = to + back + side, right = to + back - side;
  return svg_line(fmt::format("M{:.1f} {:.1f}C{:.1f} {:.1f} {:.1f} {:.1f} {:.1f} {:.1f}", from.x, from.y, by.x, by.y,
                              by_2.x, by_2.y, to.x, to.y),
                  "#888") +
         fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}Z\" fill=\"#888\"/>\n", to.x, to.y, left.x,
                     left.y, right.x, right.y) +
         svg_text(third.x, third.y + 4, "middle", text,
                  " font-size=\"10\" stroke=\"#fff\" stroke-width=\"4\" paint-order=\"stroke\"");
}

/// Memories on a circle around (0, 0).
class Circle {
 public:
  Circle(const Vlmm& vlmm, const std::vector<std::size_t>& states, double radius) : vlmm_(vlmm), states_(states) {
    for (std::size_t i = 0; i < states.size(); ++i) {
      const double angle = 2 * std::numbers::pi * (static_cast<double>(i) / static_cast<double>(states.size()) - 0.25);
      places_[states[i]] = {radius * std::cos(angle), radius * std::sin(angle)};
    }
  }
  std::string draw(double least) const {
    std::string out;
    for (const auto from : states_)
      for (const auto& [to, text] : transitions(from, least)) out += arrow(from, to, text);
    for (const auto& [state, at] : places_) {
      const double w = width(state);
      out += fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"22\" rx=\"11\" fill=\"#fff\" "
          "stroke=\"#0072b2\"/>\n",
          at.x - w / 2, at.y - 11, w);
      out += svg_text(at.x, at.y + 4, "middle", name_of(vlmm_, state));
    }
    return out;
  }

 private:
  double width(std::size_t state) const { return 18 + kCharacter * static_cast<double>(name_of(vlmm_, state).size()); }
  /// What leads from a memory to each other drawn one.
  std::map<std::size_t, std::string> transitions(std::size_t from, double least) const {
    const auto& state = vlmm_.states[from];
    std::map<std::size_t, std::string> texts;
    for (std::size_t s = 0; s < vlmm_.alphabet.size(); ++s) {
      const auto to = static_cast<std::size_t>(std::max<std::int64_t>(state.next[s], 0));
      if (state.next[s] < 0 || state.probability[s] < least || !places_.contains(to)) continue;
      auto& text = texts[to];
      text += fmt::format("{}{} {:.2f}", text.empty() ? "" : ", ", vlmm_.alphabet[s], state.probability[s]);
    }
    return texts;
  }
  /// Where a line from a memory's middle towards a point leaves its box.
  Point edge(std::size_t state, Point towards) const {
    const Point at = places_.at(state), d = towards - at;
    const double reach = std::max({std::abs(d.x) / (width(state) / 2 + 2), std::abs(d.y) / 13, 1e-9});
    return at + 1 / reach * d;
  }
  std::string arrow(std::size_t from, std::size_t to, const std::string& text) const {
    const Point a = places_.at(from), b = places_.at(to);
    if (from == to) {
      const Point out = 60 * unit(a), side{-0.6 * out.y, 0.6 * out.x};
      return draw_arrow(edge(from, a + out + side), a + out + side, a + out - side, edge(from, a + out - side), text);
    }
    const Point across = b - a, bend{-0.18 * across.y, 0.18 * across.x};
    const Point by = a + 0.33 * across + bend, by_2 = a + 0.67 * across + bend;
    return draw_arrow(edge(from, by), by, by_2, edge(to, by_2), text);
  }

  const Vlmm& vlmm_;
  const std::vector<std::size_t>& states_;
  std::map<std::size_t, Point> places_;
};

}  // namespace

Plot PlotContexts::operator()(const Vlmm& vlmm) const {
  const auto states = chosen(vlmm, static_cast<std::size_t>(most));
  double names = 0;
  for (const auto s : states)
    names = std::max(names, kIndent * static_cast<double>(vlmm.states[s].memory.size()) +
                                kCharacter * static_cast<double>(name_of(vlmm, s).size()));
  const double frames_at = names + 64, tree = kMargin + frames_at + kFollowers;
  const bool round = vlmm.states.size() <= kCircle;
  const double radius = 50 + 16 * static_cast<double>(states.size()), reach = round ? radius + 110 : 0;
  const double height = std::max(kTop + kRow * static_cast<double>(states.size()) + kMargin, 2 * reach + kTop);

  const auto all = vlmm.states.size();
  const std::string shown =
      states.size() < all ? fmt::format("{} of {} memories", states.size(), all) : fmt::format("{} memories", all);
  std::string out = svg_open(title, tree + 2 * reach, height);
  out += svg_text(kMargin, 22, "start", title + ": " + shown, " font-weight=\"bold\"");
  out += svg_group(kMargin, kTop, draw_tree(vlmm, states, frames_at));
  if (round) out += svg_group(tree + reach, kTop + reach, Circle(vlmm, states, radius).draw(least));
  return {title, out + "</svg>\n"};
}

void describe(Description<PlotContexts>& d) {
  d.type("plot.contexts").summary("memories of contexts as a tree, and of few the automaton");
  d.source("Thesis Figures 5.3 and 5.4");
  d.input("vlmm", "the contexts").output("plot", "the tree; of at most 16 memories the automaton beside it");
  d.param("most", &PlotContexts::most).at_least(1).doc("memories drawn, those with most frames first");
  d.param("least", &PlotContexts::least).within(0, 1).doc("probability of a transition that gets an arrow");
  d.param("title", &PlotContexts::title).doc("heading");
}

}  // namespace talkgraph
