#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "nodes/types/audio.h"
#include "nodes/types/video.h"
#include "tests/temporary_folder.h"

namespace talkgraph {

/// A test with a folder of its own.
class MediaTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return temporary_.file(name); }
  std::string write(const std::string& name, const std::string& bytes) const { return temporary_.write(name, bytes); }
  static std::string bytes(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  const test::TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path();
};

inline std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& e) {
    return e.what();
  }
  return "no error";
}

/// A smooth picture with a bright square that moves with n.
inline cv::Mat test_picture(int n, cv::Size size = {96, 64}) {
  cv::Mat picture(size, CV_8UC3);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      picture.at<cv::Vec3b>(y, x) =
          cv::Vec3b(static_cast<unsigned char>(60 + x), static_cast<unsigned char>(60 + y), 120);
  cv::rectangle(picture, {4 + n % 40, 20, 16, 16}, {200, 220, 240}, cv::FILLED);
  return picture;
}

inline Video test_video(int frames, Rational rate, cv::Size size = {96, 64}) {
  std::vector<cv::Mat> pictures;
  for (int n = 0; n < frames; ++n) pictures.push_back(test_picture(n, size));
  return video_from_frames(pictures, rate);
}

inline Audio tone(double seconds, double rate, double hertz = 440) {
  Audio audio;
  audio.rate = rate;
  audio.samples.resize(std::llround(seconds * rate));
  for (Eigen::Index i = 0; i < audio.samples.size(); ++i)
    audio.samples[i] = 0.5 * std::sin(2 * M_PI * hertz * static_cast<double>(i) / rate);
  return audio;
}

inline double mean_difference(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total() * 3);
}

}  // namespace talkgraph
