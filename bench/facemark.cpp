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

class Facemark final : public FitPeer {
 public:
  explicit Facemark(const Prototypes& faces) {
    cv::face::FacemarkAAM::Params settings;
    settings.verbose = settings.save_model = false;
    model_ = cv::face::FacemarkAAM::create(settings);
    for (std::size_t i = 0; i < faces.shapes.size(); ++i)
      model_->addTrainingSample(faces.images[i].pixels, points(faces.shapes[i]));
    model_->training();
  }

  Shape mean() const override {
    cv::face::FacemarkAAM::Data data;
    model_->getData(&data);
    return shape(data.s0);
  }

  Shape fit(const cv::Mat& picture, const Pose& start) override {
    const auto c = static_cast<float>(std::cos(start.angle)), s = static_cast<float>(std::sin(start.angle));
    const std::vector<cv::face::FacemarkAAM::Config> starts = {
        {(cv::Mat_<float>(2, 2) << c, -s, s, c),
         cv::Point2f(static_cast<float>(start.dx), static_cast<float>(start.dy)), static_cast<float>(start.scale), 0}};
    const std::vector<cv::Rect> faces = {cv::Rect({}, picture.size())};
    std::vector<cv::Mat> found;  // a vector of vectors of points would hold no result
    if (!model_->fitConfig(picture, faces, found, starts)) throw std::runtime_error("FacemarkAAM found no face");
    std::vector<cv::Point2f> places;
    found.at(0).copyTo(places);
    return shape(places);
  }

 private:
  cv::Ptr<cv::face::FacemarkAAM> model_;
};

}  // namespace

std::unique_ptr<FitPeer> facemark(const Prototypes& faces) { return std::make_unique<Facemark>(faces); }

}  // namespace talkgraph::bench
