#include "nodes/face/strip.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "nodes/types/item_file.h"
#include "nodes/types/picture_file.h"

namespace talkgraph {
namespace {

constexpr int bar_height = 18;

cv::Mat tile(const cv::Mat& frame, int width, const std::string& text) {
  const int height = std::max(1, frame.rows * width / frame.cols);
  cv::Mat out(height + bar_height, width, CV_8UC3, cv::Scalar::all(255));
  cv::Mat scaled;
  cv::resize(frame, scaled, {width, height}, 0, 0, cv::INTER_AREA);
  scaled.copyTo(out(cv::Rect(0, 0, width, height)));
  cv::putText(out, text, {4, height + bar_height - 5}, cv::FONT_HERSHEY_SIMPLEX, 0.42, {}, 1, cv::LINE_AA);
  return out;
}

}  // namespace

Artifact FrameStrip::operator()(const Video& video, const FrameLabels* labels, Context& context) const {
  std::vector<cv::Mat> tiles;
  const auto reader = video.source->open();
  cv::Mat frame;
  for (std::size_t t = 0; reader->next(frame); ++t) {
    if (t % static_cast<std::size_t>(every)) continue;
    std::string text = std::to_string(t);
    if (labels && t < labels->labels.size()) text += "  " + labels->labels[t];
    tiles.push_back(tile(frame, width, text));
  }
  if (tiles.empty()) throw std::runtime_error(video.source->name() + ": no frame to show");
  const int across = std::min(columns, static_cast<int>(tiles.size())),
            down = (static_cast<int>(tiles.size()) + across - 1) / across;
  const cv::Size size = tiles[0].size();
  cv::Mat sheet(down * size.height, across * size.width, CV_8UC3, cv::Scalar::all(255));
  for (int i = 0; i < static_cast<int>(tiles.size()); ++i)
    tiles[static_cast<std::size_t>(i)].copyTo(
        sheet(cv::Rect({i % across * size.width, i / across * size.height}, size)));
  Artifact artifact = item_file(context, folder, ".png", "strip");
  write_picture(context.file(artifact.path), sheet);
  artifact.title = "frames of " + video.source->name();
  return artifact;
}

void describe(Description<FrameStrip>& d) {
  d.type("face.strip")
      .version(1)
      .summary("frames of a clip with their phones, as one picture")
      .source("Thesis Appendix D")
      .sink();
  d.input("video", "of any size").input("labels", "phone of every frame").output("picture", "a PNG file");
  d.param("every", &FrameStrip::every).at_least(1).unit("frames").doc("shows one frame of so many");
  d.param("columns", &FrameStrip::columns).at_least(1).doc("pictures in a row");
  d.param("width", &FrameStrip::width).within(16, 4000).unit("px").doc("of one picture");
  d.param("folder", &FrameStrip::folder).doc("below the run folder");
}

}  // namespace talkgraph
