#pragma once

#include <filesystem>
#include <opencv2/core.hpp>

namespace talkgraph {

/// 8-bit BGR. Throws std::runtime_error that names the file: not there, not a picture.
cv::Mat read_picture(const std::filesystem::path& file);

/// Writes 8-bit BGR as PNG or JPEG, by the ending, whole or not at all. Throws std::runtime_error that names the file.
void write_picture(const std::filesystem::path& file, const cv::Mat& pixels);

}  // namespace talkgraph
