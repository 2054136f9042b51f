#include "nodes/latent/clock.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace talkgraph {

Eigen::MatrixXd times_of(const std::vector<std::int64_t>& lengths, DynamicsForm form) {
  Eigen::MatrixXd times(std::accumulate(lengths.begin(), lengths.end(), std::int64_t{0}), 1);
  Eigen::Index row = 0;
  for (const auto length : lengths)
    for (std::int64_t t = 0; t < length; ++t)
      times(row++, 0) = form == DynamicsForm::time ? static_cast<double>(t)
                                                   : (static_cast<double>(t) + 0.5) / static_cast<double>(length);
  return times;
}

Eigen::MatrixXd spread_times(const Eigen::MatrixXd& times, double inverse_width, Eigen::Index most) {
  const double first = times.minCoeff(), last = times.maxCoeff();
  const double wanted = 1 + std::ceil(2 * (last - first) * std::sqrt(inverse_width));
  return Eigen::VectorXd::LinSpaced(static_cast<Eigen::Index>(std::min(static_cast<double>(most), wanted)), first,
                                    last);
}

}  // namespace talkgraph
