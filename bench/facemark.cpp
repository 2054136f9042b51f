#include "bench/facemark.h"

#include <cmath>
#include <opencv2/face.hpp>
#include <stdexcept>

namespace talkgraph::bench {
namespace {

std::vector<cv::Point2f> points(const Shape& shape) {
  std::vector<cv::Point2f> out;
  for (const auto& row : shape.rowwise()) out.emplace_back(static_cast<float>(row(0)), static_cast<float>(row(1)));
  return out;
}

Shape shape(const std::vector<cv::Point2f>& points) {
  Shape out(points.size(), 2);
  for (std::size_t i = 0; i < points.size(); ++i) out.row(static_cast<Eigen::Index>(i)) << points[i].x, points[i].y;
  return out;
}

}  // namespace

struct Facemark::Peer {
  cv::Ptr<cv::face::FacemarkAAM> model;
};

Facemark::Facemark(const Prototypes& faces) : peer_(std::make_unique<Peer>()) {
  cv::face::FacemarkAAM::Params settings;
  settings.verbose = settings.save_model = false;
  peer_->model = cv::face::FacemarkAAM::create(settings);
  for (std::size_t i = 0; i < faces.shapes.size(); ++i)
    peer_->model->addTrainingSample(faces.images[i].pixels, points(faces.shapes[i]));
  peer_->model->training();
  cv::face::FacemarkAAM::Data data;
  peer_->model->getData(&data);
  mean_ = shape(data.s0);
}

Facemark::~Facemark() = default;

Shape Facemark::fit(const cv::Mat& picture, const Pose& start) {
  const auto c = static_cast<float>(std::cos(start.angle)), s = static_cast<float>(std::sin(start.angle));
  const std::vector<cv::face::FacemarkAAM::Config> starts = {
      {(cv::Mat_<float>(2, 2) << c, -s, s, c), cv::Point2f(static_cast<float>(start.dx), static_cast<float>(start.dy)),
       static_cast<float>(start.scale), 0}};
  std::vector<cv::Mat> found;  // into vectors of points it writes what is no result
  const std::vector<cv::Rect> faces = {cv::Rect({}, picture.size())};
  if (!peer_->model->fitConfig(picture, faces, found, starts)) throw std::runtime_error("FacemarkAAM found no face");
  std::vector<cv::Point2f> places;
  found.at(0).copyTo(places);
  return shape(places);
}

}  // namespace talkgraph::bench
