#include "nodes/face/side_by_side.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace talkgraph {
namespace {

/// Widths of the two halves and their common height, all even, and the height of the labels above.
struct Layout {
  int left = 0, right = 0, height = 0, bar = 0;
};

Layout lay_out(cv::Size left, cv::Size right, bool labelled) {
  const auto even = [](double v) { return 2 * static_cast<int>(std::ceil(v / 2)); };
  Layout l;
  l.height = even(std::max(left.height, right.height));
  l.left = even(static_cast<double>(left.width) * l.height / left.height);
  l.right = even(static_cast<double>(right.width) * l.height / right.height);
  l.bar = labelled ? 24 : 0;
  return l;
}

void write_label(cv::Mat bar, const std::string& text) {
  if (bar.empty()) return;
  int base = 0;
  const auto size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, 0.5, 1, &base);
  cv::putText(bar, text, {std::max(2, (bar.cols - size.width) / 2), bar.rows - 8}, cv::FONT_HERSHEY_SIMPLEX, 0.5,
              cv::Scalar::all(255), 1, cv::LINE_AA);
}

struct Pair {
  Video left, right;
  SideBySide labels;
  Layout layout;
};

class PairReader final : public VideoSource::Reader {
 public:
  PairReader(std::shared_ptr<const Pair> pair, std::int64_t frames)
      : pair_(std::move(pair)),
        left_(pair_->left.source->open()),
        right_(pair_->right.source->open()),
        remaining_(frames) {}

  bool next(cv::Mat& frame) override {
    cv::Mat left, right;
    if (remaining_-- <= 0 || !left_->next(left) || !right_->next(right)) return false;
    const auto& l = pair_->layout;
    frame = cv::Mat(l.height + l.bar, l.left + l.right, CV_8UC3, cv::Scalar::all(32));
    place(frame, left, 0, l.left, pair_->labels.left_label);
    place(frame, right, l.left, l.right, pair_->labels.right_label);
    return true;
  }

 private:
  void place(cv::Mat& frame, const cv::Mat& picture, int x, int width, const std::string& label) const {
    cv::Mat scaled;
    cv::resize(picture, scaled, {width, pair_->layout.height}, 0, 0, cv::INTER_CUBIC);
    scaled.copyTo(frame(cv::Rect(x, pair_->layout.bar, width, pair_->layout.height)));
    write_label(frame(cv::Rect(x, 0, width, pair_->layout.bar)), label);
  }

  std::shared_ptr<const Pair> pair_;
  std::unique_ptr<VideoSource::Reader> left_, right_;
  std::int64_t remaining_;
};

class PairSource final : public VideoSource {
 public:
  explicit PairSource(std::shared_ptr<const Pair> pair) : pair_(std::move(pair)) {}
  Rational rate() const override { return pair_->left.source->rate(); }
  std::int64_t frames() const override { return std::min(pair_->left.source->frames(), pair_->right.source->frames()); }
  cv::Size size() const override {
    return {pair_->layout.left + pair_->layout.right, pair_->layout.height + pair_->layout.bar};
  }
  std::unique_ptr<Reader> open() const override { return std::make_unique<PairReader>(pair_, frames()); }
  std::string name() const override { return pair_->left.source->name() + " beside " + pair_->right.source->name(); }
  Key key() const override {
    return content_key([&](Archive& ar) {
      auto left = pair_->left.source->key(), right = pair_->right.source->key();
      auto labels = pair_->labels;
      ar("left", left);
      ar("right", right);
      ar("left_label", labels.left_label);
      ar("right_label", labels.right_label);
    });
  }

 private:
  std::shared_ptr<const Pair> pair_;
};

}  // namespace

Video SideBySide::operator()(const Video& left, const Video& right) const {
  if (!(left.source->rate() == right.source->rate()))
    throw std::runtime_error(left.source->name() + " has " + left.source->rate().str() + " frames per second, " +
                             right.source->name() + " has " + right.source->rate().str() +
                             ": they cannot run side by side");
  if (left.source->size().area() == 0 || right.source->size().area() == 0)
    throw std::runtime_error("a video without frames cannot stand beside another");
  const auto layout = lay_out(left.source->size(), right.source->size(), !left_label.empty() || !right_label.empty());
  return {std::make_shared<PairSource>(std::make_shared<Pair>(Pair{left, right, *this, layout})), {}};
}

void describe(Description<SideBySide>& d) {
  d.type("face.side_by_side").version(1).summary("two videos beside each other, labelled");
  d.input("left", "shown on the left")
      .input("right", "of the same rate, shown on the right")
      .output("video", "as long as the shorter");
  d.param("left_label", &SideBySide::left_label).doc("text above the left picture");
  d.param("right_label", &SideBySide::right_label).doc("text above the right picture");
}

}  // namespace talkgraph
