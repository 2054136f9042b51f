#include "nodes/face/fit.h"

#include <cmath>

#include "nodes/face/geometry.h"

namespace talkgraph {
namespace {

Fit moved(const AppearanceModel& model, const Fit& from, const Eigen::VectorXf& step, double length, double limit) {
  Fit to = from;
  const auto modes = model.modes();
  to.c -= length * step.head(modes).cast<double>();
  const Eigen::ArrayXd bound = limit * model.combined_variances.array().sqrt();
  to.c = to.c.array().min(bound).max(-bound);
  to.pose = compose(from.pose, small_pose(-length * step.tail<4>().cast<double>()));
  return to;
}

/// Correlation of the picture (model plus difference) with the model, each channel centred.
double detail_likeness(const Eigen::VectorXf& expected, const Eigen::VectorXf& difference) {
  using Channels = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
  Channels model = Eigen::Map<const Channels>(expected.data(), expected.size() / 3, 3);
  Channels picture = model + Eigen::Map<const Channels>(difference.data(), difference.size() / 3, 3);
  model.rowwise() -= model.colwise().mean().eval();
  picture.rowwise() -= picture.colwise().mean().eval();
  const double sizes = static_cast<double>(model.norm()) * picture.norm();
  return sizes > 0 ? model.cwiseProduct(picture).sum() / sizes : 0;
}

}  // namespace

Pose small_pose(const Eigen::Vector4d& q) {
  return {std::hypot(1 + q(0), q(1)), std::atan2(q(1), 1 + q(0)), q(2), q(3)};
}

void evaluate(const AppearanceModel& model, Pyramid& pyramid, std::size_t level, Fit& fit,
              Eigen::VectorXf& difference) {
  sample(pyramid, transform(fit.pose, model.shape(fit.c)), model.triangles, model.levels[level].raster, difference);
  const auto photometry = normalise(difference);
  const Eigen::VectorXf expected = model.texture(fit.c, level);
  const double likeness = difference.dot(expected), size = expected.squaredNorm();
  fit.offset = photometry.offset;
  fit.error = 1;
  fit.residual = photometry.gain / std::sqrt(static_cast<double>(difference.size()));
  fit.gain = 0;
  if (photometry.gain <= 0 || likeness <= 0) return;
  fit.gain = photometry.gain * likeness / size;
  fit.error = std::max(0.0, 1 - likeness * likeness / size);
  fit.residual *= std::sqrt(fit.error);
  difference = difference * static_cast<float>(size / likeness) - expected;
}

Fit fit(const AppearanceModel& model, Pyramid& pyramid, std::size_t level, const Fit& start,
        const FitOptions& options) {
  const auto& update = *model.levels[level].update;
  Fit best = start;
  Eigen::VectorXf difference, trial_difference, step;
  evaluate(model, pyramid, level, best, difference);
  for (int round = 0; round < options.iterations && best.gain > 0; ++round) {
    step.noalias() = update.transpose() * difference;
    const double before = best.error;
    for (const double length : {1.0, 1.5, 0.5, 0.25}) {
      Fit trial = moved(model, best, step, length, options.limit);
      evaluate(model, pyramid, level, trial, trial_difference);
      if (trial.error < before) {
        best = std::move(trial);
        difference.swap(trial_difference);
        break;
      }
    }
    if (before - best.error <= options.tolerance * before) break;
  }
  if (best.gain > 0) best.detail = detail_likeness(model.texture(best.c, level), difference);
  return best;
}

}  // namespace talkgraph
