#include "nodes/face/prototype_sheet.h"

#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "nodes/face/reconstruct.h"
#include "nodes/types/picture_file.h"

namespace talkgraph {
namespace {

const cv::Scalar mark_colour(60, 230, 60), line_colour(230, 200, 60);

cv::Point2d point(const Shape& shape, Eigen::Index i, double scale) {
  return {(shape(i, 0) + 0.5) * scale - 0.5, (shape(i, 1) + 0.5) * scale - 0.5};
}

/// Scaled pictures are drawn upon in sixteenths of a pixel.
constexpr int shift = 4;
cv::Point fine(const cv::Point2d& p) {
  return {cv::saturate_cast<int>(p.x * (1 << shift)), cv::saturate_cast<int>(p.y * (1 << shift))};
}

cv::Mat scaled(const cv::Mat& picture, int width) {
  cv::Mat out;
  const double scale = static_cast<double>(width) / picture.cols;
  cv::resize(picture, out, {width, std::max(1, static_cast<int>(picture.rows * scale))}, 0, 0,
             scale < 1 ? cv::INTER_AREA : cv::INTER_CUBIC);
  return out;
}

void draw_points(cv::Mat& picture, const Shape& shape, double scale) {
  for (Eigen::Index i = 0; i < shape.rows(); ++i)
    cv::circle(picture, fine(point(shape, i, scale)), std::max(10, picture.cols / 8), mark_colour, cv::FILLED,
               cv::LINE_AA, shift);
}

void draw_triangles(cv::Mat& picture, const Shape& shape, const Triangles& triangles, double scale) {
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int side = 0; side < 3; ++side)
      cv::line(picture, fine(point(shape, triangles(t, side), scale)),
               fine(point(shape, triangles(t, (side + 1) % 3), scale)), line_colour, 1, cv::LINE_AA, shift);
}

/// Pictures of one width beside and under each other, each row as high as its highest.
cv::Mat tiled(const std::vector<cv::Mat>& tiles, int columns) {
  std::vector<cv::Mat> lines;
  for (std::size_t first = 0; first < tiles.size(); first += static_cast<std::size_t>(columns)) {
    const auto end = std::min(tiles.size(), first + static_cast<std::size_t>(columns));
    int height = 0;
    for (auto i = first; i < end; ++i) height = std::max(height, tiles[i].rows);
    auto& line = lines.emplace_back(height, columns * tiles[0].cols, CV_8UC3, cv::Scalar::all(255));
    for (auto i = first; i < end; ++i)
      tiles[i].copyTo(line(cv::Rect({static_cast<int>(i - first) * tiles[0].cols, 0}, tiles[i].size())));
  }
  cv::Mat sheet;
  cv::vconcat(lines, sheet);
  return sheet;
}

void check(const Prototypes& prototypes) {
  if (prototypes.images.empty()) throw std::runtime_error("there are no prototypes to show");
}

Artifact write(const cv::Mat& sheet, const std::string& name, const char* title, const Context& context) {
  const Artifact artifact{name + ".png", title};
  write_picture(context.file(artifact.path), sheet);
  return artifact;
}

}  // namespace

Artifact PrototypeSheet::operator()(const Prototypes& prototypes, Context& context) const {
  check(prototypes);
  std::vector<cv::Mat> tiles;
  for (std::size_t i = 0; i < prototypes.images.size(); ++i) {
    const cv::Mat& picture = prototypes.images[i].pixels;
    tiles.push_back(scaled(picture, width));
    draw_points(tiles.back(), prototypes.shapes[i], static_cast<double>(width) / picture.cols);
  }
  return write(tiled(tiles, std::min(columns, static_cast<int>(tiles.size()))), name, "prototypes", context);
}

Artifact ModelSheet::operator()(const AppearanceModel& model, const Prototypes& prototypes, Context& context) const {
  check(prototypes);
  const auto count = prototypes.images.size();
  const auto shown = std::min(count, static_cast<std::size_t>(rows));
  std::vector<cv::Mat> tiles;
  for (std::size_t row = 0; row < shown; ++row) {
    const auto i = (2 * row + 1) * count / (2 * shown);
    const cv::Mat& picture = prototypes.images[i].pixels;
    const Shape& shape = prototypes.shapes[i];
    const double scale = static_cast<double>(width) / picture.cols;
    const cv::Mat plain = scaled(picture, width);
    cv::Mat points = plain.clone(), triangles = plain.clone();
    draw_triangles(triangles, shape, model.triangles, scale);
    draw_points(points, shape, scale);
    tiles.insert(tiles.end(), {plain, points, triangles, scaled(reconstruct(model, picture, shape).picture, width)});
  }
  return write(tiled(tiles, 4), name, "picture, landmarks, triangles, face of the model", context);
}

void describe(Description<PrototypeSheet>& d) {
  d.type("face.prototype_sheet").version(1).summary("all prototypes with their landmarks, as one picture");
  d.source("docs/method.md §2").sink();
  d.input("prototypes", "pictures with landmarks").output("picture", "a PNG file");
  d.param("columns", &PrototypeSheet::columns).at_least(1).doc("pictures in a row");
  d.param("width", &PrototypeSheet::width).within(16, 4000).unit("px").doc("of one picture");
  d.param("name", &PrototypeSheet::name).doc("of the file below the run folder, without .png");
}

void describe(Description<ModelSheet>& d) {
  d.type("face.model_sheet")
      .version(1)
      .summary("prototypes, their landmarks and triangles, and what the model makes of them, as one picture");
  d.source("Thesis Figures 3.5, 3.6").sink();
  d.input("model", "of the face").input("prototypes", "pictures with landmarks").output("picture", "a PNG file");
  d.param("rows", &ModelSheet::rows).at_least(1).doc("prototypes shown, evenly chosen");
  d.param("width", &ModelSheet::width).within(16, 4000).unit("px").doc("of one picture");
  d.param("name", &ModelSheet::name).doc("of the file below the run folder, without .png");
}

}  // namespace talkgraph
