#include <opencv2/imgcodecs.hpp>

#include "nodes/codecs/codecs.h"

void codec_read_picture(const std::string& file, cv::Mat& pixels) { pixels = cv::imread(file, cv::IMREAD_COLOR); }

void codec_decode_picture(const std::vector<std::uint8_t>& bytes, cv::Mat& pixels) {
  pixels = cv::imdecode(bytes, cv::IMREAD_COLOR);
}

bool codec_write_picture(const std::string& file, const cv::Mat& pixels) {
  try {
    return cv::imwrite(file, pixels);
  } catch (const cv::Exception&) {
    return false;
  }
}

void codec_encode_png(const cv::Mat& pixels, std::vector<std::uint8_t>& bytes) { cv::imencode(".png", pixels, bytes); }
