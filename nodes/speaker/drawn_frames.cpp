#include "nodes/speaker/drawn_frames.h"

namespace talkgraph::face {
namespace {

std::size_t size_of(const cv::Mat& frame) { return frame.total() * frame.elemSize(); }

}  // namespace

cv::Mat DrawnFrames::find(const Name& name) {
  const std::scoped_lock lock(mutex_);
  const auto at = frames_.find(name);
  return at == frames_.end() ? cv::Mat() : at->second.clone();
}

void DrawnFrames::keep(const Name& name, const cv::Mat& frame) {
  cv::Mat copy = frame.clone();
  const std::scoped_lock lock(mutex_);
  if (!frames_.emplace(name, copy).second) return;
  oldest_first_.push_back(name);
  for (bytes_ += size_of(copy); bytes_ > limit_; oldest_first_.pop_front()) {
    const auto oldest = frames_.find(oldest_first_.front());
    bytes_ -= size_of(oldest->second);
    frames_.erase(oldest);
  }
}

}  // namespace talkgraph::face
