#include "nodes/latent/trajectory.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>

#include "nodes/latent/normal.h"

namespace talkgraph {

namespace {

/// What frames t − 1, t and t + 1 weigh in the frame itself, its velocity and its acceleration.
constexpr std::array<std::array<double, 3>, 3> windows{{{0, 1, 0}, {-1, 1, 0}, {1, -2, 1}}};

Eigen::Index neighbour(Eigen::Index t, Eigen::Index offset, Eigen::Index frames) {
  return std::clamp<Eigen::Index>(t + offset, 0, frames - 1);
}

/// Calls `use(change, frame, weight)` for every frame that has a part in what is observed at t.
template <class Use>
void for_each_part(Eigen::Index t, Eigen::Index frames, int order, Use use) {
  for (int change = 0; change <= order; ++change)
    for (Eigen::Index offset = -1; offset <= 1; ++offset)
      if (const double weight = windows[static_cast<std::size_t>(change)][static_cast<std::size_t>(offset + 1)];
          weight != 0)
        use(change, neighbour(t, offset, frames), weight);
}

/// The states of one dimension, whose covariances are diagonal.
TrajectoryStates one_dimension(const TrajectoryStates& states, Eigen::Index dimension) {
  const Eigen::Index changes = 1 + states.order, dims = states.means.cols() / changes;
  const auto entries = Eigen::seqN(dimension, changes, dims);
  TrajectoryStates one{states.means(Eigen::all, entries), {}, states.order};
  for (const Eigen::MatrixXd& variances : states.covariances) one.covariances.emplace_back(variances(entries, 0));
  return one;
}

/// All dimensions together.
Eigen::MatrixXd solve_band(const TrajectoryStates& states, const std::vector<Eigen::Index>& path) {
  const Eigen::Index dims = states.means.cols() / (1 + states.order), frames = std::ssize(path);
  std::vector<Eigen::MatrixXd> precisions;
  for (const Eigen::MatrixXd& covariance : states.covariances) precisions.push_back(precision(covariance));
  std::vector<Eigen::Triplet<double>> band;
  Eigen::MatrixXd pull = Eigen::MatrixXd::Zero(dims, frames);
  for (Eigen::Index t = 0; t < frames; ++t) {
    const Eigen::Index state = path[static_cast<std::size_t>(t)];
    const Eigen::MatrixXd& inverse = precisions[static_cast<std::size_t>(state)];
    const Eigen::VectorXd towards = inverse * states.means.row(state).transpose();
    for_each_part(t, frames, states.order, [&](int change, Eigen::Index frame, double weight) {
      pull.col(frame) += weight * towards.segment(change * dims, dims);
      for_each_part(t, frames, states.order, [&](int other, Eigen::Index column, double times) {
        if (column > frame) return;
        for (Eigen::Index i = 0; i < dims; ++i)
          for (Eigen::Index j = 0; j < dims; ++j)
            band.emplace_back(frame * dims + i, column * dims + j,
                              weight * times * inverse(change * dims + i, other * dims + j));
      });
    });
  }
  Eigen::SparseMatrix<double> matrix(frames * dims, frames * dims);
  matrix.setFromTriplets(band.begin(), band.end());
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>> solver(matrix);
  return solver.solve(pull.reshaped()).reshaped(dims, frames).transpose();
}

}  // namespace

Eigen::MatrixXd with_changes(const Sequences& data, int order) {
  const Eigen::Index dims = data.frames.cols();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(data.frames.rows(), dims * (1 + order));
  Eigen::Index from = 0;
  for (const Eigen::Index length : data.lengths) {
    for (Eigen::Index t = 0; t < length; ++t)
      for_each_part(t, length, order, [&](int change, Eigen::Index frame, double weight) {
        all.row(from + t).segment(change * dims, dims) += weight * data.frames.row(from + frame);
      });
    from += length;
  }
  return all;
}

Eigen::MatrixXd likeliest_trajectory(const TrajectoryStates& states, const std::vector<Eigen::Index>& path) {
  if (path.empty()) return Eigen::MatrixXd(0, states.means.cols() / (1 + states.order));
  if (states.covariances.at(0).cols() > 1) return solve_band(states, path);
  Eigen::MatrixXd trajectory(std::ssize(path), states.means.cols() / (1 + states.order));
  for (Eigen::Index d = 0; d < trajectory.cols(); ++d) trajectory.col(d) = solve_band(one_dimension(states, d), path);
  return trajectory;
}

}  // namespace talkgraph
