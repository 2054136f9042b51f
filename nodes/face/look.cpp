#include "nodes/face/look.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "nodes/face/draw.h"
#include "nodes/face/eyes.h"
#include "nodes/face/geometry.h"
#include "nodes/face/shapes.h"

namespace talkgraph {
namespace {

/// Of a mouth's colours, below which its detail begins: share of the box's width, standard deviation.
constexpr double coarseness = 0.1;

void check_finite(const Track& parameters) {
  if (!parameters.values.allFinite())
    throw std::runtime_error("the appearance parameters hold a value that is not a number");
}

void check_length(const char* what, std::size_t length, const Track& parameters) {
  if (static_cast<Eigen::Index>(length) != parameters.frames())
    throw std::runtime_error(
        fmt::format("the {} are of {} frames, the appearance parameters of {}", what, length, parameters.frames()));
}

}  // namespace

Shape with_points(const Shape& shape, const Shape& other, const Eigen::VectorXd& which) {
  if (which.sum() == 0) return shape;
  return shape + which.asDiagonal() * (transform(align(other, shape, which), other) - shape);
}

Looks::Looks(AppearanceModel model, Track parameters, const Eyes* eyes, const MouthTrack* mouths)
    : model_(std::move(model)), parameters_(std::move(parameters)) {
  check_dimension(model_, parameters_);
  check_finite(parameters_);
  const auto& raster = model_.levels.at(0).raster;
  eye_points_ = Eigen::VectorXd::Zero(model_.points());
  eye_share_ = cv::Mat(raster.height, raster.width, CV_32F, cv::Scalar(0));
  mouth_.share = eye_share_.clone();
  if (eyes && !eyes->points.empty()) eyes_ = *eyes, prepare_eyes();
  if (mouths && !mouths->chosen.empty()) mouths_ = *mouths, prepare_mouths();
}

void Looks::prepare_eyes() {
  check_dimension(model_, eyes_.parameters);
  check_finite(eyes_.parameters);
  check_length("eyes", static_cast<std::size_t>(eyes_.parameters.frames()), parameters_);
  const auto& raster = model_.levels[0].raster;
  for (const auto* points : {&eyes_.points, &eyes_.nose})
    for (const int i : *points) {
      if (i < 0 || i >= model_.points())
        throw std::runtime_error(
            fmt::format("the face model has {} points and so no point {}: name those of the eyes", model_.points(), i));
      eye_points_(i) = 1;
    }
  const auto [top, bottom, fade] = eye_band(raster.points, eyes_.points);
  for (std::size_t i = 0; i < raster.x.size(); ++i)
    eye_share_.at<float>(raster.y[i], raster.x[i]) = static_cast<float>(
        smooth_step(top - fade, top, raster.y[i]) * (1 - smooth_step(bottom, bottom + fade, raster.y[i])));
}

void Looks::prepare_mouths() {
  check_length("mouths", mouths_.chosen.size(), parameters_);
  mouth_ = mouth_region(model_, mouths_.mouths.points, mouths_.mouths.margin);
  check_mouths(model_, mouth_, mouths_.mouths);
  for (const auto i : mouths_.chosen)
    if (i < 0 || i >= mouths_.mouths.size())
      throw std::runtime_error(fmt::format("mouth {} is to be shown, of {}", i, mouths_.mouths.size()));
  mouth_modes_ = mouth_texture_modes(model_, mouth_);
}

Look Looks::at(Eigen::Index t) const {
  std::vector<Look> one(1);
  Eigen::MatrixXf textures;
  fill(t, one, textures);
  return std::move(one[0]);
}

void Looks::fill(Eigen::Index first, std::vector<Look>& looks, Eigen::MatrixXf& textures) const {
  const auto& level = model_.levels[0];
  const auto count = static_cast<Eigen::Index>(looks.size());
  textures.resize(level.mean->rows(), count);
  for (auto texture : textures.colwise()) texture = level.mean->col(0);
  textures.noalias() += *level.appearance * parameters_.values.middleRows(first, count).transpose().cast<float>();
  for (Eigen::Index i = 0; i < count; ++i) {
    Look& look = looks[static_cast<std::size_t>(i)];
    look.shape = model_.shape(parameters_.values.row(first + i));
    look.texture = textures.col(i);
    if (!eyes_.points.empty()) put_eyes(look, first + i);
    if (!mouths_.chosen.empty()) put_mouth(look, first + i);
  }
}

void Looks::put_eyes(Look& look, Eigen::Index t) const {
  const Eigen::VectorXd c = eyes_.parameters.values.row(t);
  look.shape = with_points(look.shape, model_.shape(c), eye_points_);
  const Eigen::VectorXf texture = model_.texture(c);
  const auto& raster = model_.levels[0].raster;
  for (std::size_t i = 0; i < raster.x.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    const float share = eye_share_.at<float>(raster.y[i], raster.x[i]);
    if (share > 0) look.texture.segment<3>(at) += share * (texture.segment<3>(at) - look.texture.segment<3>(at));
  }
}

/// A real mouth, whose coarse colours are brought to those that the model wants: its detail remains.
void Looks::put_mouth(Look& look, Eigen::Index t) const {
  const auto& raster = model_.levels[0].raster;
  const auto which = mouths_.chosen[static_cast<std::size_t>(t)];
  const auto& picture = mouths_.mouths.pictures[static_cast<std::size_t>(which)].pixels;
  const auto step = (parameters_.values.row(t) - mouths_.mouths.parameters.row(which)).transpose().cast<float>().eval();
  const Eigen::VectorXf change = mouth_modes_ * step;
  cv::Mat coarse(mouth_.box.size(), CV_32FC3, cv::Scalar::all(0));
  const auto place = [&](Eigen::Index i) {
    return cv::Point(raster.x[static_cast<std::size_t>(i)], raster.y[static_cast<std::size_t>(i)]);
  };
  Eigen::Index row = 0;
  for (const auto i : mouth_.pixels) {
    const auto value = change.segment<3>(3 * row++);
    coarse.at<cv::Vec3f>(place(i) - mouth_.box.tl()) = {value(0), value(1), value(2)};
  }
  cv::GaussianBlur(coarse, coarse, {}, coarseness * mouth_.box.width, 0, cv::BORDER_REPLICATE);
  const float gain = static_cast<float>(1 / model_.texture_gain), offset = static_cast<float>(model_.texture_offset);
  for (const auto i : mouth_.pixels) {
    const float share = mouth_.share.at<float>(place(i));
    const auto& real = picture.at<cv::Vec3b>(place(i) - mouth_.box.tl());
    const auto& shift = coarse.at<cv::Vec3f>(place(i) - mouth_.box.tl());
    for (int k = 0; k < 3; ++k) {
      float& value = look.texture(3 * i + k);
      value += share * ((static_cast<float>(real[k]) - offset) * gain + shift[k] - value);
    }
  }
}

void Looks::hash(Archive& ar) const {
  auto model = model_;
  auto parameters = parameters_;
  auto eyes = eyes_;
  auto mouths = mouths_;
  ar("model", model);
  ar("parameters", parameters);
  ar("eyes", eyes);
  ar("mouths", mouths);
}

const Look* LookReader::next() {
  constexpr Eigen::Index block = 64;
  if (at_ == looks_->parameters().frames()) return nullptr;
  if (at_ == first_ + static_cast<Eigen::Index>(block_.size())) {
    first_ = at_;
    block_.resize(static_cast<std::size_t>(std::min(block, looks_->parameters().frames() - first_)));
    looks_->fill(first_, block_, textures_);
  }
  return &block_[static_cast<std::size_t>(at_++ - first_)];
}

}  // namespace talkgraph
