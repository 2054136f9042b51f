#include "nodes/report/write_plot.h"

#include <stdexcept>

#include "graph/output_file.h"
#include "nodes/types/item_file.h"

namespace talkgraph {

Artifact WritePlot::operator()(const Plot& plot, Context& context) const {
  if (name.empty() && context.item.empty())
    throw std::invalid_argument("a plot that is not an item of a stream needs the parameter \"name\"");
  const std::string path = name.empty() ? item_file(context, folder, ".svg", "").path
                                        : (std::filesystem::path(folder) / (name + ".svg")).string();
  write_file(context.folder / path, plot.svg);
  return {path, plot.title};
}

void describe(Description<WritePlot>& d) {
  d.type("report.write_plot").summary("writes a plot as an SVG file").sink();
  d.input("plot", "what is written").output("file", "the SVG file");
  d.param("name", &WritePlot::name).doc("file name without its ending; of the item if empty");
  d.param("folder", &WritePlot::folder).doc("below the run folder");
}

}  // namespace talkgraph
