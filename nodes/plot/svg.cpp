#include "nodes/plot/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace talkgraph {
namespace {

constexpr double panel_width = 320, panel_height = 220;
constexpr double left = 52, right = 12, top = 28, bottom = 40, legend = 26;
// Okabe and Ito: told apart by people with any colour vision.
constexpr std::array<const char*, 7> colours = {"#222222", "#d55e00", "#0072b2", "#009e73",
                                                "#cc79a7", "#e69f00", "#56b4e9"};

struct Axis {
  double low = 0, high = 1, step = 1;

  double share(double v) const { return (v - low) / (high - low); }
};

/// Round limits and ticks around the values.
Axis axis_of(double low, double high, int ticks) {
  if (!(low <= high)) low = 0, high = 1;
  if (high - low < 1e-12) low -= 0.5, high += 0.5;
  const double raw = (high - low) / ticks, power = std::pow(10, std::floor(std::log10(raw)));
  const double step = power * (raw / power < 1.5 ? 1 : raw / power < 3.5 ? 2 : raw / power < 7.5 ? 5 : 10);
  return {std::floor(low / step) * step, std::ceil(high / step) * step, step};
}

template <class Values>
Axis axis_over(const Panel& panel, Values values, int ticks) {
  double low = INFINITY, high = -INFINITY;
  for (const auto& s : panel.series)
    for (const double v : values(s))
      if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  return axis_of(low, high, ticks);
}

std::string path_of(const Series& s, const Axis& x, const Axis& y, double w, double h) {
  std::string path;
  bool drawing = false;
  for (std::size_t i = 0; i < std::min(s.x.size(), s.y.size()); ++i) {
    if (!std::isfinite(s.x[i]) || !std::isfinite(s.y[i])) {
      drawing = false;
      continue;
    }
    path += fmt::format("{}{:.1f} {:.1f}", drawing ? "L" : "M", x.share(s.x[i]) * w, h - y.share(s.y[i]) * h);
    drawing = true;
  }
  return path;
}

std::string draw_panel(const Panel& panel, double at_x, double at_y) {
  const double w = panel_width - left - right, h = panel_height - top - bottom;
  const Axis x = axis_over(
      panel, [](const Series& s) -> const auto& { return s.x; }, 5);
  const Axis y = axis_over(
      panel, [](const Series& s) -> const auto& { return s.y; }, 4);
  std::string out = fmt::format("<g transform=\"translate({:.1f} {:.1f})\">\n", at_x + left, at_y + top);
  out += fmt::format("<text x=\"{:.1f}\" y=\"-10\" text-anchor=\"middle\" font-weight=\"bold\">{}</text>\n", w / 2,
                     escape_markup(panel.title));
  for (double v = x.low; v <= x.high + x.step / 2; v += x.step)
    out += fmt::format(
        "<text x=\"{0:.1f}\" y=\"{1:.1f}\" text-anchor=\"middle\">{2:.4g}</text><path d=\"M{0:.1f} {3:.1f}v4\" "
        "stroke=\"#888\"/>\n",
        x.share(v) * w, h + 16, std::abs(v) < x.step / 1e6 ? 0 : v, h);
  for (double v = y.low; v <= y.high + y.step / 2; v += y.step)
    out += fmt::format(
        "<text x=\"-7\" y=\"{:.1f}\" text-anchor=\"end\">{:.4g}</text><path d=\"M0 {:.1f}h{:.1f}\" "
        "stroke=\"#e4e4e4\"/>\n",
        h - y.share(v) * h + 4, std::abs(v) < y.step / 1e6 ? 0 : v, h - y.share(v) * h, w);
  out += fmt::format("<path d=\"M0 0V{0:.1f}H{1:.1f}\" fill=\"none\" stroke=\"#888\"/>\n", h, w);
  out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n", w / 2, h + 32,
                     escape_markup(panel.x_label));
  out += fmt::format("<text transform=\"translate(-40 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n", h / 2,
                     escape_markup(panel.y_label));
  for (std::size_t i = 0; i < panel.series.size(); ++i)
    out += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"/>\n",
                       path_of(panel.series[i], x, y, w, h), colours[i % colours.size()]);
  return out + "</g>\n";
}

std::string draw_legend(const std::vector<Panel>& panels) {
  std::string out;
  double x = left;
  const auto most = std::max_element(panels.begin(), panels.end(),
                                     [](const Panel& a, const Panel& b) { return a.series.size() < b.series.size(); });
  for (std::size_t i = 0; i < most->series.size(); ++i) {
    out += fmt::format(
        "<path d=\"M{:.1f} 14h22\" stroke=\"{}\" stroke-width=\"3\"/><text x=\"{:.1f}\" y=\"18\">{}</text>\n", x,
        colours[i % colours.size()], x + 28, escape_markup(most->series[i].name));
    x += 44 + 7.0 * static_cast<double>(most->series[i].name.size());
  }
  return out;
}

}  // namespace

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

std::string draw_panels(const std::vector<Panel>& panels, int columns) {
  const int n = static_cast<int>(panels.size());
  columns = std::clamp(columns, 1, std::max(n, 1));
  const double width = columns * panel_width, height = legend + (n + columns - 1) / columns * panel_height;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "font-family=\"Helvetica, Arial, sans-serif\" font-size=\"11\" fill=\"#222\" role=\"img\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
      width, height);
  if (n > 0) out += draw_legend(panels);
  for (int i = 0; i < n; ++i)
    out +=
        draw_panel(panels[static_cast<std::size_t>(i)], i % columns * panel_width, legend + i / columns * panel_height);
  return out + "</svg>\n";
}

}  // namespace talkgraph
