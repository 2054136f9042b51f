#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"

namespace talkgraph {

enum class PlotFormat { svg, png };
template <>
inline constexpr EnumNames<PlotFormat, 2> enum_names<PlotFormat>{{{PlotFormat::svg, "svg"}, {PlotFormat::png, "png"}}};

/// Writes a plot as FOLDER/NAME.svg or .png below the run folder; NAME is that of
/// the item unless it is given. Errors: the file cannot be written, a plot is no SVG.
struct WritePlot {
  std::string name;
  std::string folder = "plots";
  PlotFormat format = PlotFormat::svg;
  double scale = 2;  ///< pixels of a PNG for one of the plot

  Artifact operator()(const Plot& plot, Context& context) const;
};
void describe(Description<WritePlot>& d);

}  // namespace talkgraph
