#include "nodes/face/mouth_region.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "nodes/face/draw.h"

namespace talkgraph {
namespace {

std::vector<cv::Point> hull(const Raster& raster, const std::vector<int>& points) {
  std::vector<cv::Point2f> around, corners;
  for (const int i : points) {
    if (i < 0 || i >= raster.points.rows())
      throw std::runtime_error(fmt::format(
          "the face model has {} points and so no point {}: name those around the mouth", raster.points.rows(), i));
    around.emplace_back(static_cast<float>(raster.points(i, 0)), static_cast<float>(raster.points(i, 1)));
  }
  if (!around.empty()) cv::convexHull(around, corners);
  if (corners.size() < 3 || cv::contourArea(corners) < 1)
    throw std::runtime_error("the points around the mouth span no area");
  return {corners.begin(), corners.end()};
}

}  // namespace

MouthRegion mouth_region(const AppearanceModel& model, const std::vector<int>& points, double margin) {
  const auto& raster = model.levels.at(0).raster;
  const auto corners = hull(raster, points);
  cv::Mat outside(raster.height, raster.width, CV_8U, cv::Scalar(255)), distance;
  cv::fillConvexPoly(outside, corners, 0);
  cv::distanceTransform(outside, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  const double reach = margin * cv::boundingRect(corners).width;
  MouthRegion region;
  region.share = cv::Mat(outside.size(), CV_32F, cv::Scalar(0));
  for (std::size_t i = 0; i < raster.x.size(); ++i) {
    const cv::Point at(raster.x[i], raster.y[i]);
    region.share.at<float>(at) = static_cast<float>(1 - smooth_step(0, reach, distance.at<float>(at)));
  }
  region.box = cv::boundingRect(region.share > 0);
  for (std::size_t i = 0; i < raster.x.size(); ++i)
    if (region.box.contains({raster.x[i], raster.y[i]})) region.pixels.push_back(static_cast<Eigen::Index>(i));
  return region;
}

void check_mouths(const AppearanceModel& model, const MouthRegion& region, const Mouths& mouths) {
  const auto fits = [&](const Image& picture) {
    return picture.pixels.type() == CV_8UC3 && picture.pixels.size() == region.box.size();
  };
  if (mouths.parameters.cols() != model.modes() || static_cast<Eigen::Index>(mouths.pictures.size()) != mouths.size() ||
      !std::all_of(mouths.pictures.begin(), mouths.pictures.end(), fits))
    throw std::runtime_error("the mouths were made with another face model");
}

Eigen::MatrixXf mouth_texture_modes(const AppearanceModel& model, const MouthRegion& region) {
  Eigen::MatrixXf modes(3 * region.pixels.size(), model.modes());
  Eigen::Index row = 0;
  for (const auto i : region.pixels) modes.middleRows<3>(3 * row++) = model.levels[0].appearance->middleRows<3>(3 * i);
  return modes;
}

Eigen::MatrixXd mouth_metric(const AppearanceModel& model, const MouthRegion& region, const std::vector<int>& points) {
  const Eigen::MatrixXd texture = mouth_texture_modes(model, region).cast<double>();
  Eigen::MatrixXd shape(2 * points.size(), model.modes());
  Eigen::Index row = 0;
  for (const int i : points) shape.middleRows<2>(2 * row++) = model.shape_per_mode.middleRows<2>(2 * i);
  shape *= model.shape_weight;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(texture.transpose() * texture + shape.transpose() * shape);
  return eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace talkgraph
