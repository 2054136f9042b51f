#include "nodes/face/fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "nodes/face/geometry.h"

namespace talkgraph {
namespace {

constexpr int pose_parameters = 4;
constexpr double doubtful = 3;  ///< of the model's own error over its prototypes: a fit that other starts may better
constexpr double stale = 0.9;   ///< of the error at which a texture's change was found: below, it is found anew

Eigen::Index shape_modes(const AppearanceModel& model) { return model.shape_modes.cols(); }

void centre(Eigen::Ref<Eigen::MatrixXf> columns) {
  const Eigen::RowVectorXf means = columns.colwise().mean();
  columns.rowwise() -= means;
}

/// Sums over the pixels of each colour, and of all squares.
struct Sums {
  explicit Sums(const Eigen::VectorXf& texture) {
    Eigen::Array3d squares = Eigen::Array3d::Zero();
    const float* value = texture.data();
    for (const float* const end = value + texture.size(); value != end; value += 3) {
      const Eigen::Array3d pixel(value[0], value[1], value[2]);
      colours += pixel;
      squares += pixel.square();
    }
    square = squares.sum();
  }
  Eigen::Array3d colours = Eigen::Array3d::Zero();
  double square = 0;
};

}  // namespace

Pose small_pose(const Eigen::Vector4d& q) {
  return {std::hypot(1 + q(0), q(1)), std::atan2(q(1), 1 + q(0)), q(2), q(3)};
}

Fitter::Fitter(const AppearanceModel& model, FitMethod method)
    : model_(model),
      method_(method),
      modes_(model.modes()),
      textures_(1 + modes_),
      noise_(std::pow(model.residual / model.texture_gain, 2)) {
  const auto shapes = shape_modes(model), moves = shapes + pose_parameters;
  jacobian_.setZero(textures_ + moves, modes_ + pose_parameters);
  jacobian_.block(1, 0, modes_, modes_).diagonal().setConstant(-1);
  jacobian_.block(textures_, 0, shapes, modes_) = model.combined_modes.topRows(shapes) / model.shape_weight;
  jacobian_.bottomRightCorner<pose_parameters, pose_parameters>().setIdentity();
  for (const FitLevel& given : model.levels) {
    Level level{Sampler(given.raster, model.triangles),
                SteepestDescent(given.raster, model.triangles),
                {},
                {},
                {},
                {},
                {},
                1,
                {}};
    level.columns.resize(given.mean->rows(), textures_ + moves);
    level.columns << *given.mean, *given.appearance, *given.change;
    centre(level.columns.rightCols(moves));
    level.gram = (level.columns.transpose() * level.columns).cast<double>();
    level.colours.resize(textures_, 3);
    for (Eigen::Index i = 0; i < textures_; ++i) level.colours.row(i) = Sums(level.columns.col(i)).colours;
    find_normal(level, Eigen::VectorXd::Unit(textures_, 0));
    levels_.push_back(std::move(level));
  }
}

/// Of the columns in the model's texture.
Eigen::VectorXd Fitter::weights(const Fit& fit) const {
  Eigen::VectorXd w(textures_);
  w << 1, fit.c;
  return w;
}

void Fitter::find_normal(Level& level, const Eigen::VectorXd& weights) {
  level.weights = weights;
  level.along = level.gram.leftCols(textures_) * weights;
  level.size = weights.dot(level.along.head(textures_));
  const Eigen::MatrixXd blind = level.gram - level.along * level.along.transpose() / level.size;
  level.normal = jacobian_.transpose() * blind * jacobian_;
}

void Fitter::linearise(Level& level, const Fit& at) {
  const Eigen::VectorXd w = weights(at);
  const Eigen::VectorXf texture = level.columns.leftCols(textures_) * w.cast<float>();
  const Shape shape = model_.shape(at.c);
  const auto moves = shape_modes(model_) + pose_parameters;
  Eigen::MatrixXd directions(2 * model_.points(), moves);
  directions << model_.shape_modes, pose_directions(shape);
  auto change = level.columns.rightCols(moves);
  level.descent(shape, directions, texture, change);
  centre(change);
  level.gram.bottomRows(moves) = (change.transpose() * level.columns).cast<double>();
  level.gram.topRightCorner(textures_, moves) = level.gram.bottomLeftCorner(moves, textures_).transpose();
  find_normal(level, w);
}

void Fitter::look(Pyramid& pyramid, const Level& level, Fit& fit, Seen& seen) const {
  level.sample(pyramid, transform(fit.pose, model_.shape(fit.c)), seen.texture);
  const Sums sums(seen.texture);
  const auto values = static_cast<double>(seen.texture.size());
  fit.offset = sums.colours.sum() / values;
  seen.norm = std::sqrt(std::max(0.0, sums.square - values * fit.offset * fit.offset));
  fit.error = 1;
  fit.residual = seen.norm / std::sqrt(values);
  fit.gain = fit.detail = 0;
  if (seen.norm < 1e-3) return;
  const Eigen::VectorXf products = level.columns.leftCols(textures_).transpose() * seen.texture;
  seen.products = products.cast<double>() / seen.norm;
  const Eigen::VectorXd w = weights(fit);
  const double likeness = w.dot(seen.products), size = w.dot(level.gram.topLeftCorner(textures_, textures_) * w);
  if (likeness <= 0) return;
  fit.gain = seen.norm * likeness / size;
  fit.error = std::max(0.0, 1 - likeness * likeness / size);
  fit.residual *= std::sqrt(fit.error);
  const Eigen::Array3d expected = (level.colours.transpose() * w).array();
  const Eigen::Array3d picture = (sums.colours - fit.offset * values / 3) / seen.norm;
  const double sizes = (size - 3 * expected.square().sum() / values) * (1 - 3 * picture.square().sum() / values);
  if (sizes > 0) fit.detail = (likeness - 3 * (expected * picture).sum() / values) / std::sqrt(sizes);
}

Eigen::VectorXd Fitter::step(const Level& level, const Fit& at, const Seen& seen) const {
  const auto moves = level.columns.cols() - textures_;
  const Eigen::VectorXd w = weights(at);
  const Eigen::VectorXf products = level.columns.rightCols(moves).transpose() * seen.texture;
  Eigen::VectorXd difference(level.columns.cols());
  difference << seen.products.head(textures_), products.cast<double>() / seen.norm;
  const Eigen::VectorXd expected = level.gram.leftCols(textures_) * w;
  difference *= w.dot(expected.head(textures_)) / w.dot(seen.products.head(textures_));
  difference -= expected;
  difference -= level.along * (level.weights.dot(difference.head(textures_)) / level.size);
  const double noise = std::max(noise_, at.error / static_cast<double>(level.columns.rows()));
  Eigen::MatrixXd normal = level.normal;
  normal.diagonal().head(modes_) += noise * model_.combined_variances.cwiseInverse();
  normal.diagonal().array() += 1e-9 * normal.diagonal().mean();
  return normal.llt().solve(jacobian_.transpose() * difference);
}

Fit Fitter::moved(const Fit& from, const Eigen::VectorXd& step, double limit) const {
  Fit to = from;
  to.c -= step.head(modes_);
  const Eigen::ArrayXd bound = limit * model_.combined_variances.array().sqrt();
  to.c = to.c.array().min(bound).max(-bound);
  to.pose = compose(from.pose, small_pose(-step.tail<pose_parameters>()));
  return to;
}

void Fitter::evaluate(Pyramid& pyramid, std::size_t level, Fit& fit) {
  look(pyramid, levels_.at(level), fit, best_seen_);
}

Fit Fitter::fit(Pyramid& pyramid, std::size_t level, const Fit& start, const FitOptions& options) {
  Level& at = levels_.at(level);
  Fit best = start;
  look(pyramid, at, best, best_seen_);
  double linearised_at = std::numeric_limits<double>::infinity();
  for (int round = 0; round < options.iterations && best.gain > 0; ++round) {
    if (method_ == FitMethod::inverse_compositional && best.error < stale * linearised_at) {
      linearise(at, best);
      linearised_at = best.error;
    }
    const Eigen::VectorXd full = step(at, best, best_seen_);
    const double before = best.error;
    for (const double length : {1.0, 1.5, 0.5, 0.25}) {
      Fit trial = moved(best, length * full, options.limit);
      look(pyramid, at, trial, trial_seen_);
      if (trial.error < before) {
        best = std::move(trial);
        std::swap(best_seen_, trial_seen_);
        break;
      }
    }
    if (before - best.error <= options.tolerance * before) break;
  }
  return best;
}

Fit Fitter::descend(Pyramid& pyramid, Fit at, const FitOptions& options) {
  for (std::size_t level = levels_.size(); level-- > 0;) at = fit(pyramid, level, at, options);
  return at;
}

Fit Fitter::coarse_to_fine(Pyramid& pyramid, const Fit& start, const FitOptions& options) {
  Fit best = descend(pyramid, start, options);
  if (options.reach == 0) return best;
  const double own_error = noise_ * static_cast<double>(levels_.front().columns.rows());
  const double shift = options.reach * model_.mean_shape.col(0).cwiseAbs().maxCoeff();
  for (const auto& [x, y] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    if (best.error < doubtful * own_error) break;
    Fit beside = start;
    beside.pose = compose(start.pose, {1, 0, shift * x, shift * y});
    beside = descend(pyramid, beside, options);
    if (beside.error < best.error) best = std::move(beside);
  }
  return best;
}

}  // namespace talkgraph
