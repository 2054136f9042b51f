#include "nodes/face/mouth_space.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "nodes/face/geometry.h"
#include "nodes/face/pca.h"
#include "nodes/types/scheme.h"

namespace talkgraph {
namespace {

std::vector<int> points_of(const PointScheme& scheme, const std::vector<std::string>& names) {
  std::vector<int> points;
  for (const auto& name : names)
    for (const int point : scheme.named(name)) points.push_back(point);
  return points;
}

/// The measured frames of a clip: which they are, and their points.
struct Measured {
  std::vector<std::int64_t> lost;
  std::vector<Eigen::Index> frames;
  std::vector<Shape> reference, mouth;
};

Measured measured(const LandmarkTrack& landmarks, const std::vector<std::string>& reference,
                  const std::vector<std::string>& mouth) {
  Measured m;
  if (landmarks.frames.empty()) return m;
  const auto scheme = scheme_of(landmarks);
  const auto still = points_of(scheme, reference), moving = points_of(scheme, mouth);
  for (std::size_t t = 0; t < landmarks.frames.size(); ++t) {
    const Shape& shape = landmarks.frames[t];
    if (shape.rows() != scheme.points())
      throw std::runtime_error(fmt::format("frame {} has {} points, its scheme {}", t, shape.rows(), scheme.points()));
    const Shape held = shape(still, Eigen::all), free = shape(moving, Eigen::all);
    if (!held.allFinite() || !free.allFinite()) {
      m.lost.push_back(static_cast<std::int64_t>(t));
      continue;
    }
    m.frames.push_back(static_cast<Eigen::Index>(t));
    m.reference.push_back(held);
    m.mouth.push_back(free);
  }
  return m;
}

/// Mouths laid upon the mean by the points that hold still, their own mean taken off, a column each.
Eigen::MatrixXd mouths(const Measured& clip, const Shape& mean) {
  Eigen::MatrixXd columns(2 * clip.mouth.front().rows(), clip.mouth.size());
  for (std::size_t i = 0; i < clip.mouth.size(); ++i)
    columns.col(static_cast<Eigen::Index>(i)) = flatten(transform(align(clip.reference[i], mean), clip.mouth[i]));
  return columns.colwise() - columns.rowwise().mean();
}

double mean_width(const std::vector<Shape>& shapes) {
  double sum = 0;
  for (const Shape& s : shapes) sum += s.col(0).maxCoeff() - s.col(0).minCoeff();
  return sum / static_cast<double>(shapes.size());
}

}  // namespace

MouthSpace LearnMouthSpace::operator()(const Collected<LandmarkTrack>& landmarks) const {
  std::vector<Measured> clips;
  std::vector<Shape> all;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    auto clip = measured(landmarks[i], reference, mouth);
    if (clip.frames.empty()) continue;
    if (!clips.empty() &&
        (clip.reference[0].rows() != all[0].rows() || clip.mouth[0].rows() != clips[0].mouth[0].rows()))
      throw std::runtime_error(landmarks.key(i) + ": its points are of another scheme than those of clips before");
    all.insert(all.end(), clip.reference.begin(), clip.reference.end());
    clips.push_back(std::move(clip));
  }
  if (clips.empty()) throw std::runtime_error("no frame has landmarks: is the training selection empty?");
  if (all[0].rows() < 2 || clips[0].mouth[0].rows() == 0)
    throw std::runtime_error("at least two points must hold still, and one must be measured");

  MouthSpace space{reference, mouth, procrustes(all, mean_width(all)).mean, {}};
  Eigen::MatrixXd columns(2 * clips[0].mouth[0].rows(), all.size());
  Eigen::Index at = 0;
  for (const auto& clip : clips) {
    const auto frames = static_cast<Eigen::Index>(clip.mouth.size());
    columns.middleCols(at, frames) = mouths(clip, space.mean);
    at += frames;
  }
  if (columns.norm() <= 1e-9 * std::sqrt(static_cast<double>(at)) * space.mean.norm())  // rounding
    throw std::runtime_error("the mouth does not move: nothing can be measured");
  space.modes = pca(columns, retain).modes;
  return space;
}

Track MeasureMouth::operator()(const MouthSpace& space, const LandmarkTrack& landmarks) const {
  auto clip = measured(landmarks, space.reference, space.mouth);
  if (clip.frames.empty()) throw std::runtime_error("no frame has landmarks");
  if (clip.reference[0].rows() != space.mean.rows() || 2 * clip.mouth[0].rows() != space.modes.rows())
    throw std::runtime_error("the landmarks have another scheme than those that the mouth space was learnt from");
  Track track;
  track.rate = landmarks.rate;
  track.start = 0.5 / landmarks.rate.value();
  track.values.setZero(static_cast<Eigen::Index>(landmarks.frames.size()), space.modes.cols());
  track.values(clip.frames, Eigen::all) = mouths(clip, space.mean).transpose() * space.modes;
  track.lost = std::move(clip.lost);
  return track;
}

void describe(Description<LearnMouthSpace>& d) {
  d.type("face.mouth_space").summary("learns how mouths are measured free of head pose").stored();
  d.input("landmarks", "of the training clips")
      .output("space", "mean of the points that hold still, modes of the mouth");
  d.param("reference", &LearnMouthSpace::reference).doc("groups or points of the scheme that speech hardly moves");
  d.param("mouth", &LearnMouthSpace::mouth).doc("groups or points that are measured");
  d.param("retain", &LearnMouthSpace::retain).within(0, 1).doc("share of the variance that the components hold");
}

void describe(Description<MeasureMouth>& d) {
  d.type("face.mouth_track").summary("how the mouth of a clip moves, in components free of head pose");
  d.input("space", "of face.mouth_space").input("landmarks", "of a clip, recorded or synthesised");
  d.output("visual", "components about the clip's mean, pixels");
}

}  // namespace talkgraph
