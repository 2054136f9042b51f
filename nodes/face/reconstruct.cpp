#include "nodes/face/reconstruct.h"

#include <fmt/format.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "nodes/face/draw.h"
#include "nodes/face/geometry.h"
#include "nodes/face/sampling.h"

namespace talkgraph {
namespace {

/// The raster with its face; pixels around the face have the mean of their neighbours inside it.
cv::Mat padded(const Raster& raster, const Eigen::VectorXf& texture) {
  const cv::Mat picture = raster_picture(raster, texture),
                inside = raster_picture(raster, Eigen::VectorXf::Ones(texture.size()));
  cv::Mat sum, weight, around, mask;
  cv::boxFilter(picture, sum, CV_32F, {5, 5});
  cv::boxFilter(inside, weight, CV_32F, {5, 5});
  cv::divide(sum, cv::max(weight, 1e-6), around);
  cv::extractChannel(inside, mask, 0);
  picture.copyTo(around, mask > 0);
  return around;
}

/// Draws a texture of grey levels into the picture; gives the mask of what was drawn.
cv::Mat draw(const AppearanceModel& model, const Eigen::VectorXf& texture, const Shape& shape, cv::Mat& picture) {
  const auto& raster = model.levels[0].raster;
  cv::Mat map = empty_map(picture.size()), face, mask;
  draw_map(map, shape, raster.points, model.triangles);
  cv::remap(padded(raster, texture), face, map, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  face.convertTo(face, CV_8UC3);
  cv::inRange(map, cv::Scalar(-50, -50), cv::Scalar(1e9, 1e9), mask);
  face.copyTo(picture, mask);
  return mask;
}

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
  const cv::Mat mask = draw(model, grey, out.shape, out.picture);
  out.landmarks = std::sqrt((out.shape - landmarks).rowwise().squaredNorm().mean());
  out.texture_error =
      light.gain * static_cast<double>((texture - out.texture).norm()) / std::sqrt(static_cast<double>(texture.size()));
  out.psnr = psnr(out.picture, picture, mask);
  return out;
}

}  // namespace talkgraph
