#include "nodes/face/track.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "nodes/face/fit.h"
#include "nodes/face/geometry.h"
#include "nodes/face/search.h"

namespace talkgraph {
namespace {

constexpr double least_contrast = 0.1;  // of the prototypes' average
constexpr double least_detail = 0.5;    // correlation

class Tracker {
 public:
  Tracker(const TrackFace& settings, const AppearanceModel& model)
      : settings_(settings),
        model_(model),
        fitter_(model, settings.fitter),
        options_{settings.iterations, settings.tolerance, FitOptions{}.limit, settings.reach},
        threshold_(settings.lost_above * std::max(model.residual, 4.0 / 3) / model.texture_gain) {}

  /// How far the nearest bound of a good fit is away, 0 outside. The residual counts in the model's own light: a
  /// ghost of low contrast has a small one in grey levels.
  double confidence(const Fit& fit) const {
    if (fit.gain <= 0) return 0;
    const double margin =
        std::min({1 - fit.residual / (threshold_ * fit.gain), 1 - least_contrast * model_.texture_gain / fit.gain,
                  (fit.detail - least_detail) / (1 - least_detail)});
    return std::clamp(margin, 0.0, 1.0);
  }

  Fit follow(Pyramid& pyramid, const Fit& last) { return fitter_.coarse_to_fine(pyramid, last, options_); }

  /// The best of the fits that begin at the most promising windows.
  std::optional<Fit> search(Pyramid& pyramid) {
    std::vector<Fit> fits;
    for (const auto& window : search_windows(model_, pyramid, settings_.scale_range, settings_.candidates))
      fits.push_back(fitter_.fit(pyramid, model_.levels.size() - 1, window, {3 * settings_.iterations, 1e-3, 3}));
    if (fits.empty()) return {};
    const auto by_error = [](const Fit& a, const Fit& b) { return a.error < b.error; };
    return follow(pyramid, *std::min_element(fits.begin(), fits.end(), by_error));
  }

  /// How well a place that was not fitted fits.
  void evaluate(Pyramid& pyramid, Fit& fit) { fitter_.evaluate(pyramid, 0, fit); }

 private:
  const TrackFace& settings_;
  const AppearanceModel& model_;
  Fitter fitter_;
  FitOptions options_;
  double threshold_;
};

Fit mean_face(const AppearanceModel& model, cv::Size size) {
  Fit f;
  f.c = Eigen::VectorXd::Zero(model.modes());
  f.pose = {model.picture_scale, 0, 0.5 * size.width, 0.5 * size.height};
  f.gain = model.texture_gain;
  f.offset = model.texture_offset;
  return f;
}

Fit between(const Fit& a, const Fit& b, double share) {
  const auto mix = [share](double x, double y) { return x + share * (y - x); };
  Fit f;
  f.c = a.c + share * (b.c - a.c);
  f.pose = {mix(a.pose.scale, b.pose.scale), mix(a.pose.angle, b.pose.angle), mix(a.pose.dx, b.pose.dx),
            mix(a.pose.dy, b.pose.dy)};
  f.gain = mix(a.gain, b.gain);
  f.offset = mix(a.offset, b.offset);
  return f;
}

/// Gives every lost frame what lies between its good neighbours, keeping the residual it had.
void interpolate(std::vector<Fit>& fits, const std::vector<std::int64_t>& lost) {
  std::optional<std::size_t> before;
  for (std::size_t t = 0; t < fits.size(); ++t) {
    if (!lost[t]) {
      before = t;
      continue;
    }
    std::size_t after = t;
    while (after < fits.size() && lost[after]) ++after;
    if (!before && after == fits.size()) return;
    const Fit& left = before ? fits[*before] : fits[after];
    const Fit& right = after < fits.size() ? fits[after] : fits[*before];
    const double span = before && after < fits.size() ? static_cast<double>(after - *before) : 1;
    const double residual = fits[t].residual;
    fits[t] = between(left, right, before ? static_cast<double>(t - *before) / span * (after < fits.size()) : 0);
    fits[t].residual = residual;
  }
}

FaceTrack to_track(const AppearanceModel& model, const std::vector<Fit>& fits, std::vector<std::int64_t> lost,
                   std::vector<double> confidence, Rational rate) {
  FaceTrack out;
  out.confidence = std::move(confidence);
  out.lost = std::move(lost);
  out.parameters.rate = rate;
  out.parameters.start = 0.5 / rate.value();
  out.parameters.values.resize(static_cast<Eigen::Index>(fits.size()), model.modes());
  for (std::size_t t = 0; t < fits.size(); ++t) {
    out.parameters.values.row(static_cast<Eigen::Index>(t)) = fits[t].c.transpose();
    out.poses.push_back(fits[t].pose);
    out.gain.push_back(fits[t].gain);
    out.offset.push_back(fits[t].offset);
    out.residual.push_back(fits[t].residual);
    out.shapes.push_back(transform(fits[t].pose, model.shape(fits[t].c)));
  }
  return out;
}

}  // namespace

FaceTrack TrackFace::operator()(const AppearanceModel& model, const Video& video, Context& context) const {
  Tracker tracker(*this, model);
  const Fit mean = mean_face(model, video.source->size());
  std::vector<Fit> fits;
  std::vector<std::int64_t> lost;
  std::vector<double> confidence;
  std::optional<Fit> last;
  const auto reader = video.source->open();
  for (cv::Mat frame; reader->next(frame);) {
    context.check_cancelled();
    Pyramid pyramid(frame);
    Fit now = last.value_or(mean);
    const bool damaged = video.is_damaged(static_cast<std::int64_t>(fits.size()));
    if (damaged) {
      tracker.evaluate(pyramid, now);
    } else {
      if (last) now = tracker.follow(pyramid, *last);
      if (!last || tracker.confidence(now) == 0)
        if (auto found = tracker.search(pyramid); found && (!last || found->error < now.error)) now = *found;
    }
    confidence.push_back(damaged ? 0 : tracker.confidence(now));
    lost.push_back(confidence.back() == 0);
    if (!lost.back()) last = now;
    fits.push_back(lost.back() ? mean : now);
    fits.back().residual = now.residual;
    context.progress(static_cast<double>(fits.size()) /
                     static_cast<double>(std::max<std::int64_t>(1, video.source->frames())));
  }
  if (fits.empty()) throw std::runtime_error(video.source->name() + ": no frame to track");
  interpolate(fits, lost);
  return to_track(model, fits, std::move(lost), std::move(confidence), video.source->rate());
}

void describe(Description<TrackFace>& d) {
  d.type("face.track").version(5).summary("follows the face through a clip with the model alone");
  d.source("Thesis §3.1.4, Algorithm 1; docs/method.md §2").stored();
  d.input("model", "of the face")
      .input("video", "a clip of that speaker")
      .output("track", "appearance parameters, pose, light and confidence of every frame, and which frames were lost");
  d.param("fitter", &TrackFace::fitter)
      .doc(
          "fixed_jacobian: the texture's derivative as measured on the prototypes (Algorithm 1); "
          "inverse_compositional: from the gradient of the model's texture as it is at each step; either takes its "
          "steps forward");
  d.param("lost_above", &TrackFace::lost_above)
      .positive()
      .doc(
          "a frame is lost if its residual, scaled to the prototypes' average light, exceeds this many times the "
          "model's own over its prototypes (taken as at least 4/3 grey levels)");
  d.param("iterations", &TrackFace::iterations).at_least(1).doc("at most, per pyramid level and frame");
  d.param("tolerance", &TrackFace::tolerance).within(0, 1).doc("relative gain under which a fit ends");
  d.param("reach", &TrackFace::reach)
      .within(0, 2)
      .doc(
          "a fit whose error is far above the model's own is tried again from so far on all four sides, as a share of "
          "half the face's width; 0: never");
  d.param("scale_range", &TrackFace::scale_range)
      .within(1, 10)
      .doc("the first frame is searched for faces of the prototypes' average size divided and multiplied by this");
  d.param("candidates", &TrackFace::candidates).at_least(1).doc("windows of that search which are fitted");
}

}  // namespace talkgraph
