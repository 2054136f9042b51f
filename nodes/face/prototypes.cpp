#include "nodes/face/prototypes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "nodes/face/geometry.h"

namespace talkgraph {
namespace {

struct Candidate {
  std::size_t clip;
  std::int64_t frame;
};
using ByPhone = std::map<std::string, std::vector<Candidate>>;

/// A face inside the picture, larger than a point.
bool is_usable(const Shape& shape, cv::Size size) {
  constexpr double smallest = 8;
  return shape.rows() > 0 && shape.allFinite() && shape.minCoeff() >= 0 && shape.col(0).maxCoeff() <= size.width - 1 &&
         shape.col(1).maxCoeff() <= size.height - 1 &&
         (shape.colwise().maxCoeff() - shape.colwise().minCoeff()).minCoeff() >= smallest;
}

ByPhone candidates_by_phone(const Collected<Video>& videos, const Collected<LandmarkTrack>& landmarks,
                            const Collected<FrameLabels>& labels) {
  ByPhone found;
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

std::size_t count_of(const std::vector<Candidate>& frames, int per_phone) {
  return std::min(frames.size(), static_cast<std::size_t>(per_phone));
}

std::vector<Candidate> at_random(ByPhone by_phone, int per_phone, Random& random) {
  std::vector<Candidate> chosen;
  for (auto& [phone, frames] : by_phone) {
    random.shuffle(frames);
    chosen.insert(chosen.end(), frames.begin(), frames.begin() + std::ptrdiff_t(count_of(frames, per_phone)));
  }
  return chosen;
}

/// Shapes carried onto their mean, one a column, less the mean.
Eigen::MatrixXd aligned_columns(const std::vector<Shape>& shapes) {
  const auto aligned = procrustes(shapes, shapes[0].col(0).maxCoeff() - shapes[0].col(0).minCoeff());
  Eigen::MatrixXd columns(2 * shapes[0].rows(), std::ssize(shapes));
  for (Eigen::Index i = 0; i < columns.cols(); ++i)
    columns.col(i) = flatten(aligned.shapes[static_cast<std::size_t>(i)] - aligned.mean);
  return columns;
}

std::vector<Candidate> by_coverage(const ByPhone& by_phone, int per_phone, const Collected<Video>& videos,
                                   const Collected<LandmarkTrack>& landmarks) {
  std::vector<Candidate> all;
  std::vector<Shape> shapes;
  std::size_t count = 0;
  for (const auto& [phone, frames] : by_phone) {
    count += count_of(frames, per_phone);
    for (const auto& f : frames) {
      all.push_back(f);
      shapes.push_back(landmarks.find(videos.key(f.clip))->frames[static_cast<std::size_t>(f.frame)]);
      if (shapes.back().rows() != shapes.front().rows())
        throw std::runtime_error(videos.key(f.clip) + ": " + std::to_string(shapes.back().rows()) + " landmarks, " +
                                 videos.key(all.front().clip) + " has " + std::to_string(shapes.front().rows()));
    }
  }
  std::vector<Candidate> chosen;
  if (all.empty()) return chosen;
  const Eigen::MatrixXd columns = aligned_columns(shapes);
  Eigen::Index next = 0;
  columns.colwise().squaredNorm().minCoeff(&next);
  Eigen::RowVectorXd nearest = Eigen::RowVectorXd::Constant(columns.cols(), INFINITY);
  while (chosen.size() < count) {
    chosen.push_back(all[static_cast<std::size_t>(next)]);
    nearest = nearest.cwiseMin((columns.colwise() - columns.col(next)).colwise().squaredNorm());
    nearest.maxCoeff(&next);
  }
  return chosen;
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
  const auto by_phone = candidates_by_phone(videos, landmarks, labels);
  std::map<std::size_t, std::set<std::int64_t>> chosen;
  for (const auto& f : choose == PrototypeChoice::random ? at_random(by_phone, per_phone, random)
                                                         : by_coverage(by_phone, per_phone, videos, landmarks))
    chosen[f.clip].insert(f.frame);
  if (chosen.empty() && landmarks.empty())
    throw std::runtime_error(
        "no frame can serve as a prototype: none of the " + std::to_string(videos.size()) +
        " clips to train on has landmarks; mark the face in some frames with talkgraph annotate MANIFEST, or name "
        "landmarks in the manifest");
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
  d.type("face.prototypes").version(1).summary("chooses frames to build a face model from");
  d.source("Thesis §3.4; docs/method.md §2").stored();
  d.input("videos", "clips").input("landmarks", "of the clips").input("labels", "phone of every frame");
  d.output("prototypes", "pictures with their landmarks");
  d.param("per_phone", &ChoosePrototypes::per_phone)
      .at_least(1)
      .doc("frames chosen of every phone, fewer where it has fewer");
  d.param("choose", &ChoosePrototypes::choose)
      .doc("at random of every phone, or as many in all so that they cover the space of shapes");
}

}  // namespace talkgraph
