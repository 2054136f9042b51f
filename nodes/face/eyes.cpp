#include "nodes/face/eyes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nodes/face/draw.h"
#include "nodes/face/shapes.h"
#include "nodes/types/scheme.h"

namespace talkgraph {
namespace {

std::vector<int> named(const PointScheme& scheme, std::initializer_list<const char*> groups) {
  std::vector<int> points;
  for (const char* name : groups) {
    const auto group = scheme.named(name);
    points.insert(points.end(), group.begin(), group.end());
  }
  return points;
}

bool has_group(const PointScheme& scheme, std::string_view name) {
  return std::any_of(scheme.groups.begin(), scheme.groups.end(), [&](const auto& group) { return group.name == name; });
}

/// Points around the eyes: where the scheme has none on them, the brows and the upper half of the nose's bridge.
std::vector<int> around_eyes(const PointScheme& scheme) {
  if (has_group(scheme, "left_eye") || !has_group(scheme, "left_brow")) return named(scheme, {"left_eye", "right_eye"});
  auto points = named(scheme, {"left_brow", "right_brow"});
  const auto bridge = scheme.named("nose_bridge");
  points.insert(points.end(), bridge.begin(), bridge.begin() + static_cast<std::ptrdiff_t>((bridge.size() + 1) / 2));
  return points;
}

/// The scheme's eyes and nose; an eye is a ring of points that begins at a corner and goes over the upper lid.
MakeEyes with_scheme(MakeEyes eyes, const AppearanceModel& model) {
  if (!eyes.points.empty()) return eyes;
  const auto scheme = scheme_of(model.scheme, model.points());
  eyes.points = around_eyes(scheme);
  eyes.nose = named(scheme, {"nose_bridge", "nose_base"});
  if (has_group(scheme, "left_eye"))
    for (const char* name : {"left_eye", "right_eye"}) {
      const auto ring = scheme.named(name);
      for (std::size_t i = 1; i < ring.size() - i; ++i) {
        eyes.upper_lids.push_back(ring[i]);
        eyes.lower_lids.push_back(ring[ring.size() - i]);
      }
    }
  return eyes;
}

void check_points(const AppearanceModel& model, const MakeEyes& eyes) {
  if (eyes.upper_lids.size() != eyes.lower_lids.size())
    throw std::runtime_error(fmt::format("{} points of upper lids, but {} of lower ones below them",
                                         eyes.upper_lids.size(), eyes.lower_lids.size()));
  for (const auto* points : {&eyes.points, &eyes.nose, &eyes.upper_lids, &eyes.lower_lids})
    for (const int i : *points)
      if (i >= model.points())
        throw std::runtime_error(
            fmt::format("the face model has {} points and so no point {}: name those of the eyes", model.points(), i));
}

/// The likeliest parameters given the gap between the lids: it is linear in c, and c is normal.
Eigen::VectorXd shut_eyes(const AppearanceModel& model, const MakeEyes& eyes) {
  if (eyes.upper_lids.empty()) throw std::runtime_error("name the landmarks of the lids: upper_lids, lower_lids");
  double gap = 0;
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(model.modes());
  for (std::size_t i = 0; i < eyes.upper_lids.size(); ++i) {
    const int up = eyes.upper_lids[i], down = eyes.lower_lids[i];
    gap += model.mean_shape(down, 1) - model.mean_shape(up, 1);
    slope += (model.shape_per_mode.row(2 * down + 1) - model.shape_per_mode.row(2 * up + 1)).transpose();
  }
  const Eigen::VectorXd towards = model.combined_variances.cwiseProduct(slope);
  const double deviation = std::sqrt(slope.dot(towards));
  if (!(deviation > 0.05 * gap))
    throw std::runtime_error(
        "the lids never move in the frames that the face model was built from: it cannot blink; take still eyes, or "
        "given ones");
  return -std::min(gap / deviation, eyes.reach) / deviation * towards;
}

std::vector<double> blinks(double seconds, const MakeEyes& eyes, Random& random) {
  std::vector<double> at;
  for (double t = random.uniform(0.2, 1) * eyes.interval; t < seconds; t += random.uniform(0.5, 1.5) * eyes.interval)
    at.push_back(t);
  return at;
}

/// The values of a track at a time: between those of the frames around it, held beyond its ends.
Eigen::RowVectorXd at_time(const Track& track, double seconds) {
  const double last = static_cast<double>(track.frames() - 1);
  const double frame = std::clamp((seconds - track.start) * track.rate.value(), 0.0, last);
  const auto before = static_cast<Eigen::Index>(frame), after = std::min(before + 1, track.frames() - 1);
  const double share = frame - static_cast<double>(before);
  return (1 - share) * track.values.row(before) + share * track.values.row(after);
}

}  // namespace

EyeBand eye_band(const Shape& face, const std::vector<int>& eyes) {
  const Eigen::VectorXd x = face.col(0)(eyes), y = face.col(1)(eyes);
  const double across = x.maxCoeff() - x.minCoeff();
  return {y.minCoeff() - across / 8, y.maxCoeff() + across / 8, across / 12};
}

double below_eyes(const AppearanceModel& model) {
  const auto band = eye_band(model.mean_shape, around_eyes(scheme_of(model.scheme, model.points())));
  return band.bottom + band.fade;
}

double lid_closure(double since, double duration) {
  const double share = since / duration;
  return smooth_step(0, 1.0 / 3, share) * (1 - smooth_step(1.0 / 3, 1, share));
}

Eyes MakeEyes::operator()(const AppearanceModel& model, const Track& parameters, const Track* given,
                          Random& random) const {
  check_dimension(model, parameters);
  if (source == EyeSource::base) return {};
  const MakeEyes eyes = with_scheme(*this, model);
  check_points(model, eyes);
  Eyes out{parameters, eyes.points, eyes.nose};
  auto& c = out.parameters.values;
  if (source == EyeSource::given) {
    if (!given || given->frames() == 0)
      throw std::runtime_error("there are no eyes: wire their parameters to \"given\"");
    check_dimension(model, *given);
    for (Eigen::Index t = 0; t < c.rows(); ++t) c.row(t) = at_time(*given, parameters.time(t));
    return out;
  }
  c.setZero();
  if (source == EyeSource::still) return out;
  const double rate = parameters.rate.value();
  Eigen::VectorXd closure = Eigen::VectorXd::Zero(c.rows());
  for (const double begin : blinks(static_cast<double>(c.rows()) / rate, *this, random))
    for (Eigen::Index t = 0; t < c.rows(); ++t)
      closure(t) = std::max(closure(t), lid_closure((static_cast<double>(t) + 0.5) / rate - begin, duration));
  c = closure * shut_eyes(model, eyes).transpose();
  return out;
}

void describe(Description<MakeEyes>& d) {
  d.type("face.eyes")
      .version(3)
      .summary("eyes for a face that is drawn: still, blinking, or those of other parameters");
  d.source("Thesis §6.3.5; docs/method.md §2");
  d.input("model", "of the face")
      .input("parameters", "of the face that is drawn: as many frames")
      .input("given", "whose eyes are taken, if the source is given")
      .output("eyes", "for face.render and face.composite");
  d.param("source", &MakeEyes::source)
      .doc("those of the frames drawn upon, those of the mean face, the same blinking, or those of the input given");
  d.param("interval", &MakeEyes::interval).positive().unit("s").doc("between blinks, on average");
  d.param("duration", &MakeEyes::duration).positive().unit("s").doc("of a blink");
  d.param("reach", &MakeEyes::reach)
      .positive()
      .doc("how far lids shut, standard deviations of the gap between them in the model; they stop where they meet");
  d.param("points", &MakeEyes::points)
      .at_least(0)
      .doc(
          "landmarks of the eyes; empty: they, the nose and the lids are those of the point scheme, of one that has no "
          "eyes brows and nose around them");
  d.param("nose", &MakeEyes::nose).at_least(0).doc("landmarks that go with them, so that proportions stay");
  d.param("upper_lids", &MakeEyes::upper_lids).at_least(0).doc("landmarks on the upper lids");
  d.param("lower_lids", &MakeEyes::lower_lids).at_least(0).doc("landmarks below those, in the same order");
}

}  // namespace talkgraph
