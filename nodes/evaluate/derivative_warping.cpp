#include "nodes/evaluate/derivative_warping.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace talkgraph {
namespace {

/// The least sum of squares on the way to a pair of frames, and how many pairs it is of.
struct Way {
  double sum = std::numeric_limits<double>::infinity();
  double pairs = 0;
};

}  // namespace

Eigen::VectorXd warping_slopes(const Eigen::VectorXd& x) {
  if (x.size() < 3) return {};
  const auto n = x.size() - 2;
  return ((x.segment(1, n) - x.head(n)) + (x.tail(n) - x.head(n)) / 2) / 2;
}

double derivative_warping(const Eigen::VectorXd& a, const Eigen::VectorXd& b, Eigen::Index window) {
  const Eigen::VectorXd u = warping_slopes(a), v = warping_slopes(b);
  if (u.size() == 0 || v.size() == 0) return NAN;
  const auto reach = std::max(window, std::abs(u.size() - v.size()));
  std::vector<Way> row(static_cast<std::size_t>(v.size()) + 1), above;  // column 0 is before the first frame of b
  row[0].sum = 0;
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    above.assign(row.size(), {});
    std::swap(row, above);
    for (auto j = std::max<Eigen::Index>(0, i - reach); j <= std::min(v.size() - 1, i + reach); ++j) {
      const auto at = static_cast<std::size_t>(j) + 1;
      const Way before =
          std::min({above[at - 1], above[at], row[at - 1]}, [](const Way& x, const Way& y) { return x.sum < y.sum; });
      row[at] = {before.sum + std::pow(u(i) - v(j), 2), before.pairs + 1};
    }
  }
  return std::sqrt(row.back().sum / row.back().pairs);
}

}  // namespace talkgraph
