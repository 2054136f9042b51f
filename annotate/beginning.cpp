#include "annotate/beginning.h"

#include <algorithm>
#include <stdexcept>

#include "nodes/face/build.h"
#include "nodes/face/prototypes.h"
#include "nodes/face/track.h"
#include "nodes/types/phones.h"

namespace talkgraph::annotate {
namespace {

/// Each example as a clip of one frame.
AppearanceModel build(const std::vector<Example>& examples, const std::string& scheme, Context context) {
  Collected<Video> videos;
  Collected<LandmarkTrack> landmarks;
  Collected<FrameLabels> labels;
  for (std::size_t i = 0; i < examples.size(); ++i) {
    const auto key = std::to_string(i);
    videos.add(key, video_from_frames({examples[i].picture}, Rational(25)));
    landmarks.add(key, LandmarkTrack{{examples[i].points}, Rational(25), scheme});
    labels.add(key, FrameLabels{{"any"}, Rational(25)});
  }
  Random random;
  const ChoosePrototypes all{.per_phone = static_cast<int>(examples.size())};
  return BuildAppearance{}(all(videos, landmarks, labels, random, context), context);
}

/// A few examples leave much of a new picture unexplained: only what is no face at all is lost.
std::optional<Shape> fit(const AppearanceModel& model, const cv::Mat& picture, Context context) {
  TrackFace tracker;
  tracker.lost_above = 25;
  auto track = tracker(model, video_from_frames({picture}, Rational(25)), context);
  if (track.lost.at(0) || !track.shapes.at(0).allFinite()) return {};
  return std::move(track.shapes[0]);
}

Shape average(const std::vector<Example>& examples) {
  Shape sum = examples.front().points;
  for (std::size_t i = 1; i < examples.size(); ++i) sum += examples[i].points;
  return sum / static_cast<double>(examples.size());
}

}  // namespace

Shape place_mean(const Shape& mean, cv::Size picture) {
  constexpr double share = 0.5;  // of the picture's height or width that the face takes
  const Eigen::RowVector2d low = mean.colwise().minCoeff(), high = mean.colwise().maxCoeff(), size = high - low;
  const double scale = share * std::min(picture.width / size.x(), picture.height / size.y());
  const Eigen::RowVector2d middle(0.5 * (picture.width - 1), 0.5 * (picture.height - 1));
  return (scale * (mean.rowwise() - 0.5 * (low + high))).rowwise() + middle;
}

std::shared_ptr<const AppearanceModel> Beginner::model(const std::vector<Example>& examples, const std::string& state,
                                                       const std::string& scheme, const Context& context) {
  const std::lock_guard lock(mutex_);
  if (state != state_ || !model_) {
    model_ = std::make_shared<const AppearanceModel>(build(examples, scheme, context));
    state_ = state;
  }
  return model_;
}

Beginning Beginner::begin(const cv::Mat& picture, const std::vector<Example>& examples, const std::string& state,
                          const std::string& scheme, const Context& context) {
  if (examples.empty()) return {place_mean(mean_, picture.size()), Beginning::By::scheme};
  try {
    if (examples.size() >= enough)
      if (auto fitted = fit(*model(examples, state, scheme, context), picture, context))
        return {*std::move(fitted), Beginning::By::model};
  } catch (const std::runtime_error&) {
    // No model comes of these examples, flat pictures for one: a person can do without.
  }
  return {average(examples), Beginning::By::examples};
}

}  // namespace talkgraph::annotate
