#include "nodes/mapping/trajectory_fit.h"

#include <algorithm>
#include <vector>

#include "nodes/latent/cholesky.h"

// LAPACK: Cholesky factor of a band matrix, and solution with it.
extern "C" {
void dpbtrf_(const char* part, const int* n, const int* beside, double* band, const int* stride, int* info,
             std::size_t part_length);
void dpbtrs_(const char* part, const int* n, const int* beside, const int* columns, const double* band,
             const int* stride, double* b, const int* b_stride, int* info, std::size_t part_length);
}

namespace talkgraph {

namespace {

using Entries = std::vector<Eigen::Triplet<double>>;

TrajectoryRows rows_of(Eigen::Index rows, Eigen::Index frames, const Entries& entries) {
  TrajectoryRows w(rows, frames);
  w.setFromTriplets(entries.begin(), entries.end());
  return w;
}

Entries frames_themselves(Eigen::Index frames) {
  Entries entries;
  for (Eigen::Index t = 0; t < frames; ++t) entries.emplace_back(t, t, 1.0);
  return entries;
}

void add_slopes(Entries& entries, Eigen::Index frames) {
  for (Eigen::Index t = 0; t < frames; ++t) {
    entries.emplace_back(frames + t, std::min(t + 1, frames - 1), 0.5);
    entries.emplace_back(frames + t, std::max<Eigen::Index>(t - 1, 0), -0.5);
  }
}

/// Coefficients of the difference of an order: 1; −1, 1; 1, −2, 1; ...
Eigen::VectorXd difference(Eigen::Index order) {
  Eigen::VectorXd c = Eigen::VectorXd::Zero(order + 1);
  c(0) = 1;
  for (Eigen::Index i = 0; i < order; ++i)
    for (Eigen::Index j = i + 1; j >= 0; --j) c(j) = (j > 0 ? c(j - 1) : 0.0) - c(j);
  return c;
}

/// Lower band of WᵀPW: entry (i − j, j) is that of row i and column j.
Eigen::MatrixXd normal_band(const TrajectoryRows& rows, const Eigen::VectorXd& precisions) {
  using Row = TrajectoryRows::InnerIterator;
  Eigen::Index beside = 0;
  for (Eigen::Index r = 0; r < rows.rows(); ++r) {
    const Row first(rows, r);
    for (Row entry(rows, r); entry; ++entry) beside = std::max(beside, entry.col() - first.col());
  }
  Eigen::MatrixXd band = Eigen::MatrixXd::Zero(beside + 1, rows.cols());
  for (Eigen::Index r = 0; r < rows.rows(); ++r)
    for (Row a(rows, r); a; ++a)
      for (Row b = a; b; ++b) band(b.col() - a.col(), a.col()) += precisions(r) * a.value() * b.value();
  return band;
}

}  // namespace

TrajectoryRows frames_and_slopes(Eigen::Index frames) {
  Entries entries = frames_themselves(frames);
  add_slopes(entries, frames);
  return rows_of(2 * frames, frames, entries);
}

TrajectoryRows frames_slopes_and_curvatures(Eigen::Index frames) {
  Entries entries = frames_themselves(frames);
  add_slopes(entries, frames);
  for (Eigen::Index t = 0; t < frames; ++t) {
    entries.emplace_back(2 * frames + t, std::min(t + 1, frames - 1), 1);
    entries.emplace_back(2 * frames + t, t, -2);
    entries.emplace_back(2 * frames + t, std::max<Eigen::Index>(t - 1, 0), 1);
  }
  return rows_of(3 * frames, frames, entries);
}

TrajectoryRows frames_and_differences(Eigen::Index frames, Eigen::Index order) {
  Entries entries = frames_themselves(frames);
  const Eigen::VectorXd coefficients = difference(order);
  const Eigen::Index differences = std::max<Eigen::Index>(frames - order, 0);
  for (Eigen::Index t = 0; t < differences; ++t)
    for (Eigen::Index i = 0; i <= order; ++i) entries.emplace_back(frames + t, t + i, coefficients(i));
  return rows_of(frames + differences, frames, entries);
}

Eigen::MatrixXd blocks_beside(const TrajectoryRows& rows, Eigen::Index blocks, const Eigen::MatrixXd& frames) {
  const Eigen::Index length = frames.rows();
  const Eigen::MatrixXd below = rows * frames;
  Eigen::MatrixXd beside(length, blocks * frames.cols());
  for (Eigen::Index b = 0; b < blocks; ++b)
    beside.middleCols(b * frames.cols(), frames.cols()) = below.middleRows(b * length, length);
  return beside;
}

Eigen::MatrixXd blocks_beside(TrajectoryRows (*rows_of)(Eigen::Index), Eigen::Index blocks,
                              const Eigen::MatrixXd& frames, const std::vector<std::int64_t>& lengths) {
  Eigen::MatrixXd all(frames.rows(), blocks * frames.cols());
  Eigen::Index start = 0;
  for (const auto length : lengths) {
    all.middleRows(start, length) = blocks_beside(rows_of(length), blocks, frames.middleRows(start, length));
    start += length;
  }
  return all;
}

TrajectoryFit::TrajectoryFit(const TrajectoryRows& rows, Eigen::VectorXd precisions, Eigen::VectorXd targets)
    : rows_(rows),
      precisions_(std::move(precisions)),
      targets_(std::move(targets)),
      trajectory_(rows.transpose() * precisions_.cwiseProduct(targets_)),
      band_(normal_band(rows, precisions_)) {
  const int n = static_cast<int>(band_.cols()), stride = static_cast<int>(band_.rows()), beside = stride - 1;
  int info = 0;
  dpbtrf_("L", &n, &beside, band_.data(), &stride, &info, 1);
  if (info != 0 || !band_.allFinite())
    throw FactorisationError("what is expected of a trajectory does not determine it: raise the floor of variances");
  solve(trajectory_);
}

void TrajectoryFit::solve(Eigen::VectorXd& b) const {
  const int n = static_cast<int>(band_.cols()), stride = static_cast<int>(band_.rows()), beside = stride - 1, one = 1,
            b_stride = std::max(n, 1);
  int info = 0;
  dpbtrs_("L", &n, &beside, &one, band_.data(), &stride, b.data(), &b_stride, &info, 1);
}

TrajectoryFit::Gradient TrajectoryFit::gradient(Eigen::VectorXd by_frames) const {
  solve(by_frames);
  const Eigen::VectorXd moved = rows_ * by_frames;
  return {moved.cwiseProduct(targets_ - rows_ * trajectory_), moved.cwiseProduct(precisions_)};
}

}  // namespace talkgraph
