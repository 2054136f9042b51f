#include "nodes/media/check_video.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <set>

namespace talkgraph {
namespace {

constexpr int kColumns = 32;    ///< of the thumbnails that are compared
constexpr int kMedianOf = 101;  ///< frames that the median is taken over, evenly spread

std::vector<cv::Mat> thumbnails(const Video& video, const Context& context) {
  std::vector<cv::Mat> all;
  const auto reader = video.source->open();
  for (cv::Mat frame; reader->next(frame);) {
    context.check_cancelled();
    const int columns = std::min(kColumns, frame.cols);
    const int rows = std::clamp(frame.rows * columns / frame.cols, 1, frame.rows);
    cv::Mat small;
    cv::resize(frame, small, {columns, rows}, 0, 0, cv::INTER_AREA);
    all.push_back(small);
  }
  return all;
}

cv::Mat median(const std::vector<cv::Mat>& pictures) {
  const std::size_t n = std::min<std::size_t>(pictures.size(), kMedianOf);
  cv::Mat result = pictures.front().clone();
  std::vector<std::uint8_t> values(n);
  for (std::size_t i = 0; i < result.total() * 3; ++i) {
    for (std::size_t k = 0; k < n; ++k) values[k] = pictures[k * pictures.size() / n].data[i];
    std::nth_element(values.begin(), values.begin() + n / 2, values.end());
    result.data[i] = values[n / 2];
  }
  return result;
}

double strange_share(const cv::Mat& picture, const cv::Mat& usual, double level) {
  std::size_t strange = 0;
  for (std::size_t cell = 0; cell < picture.total(); ++cell) {
    int most = 0;
    for (std::size_t c = 0; c < 3; ++c)
      most = std::max(most, std::abs(picture.data[3 * cell + c] - usual.data[3 * cell + c]));
    strange += most > level;
  }
  return static_cast<double>(strange) / static_cast<double>(picture.total());
}

}  // namespace

std::vector<double> strangeness(const Video& video, double level, const Context& context) {
  const auto pictures = thumbnails(video, context);
  if (pictures.empty()) return {};
  const cv::Mat usual = median(pictures);
  std::vector<double> shares;
  for (const auto& picture : pictures) shares.push_back(strange_share(picture, usual, level));
  return shares;
}

Video CheckVideo::operator()(const Video& video, Context& context) const {
  const auto errors = video.source->decoding_errors();
  std::set<std::int64_t> damaged(video.damaged.begin(), video.damaged.end());
  damaged.insert(errors.begin(), errors.end());
  const auto shares = strangeness(video, level, context);
  if (shares.size() >= 3)
    for (std::size_t n = 0; n < shares.size(); ++n)
      if (shares[n] > area) damaged.insert(static_cast<std::int64_t>(n));
  if (!damaged.empty())
    context.warn(fmt::format("{}: {} of {} frames are damaged ({} to {})", video.source->name(), damaged.size(),
                             shares.size(), *damaged.begin(), *damaged.rbegin()));
  return {video.source, {damaged.begin(), damaged.end()}};
}

void describe(Description<CheckVideo>& d) {
  d.type("media.check_video").summary("marks damaged frames, which are then not learnt from");
  d.input("video", "read through once").output("video", "the same, with its damaged frames marked");
  d.param("level", &CheckVideo::level)
      .within(1, 255)
      .doc("difference from the median picture that counts, grey levels");
  d.param("area", &CheckVideo::area)
      .within(0, 1)
      .doc("share of the picture that must differ for a frame to be damaged");
}

}  // namespace talkgraph
