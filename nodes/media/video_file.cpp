#include "nodes/media/video_file.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <stdexcept>

#include "graph/key.h"
#include "nodes/media/ffmpeg.h"
#include "nodes/types/picture_file.h"

namespace talkgraph {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Takes the number at `at` off `text`, without leading zeros.
std::string take_number(const std::string& text, std::size_t& at) {
  while (at < text.size() && text[at] == '0') ++at;
  const std::size_t from = at;
  while (at < text.size() && is_digit(text[at])) ++at;
  return text.substr(from, at - from);
}

class FolderVideo final : public VideoSource {
 public:
  FolderVideo(std::string folder, std::vector<std::string> files, Rational rate)
      : folder_(std::move(folder)), files_(std::move(files)), rate_(rate), size_(read_picture(files_[0]).size()) {}

  Rational rate() const override { return rate_; }
  std::int64_t frames() const override { return static_cast<std::int64_t>(files_.size()); }
  cv::Size size() const override { return size_; }
  std::string name() const override { return folder_; }
  Key key() const override {
    KeyMaker maker;
    maker.add(rate_.str());
    for (const auto& file : files_) maker.add(file_key(file));
    return maker.key();
  }
  std::unique_ptr<Reader> open() const override { return std::make_unique<FolderReader>(files_, size_); }

 private:
  class FolderReader final : public Reader {
   public:
    FolderReader(std::vector<std::string> files, cv::Size size) : files_(std::move(files)), size_(size) {}
    bool next(cv::Mat& frame) override {
      if (at_ == files_.size()) return false;
      const std::string& file = files_[at_++];
      frame = read_picture(file);
      if (frame.size() != size_) throw std::runtime_error(file + ": differs in size from the first picture");
      return true;
    }

   private:
    std::vector<std::string> files_;
    cv::Size size_;
    std::size_t at_ = 0;
  };

  std::string folder_;
  std::vector<std::string> files_;
  Rational rate_;
  cv::Size size_;
};

}  // namespace

bool natural_less(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string x = take_number(a, i), y = take_number(b, j);
      if (x != y) return x.size() != y.size() ? x.size() < y.size() : x < y;
    } else if (a[i] != b[j]) {
      return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
    } else {
      ++i, ++j;
    }
  }
  if ((i == a.size()) != (j == b.size())) return i == a.size();
  return a < b;
}

bool is_picture_name(const std::string& name) {
  std::string ending = fs::path(name).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending == ".png" || ending == ".jpg" || ending == ".jpeg";
}

Video open_video(const std::string& path) {
  if (!fs::exists(path)) throw std::runtime_error(path + ": there is no such file");
  if (!fs::is_regular_file(path)) throw std::runtime_error(path + ": is not a file");
  return {ffmpeg_video(path), {}};
}

Video open_frame_folder(const std::string& folder, Rational rate) {
  if (!fs::is_directory(folder)) throw std::runtime_error(folder + ": there is no such folder");
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && is_picture_name(entry.path().filename().string()))
      files.push_back(entry.path().string());
  if (files.empty()) throw std::runtime_error(folder + ": there is no PNG or JPEG picture in this folder");
  std::sort(files.begin(), files.end(), natural_less);
  return {std::make_shared<FolderVideo>(folder, std::move(files), rate), {}};
}

}  // namespace talkgraph
