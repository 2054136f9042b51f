#include "nodes/plot/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "nodes/plot/axis.h"
#include "nodes/plot/marks.h"

namespace talkgraph {
namespace {

constexpr double kLeft = 54, kRight = 14, kTop = 28, kBottom = 42, kLegend = 28;
constexpr double kBarHeight = 24, kCharacter = 6.3, kValue = 64;

/// Of the whisker at a point, or 0.
double spread_at(const Series& s, std::size_t i) {
  return i < s.spread.size() && std::isfinite(s.spread[i]) ? s.spread[i] : 0;
}

Axis x_axis(const Panel& panel, int ticks) {
  double low = INFINITY, high = -INFINITY;
  for (const auto& s : panel.series)
    for (const double v : s.x)
      if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  return axis_over(low, high, ticks);
}

Axis y_axis(const Panel& panel, int ticks) {
  double low = INFINITY, high = -INFINITY;
  for (const auto& s : panel.series)
    for (std::size_t i = 0; i < s.y.size(); ++i)
      if (const double d = spread_at(s, i); std::isfinite(s.y[i]))
        low = std::min(low, s.y[i] - d), high = std::max(high, s.y[i] + d);
  return axis_over(low, high, ticks);
}

std::string path_of(const Series& s, const Axis& x, const Axis& y, double w, double h) {
  std::string path;
  bool drawing = false;
  for (std::size_t i = 0; i < std::min(s.x.size(), s.y.size()); ++i) {
    const bool there = std::isfinite(s.x[i]) && std::isfinite(s.y[i]);
    if (there)
      path += fmt::format("{}{:.1f} {:.1f}", drawing ? "L" : "M", x.share(s.x[i]) * w, h - y.share(s.y[i]) * h);
    drawing = there;
  }
  return path;
}

std::string whiskers_of(const Series& s, const Axis& x, const Axis& y, double w, double h) {
  std::string path;
  for (std::size_t i = 0; i < std::min(s.x.size(), s.y.size()); ++i) {
    const double d = spread_at(s, i);
    if (!(d > 0) || !std::isfinite(s.x[i]) || !std::isfinite(s.y[i])) continue;
    const double at = x.share(s.x[i]) * w, low = h - y.share(s.y[i] - d) * h, high = h - y.share(s.y[i] + d) * h;
    path += fmt::format("M{0:.1f} {2:.1f}V{1:.1f}M{3:.1f} {1:.1f}h6M{3:.1f} {2:.1f}h6", at, low, high, at - 3);
  }
  return path;
}

/// The area between the spreads of neighbouring points.
std::string band_of(const Series& s, const Axis& x, const Axis& y, double w, double h) {
  std::string path;
  const auto at = [&](std::size_t i, double side) {
    return fmt::format("{:.1f} {:.1f}", x.share(s.x[i]) * w, h - y.share(s.y[i] + side * spread_at(s, i)) * h);
  };
  const auto there = [&](std::size_t i) { return std::isfinite(s.x[i]) && std::isfinite(s.y[i]); };
  for (std::size_t i = 0; i + 1 < std::min(s.x.size(), s.y.size()); ++i)
    if (there(i) && there(i + 1))
      path += fmt::format("M{}L{}L{}L{}Z", at(i, 1), at(i + 1, 1), at(i + 1, -1), at(i, -1));
  return path;
}

std::string draw_axes(const Panel& panel, const Axis& x, const Axis& y, double w, double h) {
  std::string out = svg_text(w / 2, -10, "middle", panel.title, " font-weight=\"bold\"");
  for (const double v : y.ticks()) {
    const double at = h - y.share(v) * h;
    out += svg_line(fmt::format("M0 {:.1f}h{:.1f}", at, w), tick_text(y, v) == "0" ? "#bbb" : "#e4e4e4");
    out += svg_text(-7, at + 4, "end", tick_text(y, v));
  }
  for (const double v : x.ticks()) {
    out += svg_line(fmt::format("M{:.1f} {:.1f}v4", x.share(v) * w, h), "#888");
    out += svg_text(x.share(v) * w, h + 16, "middle", tick_text(x, v));
  }
  out += svg_line(fmt::format("M0 0V{:.1f}H{:.1f}", h, w), "#888");
  out += svg_text(w / 2, h + 33, "middle", panel.x_label);
  return out + svg_text(-h / 2, -42, "middle", panel.y_label, " transform=\"rotate(-90)\"");
}

std::string draw_panel(const Panel& panel, const Layout& layout) {
  const double w = layout.width - kLeft - kRight, h = layout.height - kTop - kBottom;
  const Axis x = x_axis(panel, std::max(2, static_cast<int>(w / 50)));
  const Axis y = y_axis(panel, std::max(2, static_cast<int>(h / 35)));
  std::string out = draw_axes(panel, x, y, w, h);
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    const char* colour = plot_colours[i % plot_colours.size()];
    if (panel.series[i].band)
      out += fmt::format("<path d=\"{}\" fill=\"{}\" fill-opacity=\"0.12\"/>\n", band_of(panel.series[i], x, y, w, h),
                         colour);
    if (panel.series[i].stroke) out += svg_line(path_of(panel.series[i], x, y, w, h), colour, 1.6);
    if (panel.series[i].band) continue;
    if (const auto whiskers = whiskers_of(panel.series[i], x, y, w, h); !whiskers.empty())
      out += svg_line(whiskers, colour);
  }
  return out;
}

std::string draw_legend(const std::vector<Panel>& panels) {
  std::string out;
  double x = kLeft;
  const auto most = std::max_element(panels.begin(), panels.end(),
                                     [](const Panel& a, const Panel& b) { return a.series.size() < b.series.size(); });
  for (std::size_t i = 0; i < most->series.size(); ++i) {
    const Series& series = most->series[i];
    const char* colour = plot_colours[i % plot_colours.size()];
    const std::string place = fmt::format("M{:.1f} 14h22", x);
    out += series.stroke ? svg_line(place, colour, 3) : svg_line(place, colour, 10, " stroke-opacity=\"0.2\"");
    out += svg_text(x + 28, 18, "start", series.name);
    x += 46 + kCharacter * static_cast<double>(series.name.size());
  }
  return out;
}

double longest_name(const std::vector<BarPanel>& panels) {
  std::size_t most = 0;
  for (const auto& panel : panels)
    for (const auto& bar : panel.bars) most = std::max(most, bar.name.size());
  return kCharacter * static_cast<double>(most);
}

Axis axis_of(const BarPanel& panel) {
  double low = 0, high = 0;
  for (const auto& bar : panel.bars) {
    if (!std::isfinite(bar.value)) continue;
    const double spread = std::isfinite(bar.spread) ? bar.spread : 0;
    low = std::min(low, bar.value - spread);
    high = std::max(high, bar.value + spread);
  }
  return axis_over(low, high, 4);
}

std::string draw_bar(const Bar& bar, const Axis& axis, double w, double y) {
  const double middle = y + kBarHeight / 2;
  std::string out = svg_text(-8, middle + 4, "end", bar.name);
  if (!std::isfinite(bar.value)) return out + svg_text(axis.share(0) * w + 6, middle + 4, "start", "no value");
  const double from = axis.share(std::min(0.0, bar.value)) * w, to = axis.share(std::max(0.0, bar.value)) * w;
  out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n", from, y + 4,
                     to - from, kBarHeight - 8, plot_colours[2]);
  if (std::isfinite(bar.spread) && bar.spread > 0)
    out += svg_line(
        fmt::format("M{0:.1f} {2:.1f}H{1:.1f}M{0:.1f} {3:.1f}v6M{1:.1f} {3:.1f}v6",
                    axis.share(bar.value - bar.spread) * w, axis.share(bar.value + bar.spread) * w, middle, middle - 3),
        plot_colours[0]);
  return out + svg_text(w + kValue - 4, middle + 4, "end", fmt::format("{:.4g}", shown_number(bar.value)));
}

std::string draw_bar_panel(const BarPanel& panel, double w) {
  const Axis axis = axis_of(panel);
  const double h = kBarHeight * static_cast<double>(panel.bars.size());
  std::string out = svg_text(w / 2, -10, "middle", panel.title, " font-weight=\"bold\"");
  for (const double v : axis.ticks()) {
    out +=
        svg_line(fmt::format("M{:.1f} 0v{:.1f}", axis.share(v) * w, h), tick_text(axis, v) == "0" ? "#888" : "#e4e4e4");
    out += svg_text(axis.share(v) * w, h + 16, "middle", tick_text(axis, v));
  }
  double y = 0;
  for (const auto& bar : panel.bars) {
    out += draw_bar(bar, axis, w, y);
    y += kBarHeight;
  }
  return out;
}

}  // namespace

double shown_number(double value) { return std::abs(value) < 1e-12 ? 0 : value; }

std::string escape_markup(const std::string& text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  return out;
}

std::string draw_panels(const std::string& title, const std::vector<Panel>& panels, const Layout& layout) {
  const int n = static_cast<int>(panels.size()), columns = std::clamp(layout.columns, 1, std::max(n, 1));
  std::string out = svg_open(title, columns * layout.width, kLegend + (n + columns - 1) / columns * layout.height);
  if (n > 0) out += draw_legend(panels);
  for (int i = 0; i < n; ++i)
    out += svg_group(i % columns * layout.width + kLeft, kLegend + i / columns * layout.height + kTop,
                     draw_panel(panels[static_cast<std::size_t>(i)], layout));
  return out + "</svg>\n";
}

std::string draw_bars(const std::string& title, const std::vector<BarPanel>& panels, int columns) {
  const int n = static_cast<int>(panels.size());
  columns = std::clamp(columns, 1, std::max(n, 1));
  constexpr double w = 240;
  const double names = longest_name(panels) + 18, width = names + w + kValue + kRight;
  std::size_t most = 0;
  for (const auto& panel : panels) most = std::max(most, panel.bars.size());
  const double height = kTop + kBarHeight * static_cast<double>(most) + kBottom;
  std::string out = svg_open(title, columns * width, (n + columns - 1) / columns * height);
  for (int i = 0; i < n; ++i)
    out += svg_group(i % columns * width + names, i / columns * height + kTop,
                     draw_bar_panel(panels[static_cast<std::size_t>(i)], w));
  return out + "</svg>\n";
}

}  // namespace talkgraph
