#pragma once

#include <opencv2/core.hpp>

#include "nodes/face/build.h"
#include "nodes/types/prototypes.h"

namespace talkgraph::test {

/// A face of smooth colours with known landmarks: outline, eyes, nose, mouth.
struct SyntheticFace {
  double open = 0.5, wide = 0.5;  ///< mouth, 0..1
  double x = 100, y = 95;         ///< of the centre
  double radius = 45, angle = 0;  ///< half width in pixels, radians
  double gain = 1, offset = 0;    ///< of the light
};
constexpr int synthetic_size = 200;
cv::Mat draw(const SyntheticFace& face);
Shape landmarks(const SyntheticFace& face);

/// Faces over the whole range of mouths, at slightly different places.
Prototypes synthetic_prototypes(int per_side = 4);

/// A mouth that opens and closes while the head sways.
SyntheticFace talking_face(int frame);

double rms_distance(const Shape& a, const Shape& b);
/// Peak signal to noise ratio in decibels.
double psnr(const cv::Mat& a, const cv::Mat& b);

/// The model of these prototypes, built once.
inline const AppearanceModel& model() {
  static const AppearanceModel built = [] {
    Context context;
    return BuildAppearance{}(test::synthetic_prototypes(), context);
  }();
  return built;
}

}  // namespace talkgraph::test
