#include "nodes/evaluate/explained.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "nodes/types/paired.h"

namespace talkgraph {
namespace {

void check_dimension(const std::string& key, const Track& track, const Track& first) {
  if (track.dimension() != first.dimension())
    throw std::runtime_error(
        fmt::format("{}: {} dimensions, others have {}", key, track.dimension(), first.dimension()));
}

void append(Eigen::MatrixXd& rows, const Eigen::MatrixXd& more) {
  const auto before = rows.rows();
  rows.conservativeResize(before + more.rows(), more.cols());
  rows.bottomRows(more.rows()) = more;
}

std::vector<Eigen::Index> measured_in_both(const Track& a, const Track& b, Eigen::Index frames) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index t = 0; t < frames; ++t)
    if (!a.is_lost(t) && !b.is_lost(t)) rows.push_back(t);
  return rows;
}

Eigen::MatrixXd without(const Eigen::MatrixXd& rows, Eigen::Index from, Eigen::Index to) {
  Eigen::MatrixXd rest(rows.rows() - (to - from), rows.cols());
  rest << rows.topRows(from), rows.bottomRows(rows.rows() - to);
  return rest;
}

}  // namespace

PairedRows paired_rows(const Collected<Track>& truth, const Collected<Track>& by) {
  PairedRows out;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto& key = truth.key(i);
    const Track* other = by.find(key);
    if (!other) continue;
    check_dimension(key, truth[i], truth[0]);
    check_dimension(key, *other, by[0]);
    const auto frames = common_frames(key, truth[i].frames(), "frames to be explained", other->frames(), "frames");
    const auto rows = measured_in_both(truth[i], *other, frames);
    append(out.truth, truth[i].values(rows, Eigen::all));
    append(out.by, other->values(rows, Eigen::all));
  }
  if (out.truth.rows() == 0) throw std::runtime_error("no clip has measured frames in both tracks");
  if (!out.truth.allFinite() || !out.by.allFinite()) throw std::runtime_error("NaN or infinite values explain nothing");
  return out;
}

Eigen::RowVectorXd explained_share(const Eigen::MatrixXd& truth, const Eigen::MatrixXd& by, int folds, double ridge) {
  const auto count = truth.rows();
  if (count < folds || count * (folds - 1) / folds <= by.cols())
    throw std::runtime_error(
        fmt::format("{} frames are too few for {} parts and {} dimensions", count, folds, by.cols()));
  Eigen::RowVectorXd error = Eigen::RowVectorXd::Zero(truth.cols());
  for (Eigen::Index fold = 0; fold < folds; ++fold) {
    const auto from = fold * count / folds, to = (fold + 1) * count / folds;
    Eigen::MatrixXd x = without(by, from, to), y = without(truth, from, to);
    const Eigen::RowVectorXd x_mean = x.colwise().mean(), y_mean = y.colwise().mean();
    x.rowwise() -= x_mean;
    y.rowwise() -= y_mean;
    Eigen::MatrixXd normal = x.transpose() * x;
    normal.diagonal().array() += ridge * normal.diagonal().mean() + std::numeric_limits<double>::min();
    const Eigen::MatrixXd weights = normal.ldlt().solve(x.transpose() * y);
    const Eigen::MatrixXd predicted =
        ((by.middleRows(from, to - from).rowwise() - x_mean) * weights).rowwise() + y_mean;
    error += (truth.middleRows(from, to - from) - predicted).colwise().squaredNorm();
  }
  const Eigen::RowVectorXd spread = (truth.rowwise() - truth.colwise().mean()).colwise().squaredNorm();
  Eigen::RowVectorXd share(truth.cols());
  for (Eigen::Index d = 0; d < truth.cols(); ++d)
    share(d) = spread(d) > 1e-20 * truth.col(d).squaredNorm() ? std::max(0.0, 1 - error(d) / spread(d)) : NAN;
  return share;
}

Table Explained::operator()(const Collected<Track>& truth, const Collected<Track>& by) const {
  const auto rows = paired_rows(truth, by);
  const auto share = explained_share(rows.truth, rows.by, folds, ridge);
  Table table{"Share of the variance explained", "", {}, {"explained"}, {{}}};
  for (Eigen::Index d = 0; d < share.size(); ++d) {
    const auto at = static_cast<std::size_t>(d);
    table.columns.push_back(at < truth[0].names.size() ? truth[0].names[at] : std::to_string(d + 1));
    table.cells[0].push_back(share(d));
  }
  return table;
}

void describe(Description<Explained>& d) {
  d.type("evaluate.explained")
      .version(1)
      .summary("how much of each dimension of a track another track explains linearly, on frames not learnt from");
  d.input("truth", "to be explained")
      .input("by", "what explains it, of the same clips")
      .output("table", "one row, a column a dimension: share of the variance, 0 to 1");
  d.param("folds", &Explained::folds).within(2, 100).doc("parts that the frames are cut into");
  d.param("ridge", &Explained::ridge)
      .within(0, 1e6)
      .doc("penalty, as a share of the mean variance of `by`'s dimensions");
}

}  // namespace talkgraph
