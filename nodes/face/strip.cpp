#include "nodes/face/strip.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "nodes/types/item_file.h"
#include "nodes/types/picture_file.h"

namespace talkgraph {
namespace {

constexpr int gap = 2, bar_height = 36, side_width = 22;
const cv::Scalar white = cv::Scalar::all(255), black = cv::Scalar::all(0), dim = cv::Scalar::all(130);

struct Tile {
  cv::Mat picture;    ///< of one clip, or of both below each other
  std::size_t frame;  ///< its number
  std::string phone;
};

void write_text(cv::Mat& sheet, const std::string& text, cv::Point middle, double size, const cv::Scalar& colour) {
  int below = 0;
  const auto box = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, 1, &below);
  cv::putText(sheet, text, middle + cv::Point(-box.width / 2, box.height / 2), cv::FONT_HERSHEY_SIMPLEX, size, colour,
              1, cv::LINE_AA);
}

/// Text that reads upwards, in the middle of `part`.
void write_upwards(cv::Mat part, const std::string& text) {
  cv::Mat lying(part.cols, part.rows, CV_8UC3, white);
  write_text(lying, text, {lying.cols / 2, lying.rows / 2}, 0.42, black);
  cv::rotate(lying, lying, cv::ROTATE_90_COUNTERCLOCKWISE);
  lying.copyTo(part);
}

cv::Mat scaled(const cv::Mat& frame, int width) {
  cv::Mat out;
  const int height = std::max(1, frame.rows * width / frame.cols);
  cv::resize(frame, out, {width, height}, 0, 0, width < frame.cols ? cv::INTER_AREA : cv::INTER_CUBIC);
  return out;
}

/// Rows of pictures, each above a bar with their numbers and phones.
class Sheet {
 public:
  Sheet(std::vector<Tile> tiles, int columns, int side)
      : tiles_(std::move(tiles)), side_(side), across_(std::min(columns, static_cast<int>(tiles_.size()))) {
    size_ = tiles_[0].picture.size();
    const int rows = (static_cast<int>(tiles_.size()) + across_ - 1) / across_;
    pixels = cv::Mat(rows * (size_.height + bar_height), side_ + across_ * (size_.width + gap), CV_8UC3, white);
    for (int i = 0; i < static_cast<int>(tiles_.size()); ++i) {
      tile(i).picture.copyTo(pixels(cv::Rect(corner(i), size_)));
      write_text(pixels, std::to_string(tile(i).frame), corner(i) + cv::Point(size_.width / 2, size_.height + 8), 0.33,
                 dim);
    }
    for (int from = 0, to = 0; from < static_cast<int>(tiles_.size()); from = to) {
      while (to < static_cast<int>(tiles_.size()) && to / across_ == from / across_ &&
             tile(to).phone == tile(from).phone)
        ++to;
      if (!tile(from).phone.empty()) write_phone(from, to - 1);
    }
  }

  cv::Point corner(int i) const {
    return {side_ + i % across_ * (size_.width + gap), i / across_ * (size_.height + bar_height)};
  }
  int rows() const { return pixels.rows / (size_.height + bar_height); }

  cv::Mat pixels;

 private:
  const Tile& tile(int i) const { return tiles_[static_cast<std::size_t>(i)]; }

  void write_phone(int first, int last) {
    const int y = corner(first).y + size_.height + 16, left = corner(first).x + 3,
              right = corner(last).x + size_.width - 3;
    cv::line(pixels, {left, y}, {right, y}, black);
    write_text(pixels, tile(first).phone, {(left + right) / 2, y + 10}, 0.45, black);
  }

  std::vector<Tile> tiles_;
  int side_, across_;
  cv::Size size_;
};

}  // namespace

Artifact FrameStrip::operator()(const Video& video, const Video* below, const FrameLabels* labels,
                                Context& context) const {
  std::vector<Tile> tiles;
  const auto reader = video.source->open(), second = below ? below->source->open() : nullptr;
  int upper = 0;  // height of the first clip's pictures
  cv::Mat frame, other;
  for (std::size_t t = 0; reader->next(frame) && (!second || second->next(other)); ++t) {
    if (t % static_cast<std::size_t>(every)) continue;
    cv::Mat picture = scaled(frame, width);
    upper = picture.rows;
    if (second) cv::vconcat(picture, scaled(other, width), picture);
    tiles.push_back({picture, t, labels && t < labels->labels.size() ? labels->labels[t] : ""});
  }
  if (tiles.empty()) throw std::runtime_error(video.source->name() + ": no frame to show");
  const int lower = tiles[0].picture.rows - upper;
  Sheet sheet(std::move(tiles), columns, second ? side_width : 0);
  for (int row = 0; second && row < sheet.rows(); ++row) {
    const int top = sheet.pixels.rows / sheet.rows() * row;
    write_upwards(sheet.pixels(cv::Rect(0, top, side_width, upper)), label);
    write_upwards(sheet.pixels(cv::Rect(0, top + upper, side_width, lower)), below_label);
  }
  Artifact artifact = item_file(context, folder, ".png", "strip");
  write_picture(context.file(artifact.path), sheet.pixels);
  artifact.title = "frames of " + video.source->name();
  return artifact;
}

void describe(Description<FrameStrip>& d) {
  d.type("face.strip")
      .version(2)
      .summary("frames of a clip, or of two below each other, with their phones, as one picture")
      .source("Thesis Appendix D")
      .sink();
  d.input("video", "of any size")
      .input("below", "shown below the first, frame by frame")
      .input("labels", "phone of every frame")
      .output("picture", "a PNG file");
  d.param("every", &FrameStrip::every).at_least(1).unit("frames").doc("shows one frame of so many");
  d.param("columns", &FrameStrip::columns).at_least(1).doc("pictures in a row");
  d.param("width", &FrameStrip::width).within(16, 4000).unit("px").doc("of one picture");
  d.param("label", &FrameStrip::label).doc("beside the first clip's pictures, where there are two clips");
  d.param("below_label", &FrameStrip::below_label).doc("beside the second clip's");
  d.param("folder", &FrameStrip::folder).doc("below the run folder");
}

}  // namespace talkgraph
