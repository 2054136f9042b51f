// What the face model costs and how near it comes: processor time of one core on drawn faces of 300 x 300 pixels.

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "bench/child.h"
#include "bench/drawn_face.h"
#include "bench/facemark.h"
#include "bench/rows.h"
#include "graph/random.h"
#include "nodes/face/build.h"
#include "nodes/face/draw.h"
#include "nodes/face/fit.h"
#include "nodes/face/geometry.h"
#include "nodes/face/track.h"

namespace talkgraph::bench {
namespace {

constexpr int trained_on = 184, tested_on = 60, tracked = 120;
constexpr double start_shift = 4.5, start_scale = 0.029, start_turn = 0.034;  // standard deviations

constexpr FitMethod methods[] = {FitMethod::fixed_jacobian, FitMethod::inverse_compositional};

std::string name_of(FitMethod method) {
  for (const auto& [value, name] : enum_names<FitMethod>.entries)
    if (value == method) return std::string(name);
  return {};
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Mean distance of the points.
double distance(const Shape& a, const Shape& b) { return (a - b).rowwise().norm().mean(); }

Prototypes training_faces() {
  Prototypes faces;
  faces.scheme = "drawn";
  for (int i = 0; i < trained_on; ++i) {
    const auto face = random_face(static_cast<std::uint64_t>(i));
    faces.images.push_back({draw(face)});
    faces.shapes.push_back(landmarks(face));
  }
  return faces;
}

struct Test {
  cv::Mat picture;
  Shape truth;
  Pose start;  ///< of the mean shape
};

std::vector<Test> tests(const Shape& mean) {
  Random random(7);
  std::vector<Test> all;
  for (int i = 0; i < tested_on; ++i) {
    const auto face = random_face(static_cast<std::uint64_t>(1000 + i));
    Test test{draw(face), landmarks(face), {}};
    test.start = align(mean, test.truth);
    test.start.dx += start_shift * random.normal();
    test.start.dy += start_shift * random.normal();
    test.start.scale *= std::exp(start_scale * random.normal());
    test.start.angle += start_turn * random.normal();
    all.push_back(std::move(test));
  }
  return all;
}

AppearanceModel build(const Prototypes& faces, double width) {
  Context context;
  BuildAppearance node;
  node.width = width;
  return node(faces, context);
}

/// A fit of all test pictures, each measured by itself.
struct Score {
  std::vector<double> error = std::vector<double>(tested_on), milliseconds = {};

  int close() const {
    return static_cast<int>(std::count_if(error.begin(), error.end(), [](double e) { return e < 3; }));
  }
};

template <class FitOne>
Score score(const std::vector<Test>& tests, const FitOne& fit_one) {
  Score s;
  for (std::size_t i = 0; i < tests.size(); ++i) {
    const double before = cpu_time();
    const Shape found = fit_one(tests[i]);
    s.milliseconds.push_back(1e3 * (cpu_time() - before));
    s.error[i] = distance(found, tests[i].truth);
  }
  return s;
}

void print(const std::string& name, const Score& s) {
  fmt::print("| {} | {:.2f} | {:.2f} | {} of {} |\n", name, median(s.milliseconds), median(s.error), s.close(),
             tested_on);
}

void compare_fits(const AppearanceModel& model, const std::vector<Test>& tests, FitPeer* peer) {
  std::vector<double> off;
  for (const auto& test : tests) off.push_back(distance(transform(test.start, model.mean_shape), test.truth));
  fmt::print(
      "\nFit of one picture that starts {:.1f} px off (median of {}): processor time, median distance of the "
      "points, fits within 3 px\n\n| fit | ms | px | within 3 px |\n|---|---|---|---|\n",
      median(off), tested_on);
  for (const auto method : methods) {
    Fitter fitter(model, method);
    print(name_of(method), score(tests, [&](const Test& test) {
            Pyramid pyramid(test.picture);
            Fit start;
            start.c = Eigen::VectorXd::Zero(model.modes());
            start.pose = test.start;
            const Fit found = fitter.coarse_to_fine(pyramid, start, {.reach = TrackFace{}.reach});
            return transform(found.pose, model.shape(found.c));
          }));
  }
  if (peer)
    print("OpenCV's `FacemarkAAM`", score(tests, [&](const Test& test) {
            return peer->fit(test.picture, compose(test.start, align(peer->mean(), model.mean_shape)));
          }));
}

void compare_tracking(const AppearanceModel& model) {
  std::vector<cv::Mat> frames;
  for (int t = 0; t < tracked; ++t) frames.push_back(draw(speaking_face(t)));
  const auto video = video_from_frames(frames, Rational(25));
  fmt::print(
      "\nA clip of {} frames followed, the search in its first frame included: processor time of a frame, median "
      "distance of the points\n\n| track | ms | px | lost |\n|---|---|---|---|\n",
      tracked);
  for (const auto method : methods) {
    Context context;
    TrackFace node;
    node.fitter = method;
    const double before = cpu_time();
    const auto track = node(model, video, context);
    const double used = cpu_time() - before;
    std::vector<double> error;
    for (int t = 0; t < tracked; ++t)
      error.push_back(distance(track.shapes[static_cast<std::size_t>(t)], landmarks(speaking_face(t))));
    fmt::print("| {} | {:.2f} | {:.2f} | {} |\n", name_of(method), 1e3 * used / tracked, median(error),
               std::count(track.lost.begin(), track.lost.end(), 1));
  }
}

void compare_warps(const Prototypes& faces) {
  const auto model = build(faces, drawn_size);
  const auto& raster = model.levels[0].raster;
  Pyramid pyramid(faces.images[0].pixels);
  const Sampler sampler(raster, model.triangles);
  Eigen::VectorXf texture;
  cv::Mat map = empty_map({raster.width, raster.height}), warped;
  draw_map(map, raster.points, faces.shapes[0], model.triangles);
  const cv::Mat picture = pyramid.level(0);
  constexpr int times = 200;
  std::vector<Row> rows = {
      {fmt::format("`Sampler`, {} pixels", raster.size()), own([&] {
         for (int i = 0; i < times; ++i) sampler(pyramid, faces.shapes[0], texture);
       })},
      {fmt::format("`cv::remap` of floats, box of {}", raster.width * raster.height), own([&] {
         for (int i = 0; i < times; ++i) cv::remap(picture, warped, map, cv::noArray(), cv::INTER_LINEAR);
       })},
      {fmt::format("`cv::remap` of bytes, box of {}", raster.width * raster.height), own([&] {
         for (int i = 0; i < times; ++i)
           cv::remap(faces.images[0].pixels, warped, map, cv::noArray(), cv::INTER_LINEAR);
       })},
  };
  measure(rows);
  fmt::print("\n| warp | µs |\n|---|---|\n");
  for (const auto& row : rows)
    fmt::print("| {} | {:.0f} ({:.0f} to {:.0f}) |\n", row.name, 1e6 * row.median() / times,
               1e6 * row.seen.front() / times, 1e6 * row.seen.back() / times);
}

void compare() {
  cv::setNumThreads(1);
  const auto faces = training_faces();
  AppearanceModel model;
  std::unique_ptr<FitPeer> peer;
  const auto build_own = own([&] { model = build(faces, BuildAppearance{}.width); });
  const auto build_peer = own([&] { peer = facemark(faces); });
  fmt::print("Processor time for {} pictures of {} x {} pixels with {} points\n\n| build | s |\n|---|---|\n",
             trained_on, drawn_size, drawn_size, drawn_points);
  fmt::print("| `face.build` | {:.2f} |\n", build_own());
  if (const double used = build_peer(); peer) fmt::print("| OpenCV's `FacemarkAAM` | {:.2f} |\n", used);
  compare_fits(model, tests(model.mean_shape), peer.get());
  compare_tracking(model);
  compare_warps(faces);
  if (!peer) fmt::print("\nOpenCV's FacemarkAAM was not measured: its library is missing.\n");
}

}  // namespace
}  // namespace talkgraph::bench

int main() {
  try {
    talkgraph::bench::compare();
  } catch (const std::exception& e) {
    fmt::print(stderr, "bench_face: {}\n", e.what());
    return 1;
  }
}
