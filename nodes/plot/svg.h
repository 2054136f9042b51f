#pragma once

#include <string>
#include <vector>

namespace talkgraph {

/// One line of a plot. NaN values interrupt it.
struct Series {
  std::string name;
  std::vector<double> x, y;
};

/// A pair of axes with its lines.
struct Panel {
  std::string title, x_label, y_label;
  std::vector<Series> series;
};

/// Panels side by side, `columns` in a row, with ticks, and one legend for all:
/// series of the same place in their panels share a colour. SVG text that
/// stands alone or inside HTML.
std::string draw_panels(const std::vector<Panel>& panels, int columns);

/// Text made safe for SVG and HTML.
std::string escape_markup(const std::string& text);

}  // namespace talkgraph
