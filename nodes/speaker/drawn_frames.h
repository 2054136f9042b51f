#pragma once

#include <deque>
#include <map>
#include <mutex>
#include <opencv2/core.hpp>
#include <utility>

#include "graph/key.h"

namespace talkgraph::face {

/// The frames drawn last, up to so many bytes: all methods of a comparison read the same few clips. For many threads.
class DrawnFrames {
 public:
  explicit DrawnFrames(std::size_t bytes) : limit_(bytes) {}

  /// A copy of frame t of a clip, drawn if it is not kept.
  template <class Draw>
  cv::Mat frame(const Key& clip, std::size_t t, const Draw& draw) {
    const Name name{clip, t};
    if (cv::Mat kept = find(name); !kept.empty()) return kept;
    cv::Mat drawn = draw();
    keep(name, drawn);
    return drawn;
  }

 private:
  using Name = std::pair<Key, std::size_t>;

  cv::Mat find(const Name& name);
  void keep(const Name& name, const cv::Mat& frame);

  std::size_t limit_, bytes_ = 0;
  std::mutex mutex_;
  std::map<Name, cv::Mat> frames_;
  std::deque<Name> oldest_first_;
};

}  // namespace talkgraph::face
