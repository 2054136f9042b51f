#include "nodes/face/mouths.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "nodes/face/mouth_region.h"
#include "nodes/face/sampling.h"
#include "nodes/face/shapes.h"
#include "nodes/types/scheme.h"

namespace talkgraph {
namespace {

struct Frame {
  std::size_t clip, number;
  double residual;  ///< as a share of the contrast
};

/// All frames that the model was followed to, less the worst fitted share.
std::vector<Frame> good_frames(const AppearanceModel& model, const Collected<Video>& videos,
                               const Collected<FaceTrack>& tracks, double leave_out) {
  std::vector<Frame> found;
  for (std::size_t clip = 0; clip < videos.size(); ++clip) {
    const auto* track = tracks.find(videos.key(clip));
    if (!track) continue;
    check_dimension(model, track->parameters);
    for (std::size_t t = 0; t < track->lost.size(); ++t)
      if (!track->lost[t] && track->gain[t] > 0) found.push_back({clip, t, track->residual[t] / track->gain[t]});
  }
  std::vector<double> residuals;
  for (const auto& frame : found) residuals.push_back(frame.residual);
  std::sort(residuals.begin(), residuals.end());
  const auto kept = residuals.size() - static_cast<std::size_t>(leave_out * static_cast<double>(residuals.size()));
  if (kept == 0) return {};
  std::erase_if(found, [worst = residuals[kept - 1]](const Frame& frame) { return frame.residual > worst; });
  return found;
}

/// At most `limit` of them, evenly spread over the clips.
std::vector<Frame> some(const std::vector<Frame>& all, int limit) {
  const auto count = std::min(all.size(), static_cast<std::size_t>(limit));
  std::vector<Frame> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(all[i * all.size() / count]);
  return chosen;
}

std::vector<int> lips(const AppearanceModel& model) {
  const auto scheme = scheme_of(model.scheme, model.points());
  auto points = scheme.named("outer_lips");
  const auto inner = scheme.named("inner_lips");
  points.insert(points.end(), inner.begin(), inner.end());
  return points;
}

/// What a frame shows at the mouth, in the model's average light.
cv::Mat picture_of(const AppearanceModel& model, const MouthRegion& region, const cv::Mat& frame,
                   const FaceTrack& track, std::size_t t) {
  Eigen::VectorXf texture;
  Pyramid pyramid(frame);
  const auto& raster = model.levels[0].raster;
  sample(pyramid, track.shapes[t], model.triangles, raster, texture);
  const auto gain = static_cast<float>(model.texture_gain / track.gain[t]);
  texture = (texture.array() - static_cast<float>(track.offset[t])) * gain + static_cast<float>(model.texture_offset);
  cv::Mat picture;
  raster_picture(raster, texture)(region.box).convertTo(picture, CV_8UC3);
  return picture;
}

}  // namespace

Mouths KeepMouths::operator()(const AppearanceModel& model, const Collected<Video>& videos,
                              const Collected<FaceTrack>& tracks, Context& context) const {
  const auto around = points.empty() ? lips(model) : points;
  const auto region = mouth_region(model, around, margin);
  Mouths out{around, margin, Eigen::MatrixXd(0, model.modes()), {}};
  const auto frames = some(good_frames(model, videos, tracks, leave_out), limit);
  out.parameters.resize(static_cast<Eigen::Index>(frames.size()), model.modes());
  std::unique_ptr<VideoSource::Reader> reader;
  cv::Mat picture;
  for (std::size_t i = 0, next = 0; i < frames.size(); ++i) {
    context.check_cancelled();
    const auto& [clip, number, residual] = frames[i];
    if (i == 0 || clip != frames[i - 1].clip) reader = videos[clip].source->open(), next = 0;
    for (; next <= number; ++next)
      if (!reader->next(picture))
        throw std::runtime_error(fmt::format("{} ends at frame {} of {} it promised", videos[clip].source->name(), next,
                                             videos[clip].source->frames()));
    const auto& track = *tracks.find(videos.key(clip));
    out.parameters.row(static_cast<Eigen::Index>(i)) = track.parameters.values.row(static_cast<Eigen::Index>(number));
    out.pictures.push_back({picture_of(model, region, picture, track, number)});
    context.progress(static_cast<double>(i + 1) / static_cast<double>(frames.size()));
  }
  return out;
}

void describe(Description<KeepMouths>& d) {
  d.type("face.mouths")
      .version(3)
      .summary("keeps real mouths of the training clips, for synthesised faces to show")
      .source("after Wang, Qian, Han & Soong 2010; docs/method.md §2")
      .stored();
  d.input("model", "of the face")
      .input("videos", "clips")
      .input("tracks", "of the clips")
      .output("mouths", "pictures warped as the model's textures are, with their appearance parameters");
  d.param("points", &KeepMouths::points)
      .at_least(0)
      .doc("landmarks around the mouth; empty: outer and inner lips of the point scheme");
  d.param("margin", &KeepMouths::margin)
      .within(0, 2)
      .doc("skin around them that belongs to it, share of the mouth's width");
  d.param("limit", &KeepMouths::limit).at_least(0).doc("mouths kept at most, evenly spread over the clips");
  d.param("leave_out", &KeepMouths::leave_out)
      .within(0, 1)
      .doc("share of the frames that is not used: those that the model fits worst");
}

}  // namespace talkgraph
