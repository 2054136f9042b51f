#include "nodes/face/reconstruct.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "nodes/face/draw.h"
#include "nodes/face/geometry.h"
#include "nodes/face/sampling.h"

namespace talkgraph {
namespace {

double psnr(const cv::Mat& a, const cv::Mat& b, const cv::Mat& mask) {
  const double values = 3.0 * std::max(1, cv::countNonZero(mask));
  const double error = cv::norm(a, b, cv::NORM_L2SQR, mask) / values;
  return std::min(100.0, 10 * std::log10(255 * 255 / std::max(error, 1e-12)));
}

}  // namespace

Reconstruction reconstruct(const AppearanceModel& model, const cv::Mat& picture, const Shape& landmarks) {
  if (landmarks.rows() != model.points())
    throw std::runtime_error(
        fmt::format("a picture has {} landmarks, the face model {}", landmarks.rows(), model.points()));
  if (!landmarks.allFinite()) throw std::runtime_error("a landmark is not a number");
  Reconstruction out;
  out.aligned = flatten(transform(align(landmarks, model.mean_shape), landmarks));
  Pyramid pyramid(picture);
  sample(pyramid, landmarks, model.triangles, model.levels[0].raster, out.texture);
  const auto light = normalise(out.texture);
  const auto shape_modes = model.shape_modes.cols(), texture_modes = model.texture_modes->cols();
  out.reduced.resize(shape_modes + texture_modes);
  out.reduced << model.shape_weight * (model.shape_modes.transpose() * (out.aligned - flatten(model.mean_shape))),
      (model.texture_modes->transpose() * (out.texture - model.levels[0].mean->col(0))).cast<double>();
  if (model.modes() > 0) out.c = model.combined_modes.transpose() * out.reduced;

  const Shape shape = model.shape(out.c);
  out.shape = transform(align(shape, landmarks), shape);
  const Eigen::VectorXf texture = model.texture(out.c);
  out.picture = picture.clone();
  const Eigen::VectorXf grey = (texture * static_cast<float>(light.gain)).array() + static_cast<float>(light.offset);
  const cv::Mat mask = draw_texture(model, grey, out.shape, out.picture);
  out.landmarks = std::sqrt((out.shape - landmarks).rowwise().squaredNorm().mean());
  out.texture_error =
      light.gain * static_cast<double>((texture - out.texture).norm()) / std::sqrt(static_cast<double>(texture.size()));
  out.psnr = psnr(out.picture, picture, mask);
  return out;
}

}  // namespace talkgraph
