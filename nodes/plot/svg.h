#pragma once

#include <string>
#include <vector>

namespace talkgraph {

/// One line of a plot. NaN values interrupt it.
struct Series {
  std::string name;
  std::vector<double> x, y;
  std::vector<double> spread = {};  ///< whiskers of ± this at each point; empty or NaN: none
  bool band = false;                ///< the spread as a band, not as whiskers
  bool stroke = true;               ///< the line itself is drawn
};

/// A pair of axes with its lines.
struct Panel {
  std::string title, x_label, y_label;
  std::vector<Series> series;
};

/// How panels are laid out, pixels.
struct Layout {
  int columns = 3;
  double width = 320, height = 220;  ///< of a panel
};

/// Panels beside and under each other, with ticks, and one legend for all:
/// series of the same place in their panels share a colour. SVG text that
/// stands alone or inside HTML; screen readers are told the title.
std::string draw_panels(const std::string& title, const std::vector<Panel>& panels, const Layout& layout = {});

/// A bar with a whisker of ± `spread` around its end; NaN leaves either out.
struct Bar {
  std::string name;
  double value = 0, spread = 0;
};

/// Lying bars with their names on the left and their values on the right.
struct BarPanel {
  std::string title;
  std::vector<Bar> bars;
};
std::string draw_bars(const std::string& title, const std::vector<BarPanel>& panels, int columns = 2);

/// What rounding left of a zero is shown as one; the files keep every digit.
double shown_number(double value);

/// Text made safe for SVG and HTML.
std::string escape_markup(const std::string& text);

}  // namespace talkgraph
