#include "nodes/face/prototypes.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

namespace talkgraph {
namespace {

struct Candidate {
  std::size_t clip;
  std::int64_t frame;
};

/// A face inside the picture, larger than a point.
bool is_usable(const Shape& shape, cv::Size size) {
  constexpr double smallest = 8;
  return shape.rows() > 0 && shape.allFinite() && shape.minCoeff() >= 0 && shape.col(0).maxCoeff() <= size.width - 1 &&
         shape.col(1).maxCoeff() <= size.height - 1 &&
         (shape.colwise().maxCoeff() - shape.colwise().minCoeff()).minCoeff() >= smallest;
}

std::map<std::string, std::vector<Candidate>> candidates_by_phone(const Collected<Video>& videos,
                                                                  const Collected<LandmarkTrack>& landmarks,
                                                                  const Collected<FrameLabels>& labels) {
  std::map<std::string, std::vector<Candidate>> found;
  for (std::size_t clip = 0; clip < videos.size(); ++clip) {
    const auto* shapes = landmarks.find(videos.key(clip));
    const auto* phones = labels.find(videos.key(clip));
    if (!shapes || !phones) continue;
    const auto size = videos[clip].source->size();
    const auto frames = std::min({videos[clip].source->frames(), static_cast<std::int64_t>(shapes->frames.size()),
                                  static_cast<std::int64_t>(phones->labels.size())});
    for (std::int64_t t = 0; t < frames; ++t) {
      const auto at = static_cast<std::size_t>(t);
      if (!videos[clip].is_damaged(t) && is_usable(shapes->frames[at], size))
        found[phones->labels[at]].push_back({clip, t});
    }
  }
  return found;
}

/// The face with a fifth of its size around it.
cv::Rect surroundings(const Shape& shape, cv::Size size) {
  const Eigen::RowVector2d low = shape.colwise().minCoeff(), high = shape.colwise().maxCoeff();
  const double margin = 0.2 * (high - low).maxCoeff() + 2;
  const cv::Point from(static_cast<int>(low.x() - margin), static_cast<int>(low.y() - margin));
  const cv::Point to(static_cast<int>(high.x() + margin) + 1, static_cast<int>(high.y() + margin) + 1);
  return cv::Rect(from, to) & cv::Rect({}, size);
}

void add_frames(const Video& video, const LandmarkTrack& landmarks, const std::set<std::int64_t>& chosen,
                Prototypes& out) {
  const auto reader = video.source->open();
  cv::Mat frame;
  for (std::int64_t t = 0; t <= *chosen.rbegin(); ++t) {
    if (!reader->next(frame))
      throw std::runtime_error(video.source->name() + " ends at frame " + std::to_string(t) + " of " +
                               std::to_string(video.source->frames()) + " it promised");
    if (!chosen.contains(t)) continue;
    const auto& shape = landmarks.frames[static_cast<std::size_t>(t)];
    const auto cut = surroundings(shape, frame.size());
    out.images.push_back({frame(cut).clone()});
    out.shapes.push_back(shape.rowwise() - Eigen::RowVector2d(cut.x, cut.y));
  }
}

}  // namespace

Prototypes ChoosePrototypes::operator()(const Collected<Video>& videos, const Collected<LandmarkTrack>& landmarks,
                                        const Collected<FrameLabels>& labels, Random& random, Context& context) const {
  std::map<std::size_t, std::set<std::int64_t>> chosen;
  for (auto& [phone, frames] : candidates_by_phone(videos, landmarks, labels)) {
    random.shuffle(frames);
    const auto count = std::min(frames.size(), static_cast<std::size_t>(per_phone));
    for (std::size_t i = 0; i < count; ++i) chosen[frames[i].clip].insert(frames[i].frame);
  }
  if (chosen.empty() && landmarks.empty())
    throw std::runtime_error(
        "no frame can serve as a prototype: none of the " + std::to_string(videos.size()) +
        " clips to train on has landmarks; a face model is built from some, give them in the corpus");
  if (chosen.empty())
    throw std::runtime_error(
        "no frame can serve as a prototype: of " + std::to_string(videos.size()) +
        " clips none has an undamaged frame with a phone label and all landmarks inside the picture");
  Prototypes out;
  double done = 0;
  for (const auto& [clip, frames] : chosen) {
    context.check_cancelled();
    const auto& track = *landmarks.find(videos.key(clip));
    out.scheme = track.scheme;
    add_frames(videos[clip], track, frames, out);
    context.progress(++done / static_cast<double>(chosen.size()));
  }
  return out;
}

void describe(Description<ChoosePrototypes>& d) {
  d.type("face.prototypes").version(1).summary("chooses frames of every phone at random to build a face model from");
  d.source("Thesis §3.4; docs/method.md §2").stored();
  d.input("videos", "clips").input("landmarks", "of the clips").input("labels", "phone of every frame");
  d.output("prototypes", "pictures with their landmarks");
  d.param("per_phone", &ChoosePrototypes::per_phone)
      .at_least(1)
      .doc("frames chosen of every phone, fewer where it has fewer");
}

}  // namespace talkgraph
