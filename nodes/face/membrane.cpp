#include "nodes/face/membrane.h"

#include <array>
#include <vector>

namespace talkgraph {
namespace {

constexpr std::array<std::pair<int, int>, 4> steps{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

bool holds(const cv::Mat& region, cv::Point at) {
  return cv::Rect({}, region.size()).contains(at) && region.at<unsigned char>(at);
}

}  // namespace

Membrane::Membrane(const cv::Mat& region)
    : solver_(std::make_shared<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>>()) {
  cv::Mat number(region.size(), CV_32S, cv::Scalar(-1));  // of a pixel among its kind
  cv::Mat is_inner(region.size(), CV_8U, cv::Scalar(0));
  for (int y = 0; y < region.rows; ++y)
    for (int x = 0; x < region.cols; ++x) {
      const cv::Point at(x, y);
      if (!holds(region, at)) continue;
      const bool inner = std::all_of(steps.begin(), steps.end(), [&](const auto& s) {
        return holds(region, {x + s.first, y + s.second});
      });
      auto& list = inner ? inner_ : border_;
      number.at<int>(at) = static_cast<int>(list.size());
      is_inner.at<unsigned char>(at) = inner;
      list.push_back(at);
    }
  std::vector<Eigen::Triplet<double>> among, across;
  for (int i = 0; i < static_cast<int>(inner_.size()); ++i) {
    among.emplace_back(i, i, 4);
    for (const auto& [dx, dy] : steps) {
      const cv::Point beside = inner_[static_cast<std::size_t>(i)] + cv::Point(dx, dy);
      const int j = number.at<int>(beside);
      if (is_inner.at<unsigned char>(beside))
        among.emplace_back(i, j, -1);
      else
        across.emplace_back(i, j, 1);
    }
  }
  const auto inner = static_cast<Eigen::Index>(inner_.size());
  Eigen::SparseMatrix<double> laplacian(inner, inner);
  laplacian.setFromTriplets(among.begin(), among.end());
  from_border_.resize(inner, static_cast<Eigen::Index>(border_.size()));
  from_border_.setFromTriplets(across.begin(), across.end());
  if (inner > 0) solver_->compute(laplacian);
}

cv::Mat Membrane::operator()(const cv::Mat& values) const {
  cv::Mat field(values.size(), CV_32FC3, cv::Scalar::all(0));
  Eigen::MatrixXd given(border_.size(), 3);
  for (std::size_t i = 0; i < border_.size(); ++i) {
    const auto& value = field.at<cv::Vec3f>(border_[i]) = values.at<cv::Vec3f>(border_[i]);
    given.row(static_cast<Eigen::Index>(i)) << value[0], value[1], value[2];
  }
  if (inner_.empty()) return field;
  const Eigen::MatrixXf solved = solver_->solve(from_border_ * given).cast<float>();
  for (std::size_t i = 0; i < inner_.size(); ++i) {
    const auto row = solved.row(static_cast<Eigen::Index>(i));
    field.at<cv::Vec3f>(inner_[i]) = {row(0), row(1), row(2)};
  }
  return field;
}

}  // namespace talkgraph
