// What it costs to draw a face of 22,000 pixels and 40 modes in colour on a picture of 300 × 300: processor time of one
// core, against plain calls of OpenCV and Eigen.

#include "nodes/face/render.h"

#include <fmt/format.h>

#include <numbers>
#include <opencv2/imgproc.hpp>

#include "bench/rows.h"
#include "graph/random.h"
#include "nodes/face/composite.h"
#include "nodes/face/draw.h"
#include "nodes/face/geometry.h"
#include "nodes/face/sampling.h"

namespace talkgraph::bench {

constexpr int side = 300, modes = 40, frames = 200;

/// Rings of points in an ellipse, 60 in all, and modes of noise: what is drawn does not matter for the time.
AppearanceModel noise_model() {
  AppearanceModel m;
  m.mean_shape = Shape(60, 2);
  constexpr int rings[] = {26, 18, 11, 5};
  int i = 0;
  for (int ring = 0; ring < 4; ++ring)
    for (int k = 0; k < rings[ring]; ++k) {
      const double angle = 2 * std::numbers::pi * k / rings[ring], size = 1 - 0.24 * ring;
      m.mean_shape.row(i++) << 75.5 * size * std::cos(angle), 95.5 * size * std::sin(angle);
    }
  m.triangles = delaunay(m.mean_shape);
  FitLevel level;
  level.raster = make_raster(m.mean_shape, m.triangles, 1);
  Random random(1);
  const auto noise = [&](Eigen::Index rows, Eigen::Index columns) {
    Eigen::MatrixXf n(rows, columns);
    for (auto& v : n.reshaped()) v = static_cast<float>(random.uniform(-1, 1));
    return n;
  };
  const auto values = 3 * level.raster.size();
  level.mean = std::make_shared<Eigen::MatrixXf>(noise(values, 1));
  level.appearance = std::make_shared<Eigen::MatrixXf>(noise(values, modes));
  m.combined_variances = Eigen::VectorXd::Ones(modes);
  m.shape_per_mode = 0.3 * noise(120, modes).cast<double>();
  m.texture_offset = 128;
  m.texture_gain = 10;
  m.levels.push_back(std::move(level));
  return m;
}

/// What is drawn, in the middle of a picture.
void put(const cv::Mat& face, cv::Mat& picture) {
  picture.setTo(cv::Scalar::all(128));
  face.copyTo(picture(cv::Rect({(side - face.cols) / 2, (side - face.rows) / 2}, face.size())));
}

/// A matrix times a vector, the texture as a picture, `cv::remap` over the face's box.
void draw_plainly(const AppearanceModel& m, const Eigen::VectorXd& c, cv::Mat& picture) {
  const auto& raster = m.levels[0].raster;
  const Eigen::VectorXf texture = (m.texture(c) * static_cast<float>(m.texture_gain)).array() + 128.f;
  const Shape to = m.shape(c).rowwise() + Eigen::RowVector2d(80, 100);
  cv::Mat from, map = empty_map({160, 200}), out;
  raster_picture(raster, texture, cv::Scalar::all(128)).convertTo(from, CV_8UC3);
  draw_map(map, to, raster.points, m.triangles);
  cv::remap(from, out, map, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar::all(128));
  put(out, picture);
}

/// One picture for all frames, with the mean face in the middle.
BaseClip still_base(const AppearanceModel& m, const Track& track) {
  BaseClip base{
      video_from_frames(std::vector<cv::Mat>(frames, cv::Mat(side, side, CV_8UC3, cv::Scalar::all(90))), track.rate),
      {}};
  base.track.parameters = track;
  base.track.parameters.values.setZero();
  base.track.poses.assign(frames, {1, 0, 0.5 * side, 0.5 * side});
  base.track.gain.assign(frames, m.texture_gain);
  base.track.offset.assign(frames, m.texture_offset);
  base.track.residual.assign(frames, 0);
  base.track.lost.assign(frames, 0);
  return base;
}

void compare() {
  const AppearanceModel model = noise_model();
  Random random(2);
  Track track{Eigen::MatrixXd(frames, modes), Rational(25), 0.02, {}};
  for (auto& v : track.values.reshaped()) v = random.normal();
  const BaseClip base = still_base(model, track);
  cv::Mat picture(side, side, CV_8UC3);
  const auto composite = [&](Seam seam) {
    return own([&, seam] {
      CompositeFace node;
      node.seam = seam;
      const auto reader = node(model, track, base, nullptr, nullptr).source->open();
      while (reader->next(picture)) continue;
    });
  };
  std::vector<Row> rows = {
      {"a clip, frame by frame", own([&] {
         const auto reader = RenderFace{1, 128}(model, track, nullptr, nullptr).source->open();
         for (cv::Mat face; reader->next(face);) put(face, picture);
       })},
      {"single pictures", own([&] {
         for (Eigen::Index t = 0; t < frames; ++t) put(draw_face(model, track.values.row(t), 1, 128), picture);
       })},
      {"on a real picture, feathered", composite(Seam::feather)},
      {"on a real picture, Poisson", composite(Seam::poisson)},
      {"Eigen's product and `cv::remap`", own([&] {
         for (Eigen::Index t = 0; t < frames; ++t) draw_plainly(model, track.values.row(t), picture);
       })},
  };
  measure(rows);
  fmt::print("Processor time for a face of {} pixels and {} modes, median of {} (least to most):\n\n",
             model.levels[0].raster.size(), modes, rounds);
  fmt::print("| drawn | µs a picture |\n|---|---|\n");
  for (const auto& row : rows)
    fmt::print("| {} | {:.0f} ({:.0f} to {:.0f}) |\n", row.name, 1e6 / frames * row.median(),
               1e6 / frames * row.seen.front(), 1e6 / frames * row.seen.back());
}

}  // namespace talkgraph::bench

int main() {
  cv::setNumThreads(1);
  talkgraph::bench::compare();
}
