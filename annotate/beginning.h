#pragma once

#include <memory>
#include <mutex>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "graph/context.h"
#include "nodes/types/appearance_model.h"

namespace talkgraph::annotate {

/// A frame that is done, to begin others from.
struct Example {
  cv::Mat picture;
  Shape points;
};

/// Where annotating a frame begins.
struct Beginning {
  enum class By { scheme, examples, model };
  Shape points;
  By by = By::scheme;
};

/// The mean shape of a scheme in the middle of a picture, about as large as a face on a speaker's clip is.
Shape place_mean(const Shape& mean, cv::Size picture);

/// Gives a person points to begin with. From `enough` examples on, an appearance model of them is fitted to the
/// picture; where that finds no face, and before, the examples' average place counts; without examples, the scheme's
/// mean shape. May be used by any threads.
class Beginner {
 public:
  static constexpr std::size_t enough = 3;

  explicit Beginner(Shape mean) : mean_(std::move(mean)) {}

  /// `state` names the examples: the model is built anew when it changes.
  Beginning begin(const cv::Mat& picture, const std::vector<Example>& examples, const std::string& state,
                  const std::string& scheme, const Context& context);

 private:
  std::shared_ptr<const AppearanceModel> model(const std::vector<Example>& examples, const std::string& state,
                                               const std::string& scheme, const Context& context);

  const Shape mean_;
  std::mutex mutex_;
  std::string state_;
  std::shared_ptr<const AppearanceModel> model_;
};

}  // namespace talkgraph::annotate
