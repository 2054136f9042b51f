#include "nodes/plot/latent.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "nodes/plot/contours.h"
#include "nodes/plot/marks.h"
#include "nodes/plot/svg.h"

namespace talkgraph {
namespace {

constexpr double kWidth = 440, kLowest = 240, kHighest = 440;  // of the panel
constexpr double kLeft = 58, kTop = 40, kBottom = 52, kBar = 14, kLegendLeft = 86, kLegendStep = 17;
constexpr double kMargin = 0.12;  // around the points, a share of their range

struct Range {
  double low = INFINITY, high = -INFINITY;
  double size() const { return high - low; }
  double middle() const { return (low + high) / 2; }
  void widen(double to) {
    const double m = middle();
    low = m - to / 2, high = m + to / 2;
  }
};

Range range_of(const LatentPicture& p, Eigen::Index column) {
  Range range;
  const auto take = [&](const Eigen::MatrixXd& points) {
    range.low = std::min(range.low, points.col(column).minCoeff());
    range.high = std::max(range.high, points.col(column).maxCoeff());
  };
  take(p.points);
  for (const auto& path : p.paths) take(path);
  range.widen(range.size() > 0 ? (1 + 2 * kMargin) * range.size() : 2);
  return range;
}

Axis axis_of(const Range& range, double pixels) {
  return {range.low, range.high, axis_over(range.low, range.high, static_cast<int>(pixels / 60)).step};
}

/// Latent dimensions have one scale, as distances in all directions count alike.
void set_limits(LatentPicture& p) {
  Range x = range_of(p, 0), y = range_of(p, 1);
  double height = 0.65 * kWidth;
  if (p.axes[1].kind == LatentAxis::Kind::dimension) {
    height = std::clamp(kWidth * y.size() / x.size(), kLowest, kHighest);
    x.widen(std::max(x.size(), y.size() * kWidth / height));
    y.widen(x.size() * height / kWidth);
  }
  p.x = axis_of(x, kWidth);
  p.y = axis_of(y, height);
}

double height_of(const LatentPicture& p) {
  if (p.axes[1].kind != LatentAxis::Kind::dimension) return 0.65 * kWidth;
  return kWidth * (p.y.high - p.y.low) / (p.x.high - p.x.low);
}

Eigen::MatrixXd background_of(const LatentPicture& p, const LatentSpace& space, const GaussianProcess& process,
                              int resolution) {
  const auto columns = static_cast<Eigen::Index>(resolution);
  const auto rows = std::max<Eigen::Index>(2, std::lround(resolution * height_of(p) / kWidth));
  Eigen::MatrixXd background(rows, columns), places(columns, 2);
  places.col(0).setLinSpaced(p.x.low, p.x.high);
  for (Eigen::Index r = 0; r < rows; ++r) {
    places.col(1).setConstant(p.y.low + (p.y.high - p.y.low) * static_cast<double>(r) / static_cast<double>(rows - 1));
    background.row(r) = log_precision(process, latents_at(space, p.axes, places)).transpose();
  }
  return background;
}

/// From dark to white.
std::string shade(double share) {
  const auto mix = [&](int dark) {
    return static_cast<int>(std::lround(dark + std::clamp(share, 0., 1.) * (255 - dark)));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", mix(112), mix(122), mix(140));
}

class Drawing {
 public:
  explicit Drawing(const LatentPicture& picture)
      : p_(picture),
        h_(height_of(picture)),
        levels_(axis_over(p_.background.minCoeff(), p_.background.maxCoeff(), 8)) {}

  std::string panel() const { return background() + axes() + bar() + trajectories() + dots() + paths() + legend(); }
  double height() const {
    const double entries = static_cast<double>(p_.phones.names.size()) + 2;
    return std::max(h_ + kBottom, entries * kLegendStep + 12);
  }

 private:
  double x(double v) const { return p_.x.share(v) * kWidth; }
  double y(double v) const { return h_ - p_.y.share(v) * h_; }
  std::string at(const Eigen::MatrixXd& points, Eigen::Index t) const {
    return fmt::format("{:.1f} {:.1f}", x(points(t, 0)), y(points(t, 1)));
  }

  std::string background() const {
    const auto bands = levels_.ticks();
    std::string out = fmt::format("<rect width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n", kWidth, h_, band(0));
    const double dx = kWidth / static_cast<double>(p_.background.cols() - 1);
    const double dy = h_ / static_cast<double>(p_.background.rows() - 1);
    for (std::size_t i = 1; i + 1 < bands.size(); ++i) {
      std::string path;
      for (const auto& ring : rings_above(p_.background, bands[i])) {
        for (std::size_t k = 0; k < ring.size(); ++k)
          path += fmt::format("{}{:.1f} {:.1f}", k ? "L" : "M", ring[k].x() * dx, h_ - ring[k].y() * dy);
        path += "Z";
      }
      if (!path.empty()) out += fmt::format("<path d=\"{}\" fill=\"{}\" fill-rule=\"evenodd\"/>\n", path, band(i));
    }
    return out;
  }
  std::string band(std::size_t i) const {
    const auto bands = static_cast<double>(levels_.ticks().size() - 1);
    return shade(bands > 1 ? static_cast<double>(i) / (bands - 1) : 1);
  }

  std::string axes() const {
    std::string out = svg_line(fmt::format("M0 0H{:.1f}V{:.1f}H0Z", kWidth, h_), "#666");
    const auto first = [](const Axis& a) { return std::ceil(a.low / a.step) * a.step; };
    for (double v = first(p_.x); v <= p_.x.high; v += p_.x.step) {
      out += svg_line(fmt::format("M{:.1f} {:.1f}v4", x(v), h_), "#666");
      out += svg_text(x(v), h_ + 17, "middle", tick_text(p_.x, v));
    }
    for (double v = first(p_.y); v <= p_.y.high; v += p_.y.step) {
      out += svg_line(fmt::format("M0 {:.1f}h-4", y(v)), "#666");
      out += svg_text(-8, y(v) + 4, "end", tick_text(p_.y, v));
    }
    out += svg_text(kWidth / 2, h_ + 36, "middle", p_.axes[0].name());
    return out + svg_text(-h_ / 2, -42, "middle", p_.axes[1].name(), " transform=\"rotate(-90)\"");
  }

  /// What the shades mean.
  std::string bar() const {
    const auto bands = levels_.ticks();
    const double left = kWidth + 16, step = h_ / static_cast<double>(bands.size() - 1);
    std::string out;
    for (std::size_t i = 0; i + 1 < bands.size(); ++i)
      out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{:.1f}\" fill=\"{}\"/>\n", left,
                         h_ - static_cast<double>(i + 1) * step, kBar, step + 0.3, band(i));
    out += svg_line(fmt::format("M{:.1f} 0h{}V{:.1f}h-{}Z", left, kBar, h_, kBar), "#666");
    for (std::size_t i = 0; i < bands.size(); ++i)
      out += svg_text(left + kBar + 5, h_ - static_cast<double>(i) * step + 4, "start", tick_text(levels_, bands[i]));
    const std::string meaning = "ln precision, " + p_.process;
    return out + svg_text(-h_ / 2, left + kBar + 42, "middle", meaning, " transform=\"rotate(-90)\"");
  }

  /// Each step in the colour of the frame that it leads to.
  std::string trajectories() const {
    std::vector<std::string> steps(p_.phones.names.size());
    Eigen::Index t = 0;
    for (const auto length : p_.lengths) {
      for (Eigen::Index k = t + 1; k < t + length; ++k)
        steps[colour(k)] += "M" + at(p_.points, k - 1) + "L" + at(p_.points, k);
      t += length;
    }
    std::string out;
    for (std::size_t i = 0; i < steps.size(); ++i)
      if (!steps[i].empty()) out += svg_line(steps[i], p_.phones.colours[i].c_str(), 1, " stroke-opacity=\"0.45\"");
    return out;
  }

  std::string dots() const {
    const double size = p_.points.rows() > 2000 ? 3 : p_.points.rows() > 400 ? 4.5 : 6.5;
    std::vector<std::string> dots(p_.phones.names.size());
    for (Eigen::Index t = 0; t < p_.points.rows(); ++t) dots[colour(t)] += dot(p_.points, t);
    std::string out, starts;
    for (std::size_t i = 0; i < dots.size(); ++i) {
      out += svg_line(dots[i], "#fff", size + 1.4, kRound);
      out += svg_line(dots[i], p_.phones.colours[i].c_str(), size, kRound);
    }
    Eigen::Index t = 0;
    for (const auto length : p_.lengths) {
      if (length > 1) starts += dot(p_.points, t);
      t += length;
    }
    return starts.empty() ? out : out + svg_line(starts, "#fff", 0.45 * size, kRound);
  }

  std::string paths() const {
    std::string path, points;
    for (const auto& part : p_.paths)
      for (Eigen::Index t = 0; t < part.rows(); ++t) {
        path += (t ? "L" : "M") + at(part, t);
        points += dot(part, t);
      }
    if (points.empty()) return "";
    const double width = points.size() > 4000 ? 0.9 : 1.4;
    return svg_line(path, "#fff", width + 2, kRound) + svg_line(path, "#000", width, kRound) +
           svg_line(points, "#000", 3.2 * width, kRound);
  }

  std::string legend() const {
    std::string out;
    double row = 6;
    const auto entry = [&](const std::string& mark, const std::string& text) {
      out += svg_group(kWidth + kLegendLeft, row, mark + svg_text(14, 4, "start", text));
      row += kLegendStep;
    };
    for (std::size_t i = 0; i < p_.phones.names.size(); ++i)
      entry(svg_line("M0 0h.01", p_.phones.colours[i].c_str(), 8, kRound),
            fmt::format("{} ({})", p_.phones.names[i], p_.phones.counts[i]));
    if (std::any_of(p_.lengths.begin(), p_.lengths.end(), [](auto length) { return length > 1; }))
      entry(svg_line("M0 0h.01", "#777", 8, kRound) + svg_line("M0 0h.01", "#fff", 3.6, kRound), "first of a window");
    if (!p_.paths.empty())
      entry(svg_line("M-6 0H6", "#000", 1.4) + svg_line("M0 0h.01", "#000", 4.6, kRound), "synthesised");
    return out;
  }

  std::size_t colour(Eigen::Index t) const { return p_.phones.of_frame[static_cast<std::size_t>(t)]; }
  std::string dot(const Eigen::MatrixXd& points, Eigen::Index t) const { return "M" + at(points, t) + "h.01"; }

  static constexpr const char* kRound = " stroke-linecap=\"round\" stroke-linejoin=\"round\"";
  const LatentPicture& p_;
  double h_;
  Axis levels_;
};

double legend_width(const LatentPicture& p) {
  std::size_t most = 15;
  for (const auto& name : p.phones.names) most = std::max(most, name.size() + 7);
  return 24 + 6.3 * static_cast<double>(most);
}

}  // namespace

LatentPicture latent_picture(const PlotLatent& node, const LatentSpace& space, const Collected<FrameLabels>& labels,
                             const Collected<Track>& paths, const Collected<SegmentTrack>& states) {
  LatentPicture p;
  const auto process = process_of(space, node.process);
  p.process = process.name;
  p.axes = latent_axes(space, node.dimensions, 2);
  p.lengths = space.lengths;
  p.points = along(p.axes, *space.latents, frames_in_windows(space.lengths));
  p.phones = phone_colours(latent_phones(space, labels));
  for (const auto& path : paths_within(space, paths, states))
    p.paths.push_back(along(p.axes, path, frames_in_windows({path.rows()})));
  set_limits(p);
  p.background = background_of(p, space, *process.process, node.resolution);
  return p;
}

std::string draw_latent(const std::string& title, const LatentPicture& picture) {
  const Drawing drawing(picture);
  const double width = kLeft + kWidth + kLegendLeft + legend_width(picture);
  return svg_open(title, width, kTop + drawing.height()) +
         svg_text(kLeft, 22, "start", title, " font-weight=\"bold\" font-size=\"13\"") +
         svg_group(kLeft, kTop, drawing.panel()) + "</svg>\n";
}

Plot PlotLatent::operator()(const Value& model, const Collected<FrameLabels>& labels, const Collected<Track>& paths,
                            const Collected<SegmentTrack>& states) const {
  const LatentSpace space = latent_space(model, state);
  const std::string heading = title.empty() ? heading_of(space) : title;
  return {heading, draw_latent(heading, latent_picture(*this, space, labels, paths, states))};
}

void describe(Description<PlotLatent>& d) {
  d.type("plot.latent").version(2).summary("latent points of a model, coloured by what is said, before its precision");
  d.source("Thesis §4.2.5 and §4.3.4, Figures 4.6 and 4.10");
  d.input("model", "an Ssgpdm, of which one state is shown, an Sgpdm or a Gpdm")
      .input("labels",
             "phones or visemes of the frames trained on; {} for a state of a switching model, which has its own")
      .input("paths", "synthesised latent points, drawn over them: latents of mapping.ssgpdm_synthesise, or {}")
      .input("states", "whose segments the paths are: states of mapping.ssgpdm_synthesise, or {}")
      .output("plot", "one panel");
  d.param("state", &PlotLatent::state)
      .doc("label of the state; empty: the one with most frames, if possible of several phones");
  d.param("process", &PlotLatent::process)
      .doc("whose precision is the background: audio, visual, observations or dynamics; empty: the last one observed");
  d.param("dimensions", &PlotLatent::dimensions).at_least(1).doc("two, from 1; empty: the most relevant two");
  d.param("resolution", &PlotLatent::resolution).within(8, 400).doc("places along the picture where it is computed");
  d.param("title", &PlotLatent::title).doc("heading; empty: the state's label and size");
}

}  // namespace talkgraph
