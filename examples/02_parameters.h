// 2. Parameters: the members of the struct. Their initial values are the defaults; the description gives limits, units
// and a line for people. A graph that breaks a limit is refused before anything runs, with file, line and column.
#pragma once

#include "graph/description.h"
#include "nodes/types/track.h"

namespace mine {

using talkgraph::Track, talkgraph::Description;

// A plain node with two parameters, whole, in 15 lines. One more registers it: registry.add<mine::Scale>() (part 6).

/// Brings quiet..loud to 0..1; what lies outside is cut off.
struct Scale {
  double quiet = -60, loud = -20;

  Track operator()(const Track& level) const {
    Track out = level;
    out.values = ((level.values.array() - quiet) / (loud - quiet)).max(0).min(1);
    return out;
  }
};
inline void describe(Description<Scale>& d) {
  d.type("mine.scale").summary("brings quiet..loud to 0..1").input("level", "dB").output("share", "0..1");
  d.param("quiet", &Scale::quiet).within(-120, -40).unit("dB").doc("becomes 0");
  d.param("loud", &Scale::loud).within(-39, 0).unit("dB").doc("becomes 1");
}

// A choice is an enum whose values have names, given beside it.
enum class Window { box, triangle };

}  // namespace mine

template <>
inline constexpr talkgraph::EnumNames<mine::Window, 2> talkgraph::enum_names<mine::Window>{
    {{mine::Window::box, "box"}, {mine::Window::triangle, "triangle"}}};

namespace mine {

/// A moving average over `width` seconds around each frame; at the ends over what is there.
struct Smooth {
  double width = 0.08;
  Window window = Window::triangle;

  Track operator()(const Track& track) const {
    const auto reach = static_cast<Eigen::Index>(std::lround(width / 2 * track.rate.value()));
    Track out = track;
    for (Eigen::Index t = 0; t < track.frames(); ++t) {
      Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(track.dimension());
      double weights = 0;
      for (Eigen::Index s = std::max<Eigen::Index>(0, t - reach); s <= std::min(track.frames() - 1, t + reach); ++s) {
        const double weight = window == Window::box ? 1 : 1 - std::abs(double(s - t)) / double(reach + 1);
        sum += weight * track.values.row(s);
        weights += weight;
      }
      out.values.row(t) = sum / weights;
    }
    return out;
  }
};
inline void describe(Description<Smooth>& d) {
  d.type("mine.smooth").summary("moving average").input("track", "T x D").output("track", "T x D");
  d.param("width", &Smooth::width).positive().unit("s").doc("of the window");
  d.param("window", &Smooth::window).doc("box: all frames count the same; triangle: near ones count more");
}

}  // namespace mine
