#include "nodes/write/plot.h"

#include <fmt/format.h>

#include <stdexcept>

#include "graph/output_file.h"
#include "nodes/codecs/codecs.h"
#include "nodes/types/codec.h"
#include "nodes/types/item_file.h"
#include "nodes/types/picture_file.h"

namespace talkgraph {
namespace {

cv::Mat draw(const Plot& plot, double scale, const std::filesystem::path& file) {
  cv::Mat pixels;
  try {
    codec<decltype(codec_draw_svg)>("codec_draw_svg")(plot.svg, scale, pixels);
  } catch (const std::exception& e) {
    throw std::runtime_error(fmt::format("{}: the plot cannot be drawn: {}", file.string(), e.what()));
  }
  return pixels;
}

}  // namespace

Artifact WritePlot::operator()(const Plot& plot, Context& context) const {
  if (name.empty() && context.item.empty())
    throw std::invalid_argument("a plot that is not an item of a stream needs the parameter \"name\"");
  const char* const ending = format == PlotFormat::svg ? ".svg" : ".png";
  const std::string path = name.empty() ? item_file(context, folder, ending, "").path
                                        : (std::filesystem::path(folder) / (name + ending)).string();
  if (format == PlotFormat::svg)
    write_file(context.file(path), plot.svg);
  else
    write_picture(context.file(path), draw(plot, scale, context.file(path)));
  return {path, plot.title};
}

void describe(Description<WritePlot>& d) {
  d.type("write.plot").summary("writes a plot as SVG or PNG").sink();
  d.input("plot", "what is written").output("file", "the picture");
  d.param("name", &WritePlot::name).doc("file name without its ending; of the item if empty");
  d.param("folder", &WritePlot::folder).doc("below the run folder");
  d.param("format", &WritePlot::format).doc("svg: scales; png: pixels");
  d.param("scale", &WritePlot::scale).within(0.1, 20).doc("pixels of a PNG for one of the plot");
}

}  // namespace talkgraph
