#include "nodes/face/modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "nodes/face/render.h"
#include "nodes/types/picture_file.h"

namespace talkgraph {
namespace {

constexpr int bar_height = 22, margin = 40;

/// What is varied: faces of parameters `origin` + deviations · a column of `directions`.
struct Variation {
  AppearanceModel model;
  Eigen::VectorXd origin;
  Eigen::MatrixXd directions;
  std::string title;
};

Variation along_axes(AppearanceModel model, std::string title) {
  const auto count = model.modes();
  Eigen::MatrixXd directions = model.combined_variances.cwiseSqrt().asDiagonal();
  return {std::move(model), Eigen::VectorXd::Zero(count), std::move(directions), std::move(title)};
}

SharedMatrix share(Eigen::MatrixXf matrix) { return std::make_shared<const Eigen::MatrixXf>(std::move(matrix)); }

/// The model driven by its shape parameters alone.
Variation of_shape(AppearanceModel model) {
  model.shape_per_mode = model.shape_modes;
  model.combined_variances = model.shape_variances;
  model.levels[0].appearance = share(Eigen::MatrixXf::Zero(model.texture_modes->rows(), model.modes()));
  return along_axes(std::move(model), "modes of shape");
}

/// The model driven by its texture parameters alone.
Variation of_texture(AppearanceModel model) {
  model.combined_variances = model.texture_variances;
  model.shape_per_mode = Eigen::MatrixXd::Zero(2 * model.points(), model.modes());
  model.levels[0].appearance = model.texture_modes;
  return along_axes(std::move(model), "modes of texture");
}

Variation of_components(const AppearanceModel& model, const IndependentComponents& components) {
  if (components.dimension() != model.modes())
    throw std::runtime_error(
        fmt::format("the independent components are of {} appearance parameters, the face model has {}: they were "
                    "learnt with another model",
                    components.dimension(), model.modes()));
  return {model, components.mean.transpose(), components.mixing, "independent components"};
}

Variation variation(const AppearanceModel& model, ModeKind of, const IndependentComponents* components) {
  if (components && of != ModeKind::combined)
    throw std::runtime_error("independent components are of the combined parameters: leave \"of\" at combined");
  if (components) return of_components(model, *components);
  switch (of) {
    case ModeKind::shape:
      return of_shape(model);
    case ModeKind::texture:
      return of_texture(model);
    default:
      return along_axes(model, "modes of the face model");
  }
}

void write(cv::Mat& sheet, const std::string& text, cv::Point at) {
  cv::putText(sheet, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.5, {}, 1, cv::LINE_AA);
}

}  // namespace

Artifact FaceModes::operator()(const AppearanceModel& model, const IndependentComponents* components,
                               Context& context) const {
  const auto varied = variation(model, of, components);
  const auto count = varied.directions.cols();
  const auto rows = std::max<Eigen::Index>(1, std::min<Eigen::Index>(modes, count));
  const auto face = [&](Eigen::Index mode, double steps) {
    Eigen::VectorXd c = varied.origin;
    if (mode < count) c += steps * varied.directions.col(mode);
    return draw_face(varied.model, c, zoom, 255);
  };
  const cv::Size size = face(0, 0).size();
  const int columns = std::min(across, static_cast<int>(rows)),
            lines = (static_cast<int>(rows) + columns - 1) / columns;
  const int block = margin + 5 * size.width;
  cv::Mat sheet(bar_height + lines * size.height, columns * block, CV_8UC3, cv::Scalar::all(255));
  for (int mode = 0; mode < rows; ++mode) {
    const cv::Point corner(mode / lines * block, bar_height + mode % lines * size.height);
    write(sheet, std::to_string(mode + 1), corner + cv::Point(10, size.height / 2));
    for (int i = 0; i < 5; ++i) {
      const double steps = deviations * (i - 2) / 2;
      const cv::Point at = corner + cv::Point(margin + i * size.width, 0);
      face(mode, steps).copyTo(sheet(cv::Rect(at, size)));
      if (mode % lines == 0)
        write(sheet, i == 2 ? "mean" : fmt::format("{:+g} sd", steps), at + cv::Point(size.width / 2 - 20, -6));
    }
  }
  const Artifact artifact{name + ".png", varied.title};
  write_picture(context.file(artifact.path), sheet);
  return artifact;
}

void describe(Description<FaceModes>& d) {
  d.type("face.modes")
      .version(2)
      .summary("the modes of variation of a face model, or its independent components, as a picture")
      .source("Thesis Appendices B and C")
      .sink();
  d.input("model", "of the face")
      .input("components", "of its parameters, by normalise.ica, to be shown instead of the modes")
      .output("picture", "a PNG file");
  d.param("of", &FaceModes::of).doc("modes of shape and texture together, of shape alone, or of texture alone");
  d.param("modes", &FaceModes::modes).at_least(1).doc("rows: the modes of the largest variance");
  d.param("across", &FaceModes::across).at_least(1).doc("modes beside each other");
  d.param("deviations", &FaceModes::deviations).positive().doc("standard deviations shown each way");
  d.param("zoom", &FaceModes::zoom).within(0.1, 20).doc("pixels per pixel of the mean shape");
  d.param("name", &FaceModes::name).doc("of the file below the run folder, without .png");
}

}  // namespace talkgraph
