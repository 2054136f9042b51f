#include "nodes/plot/dots.h"

#include <fmt/format.h>

#include <algorithm>

#include "nodes/plot/axis.h"
#include "nodes/plot/marks.h"

namespace talkgraph {
namespace {

constexpr double kTop = 28, kBottom = 42, kLegend = 28, kRow = 16, kGap = 12, kAxis = 220, kValue = 44, kRight = 20;
constexpr double kCharacter = 6.3;

const char* colour_of(std::size_t series) { return plot_colours[series % plot_colours.size()]; }

double length_of(const DotPanel::Row& row) { return kRow * static_cast<double>(row.dots.size()) + kGap; }

double height_of(const DotPanel& panel) {
  double height = kTop + kBottom;
  for (const auto& row : panel.rows) height += length_of(row);
  return height;
}

std::string draw_dot(const Dot& dot, const Axis& axis, double y, const char* colour, int decimals) {
  if (!std::isfinite(dot.value)) return svg_text(kAxis + kValue, y + 4, "end", "–");
  std::string out;
  if (std::isfinite(dot.low) && std::isfinite(dot.high))
    out += svg_line(fmt::format("M{0:.1f} {2:.1f}H{1:.1f}M{0:.1f} {3:.1f}v6M{1:.1f} {3:.1f}v6",
                                axis.share(dot.low) * kAxis, axis.share(dot.high) * kAxis, y, y - 3),
                    colour, 1.4);
  out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"/>\n", axis.share(dot.value) * kAxis, y,
                     colour);
  return out + svg_text(kAxis + kValue, y + 4, "end", fmt::format("{:.{}f}", dot.value, decimals),
                        fmt::format(" style=\"fill: {}\"", colour).c_str());
}

std::string draw_grid(const DotPanel& panel, const Axis& axis, double h) {
  std::string out = svg_text(kAxis / 2, -10, "middle", panel.title, " font-weight=\"bold\"");
  for (const double v : axis.ticks()) {
    out += svg_line(fmt::format("M{:.1f} 0v{:.1f}", axis.share(v) * kAxis, h), "#e4e4e4");
    out += svg_text(axis.share(v) * kAxis, h + 16, "middle", tick_text(axis, v));
  }
  if (std::isfinite(panel.reference))
    out += svg_line(fmt::format("M{:.1f} 0v{:.1f}", axis.share(panel.reference) * kAxis, h), "#666", 1,
                    " stroke-dasharray=\"4 3\"");
  return out + svg_text(kAxis / 2, h + 33, "middle", panel.x_label);
}

std::string draw_panel(const DotPanel& panel, bool named) {
  const Axis axis = axis_over(panel.from, panel.to, 5);
  std::string out = draw_grid(panel, axis, height_of(panel) - kTop - kBottom);
  double y = 0;
  for (const auto& row : panel.rows) {
    if (named) out += svg_text(-10, y + length_of(row) / 2 + 4, "end", row.name);
    for (std::size_t i = 0; i < row.dots.size(); ++i)
      out += draw_dot(row.dots[i], axis, y + (kGap + kRow) / 2 + kRow * static_cast<double>(i), colour_of(i),
                      panel.decimals);
    y += length_of(row);
  }
  return out;
}

std::string draw_legend(const std::vector<std::string>& series, double x) {
  std::string out;
  for (std::size_t i = 0; i < series.size(); ++i) {
    out += fmt::format("<circle cx=\"{:.1f}\" cy=\"14\" r=\"4\" fill=\"{}\"/>\n", x + 4, colour_of(i));
    out += svg_text(x + 14, 18, "start", series[i]);
    x += 34 + kCharacter * static_cast<double>(series[i].size());
  }
  return out;
}

}  // namespace

std::string draw_dots(const std::string& title, const std::vector<std::string>& series,
                      const std::vector<DotPanel>& panels, int columns) {
  const int n = static_cast<int>(panels.size());
  columns = std::clamp(columns, 1, std::max(n, 1));
  double height = 0, names = 0;
  bool shared = true;
  for (const auto& panel : panels) {
    height = std::max(height, height_of(panel));
    for (const auto& row : panel.rows) names = std::max(names, kCharacter * static_cast<double>(row.name.size()) + 20);
    shared = shared && std::equal(panel.rows.begin(), panel.rows.end(), panels[0].rows.begin(), panels[0].rows.end(),
                                  [](const auto& a, const auto& b) { return a.name == b.name; });
  }
  const int lines = (n + columns - 1) / columns;
  const double width = kAxis + kValue + kRight, beside = shared ? 0 : names;
  std::string out = svg_open(title, names + columns * (width + beside) - beside, kLegend + lines * height);
  out += draw_legend(series, names);
  for (int i = 0; i < n; ++i) {
    const int column = i % columns, line = i / columns;
    out += svg_group(names + column * (width + beside), kLegend + line * height + kTop,
                     draw_panel(panels[static_cast<std::size_t>(i)], column == 0 || !shared));
  }
  return out + "</svg>\n";
}

}  // namespace talkgraph
