#include "nodes/statistics/intervals.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace talkgraph {
namespace {

constexpr ConfidenceInterval kUnknown{NAN, NAN};

}  // namespace

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double quantile_of(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return NAN;
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const double next = sorted[std::min(below + 1, sorted.size() - 1)];
  return sorted[below] + (place - static_cast<double>(below)) * (next - sorted[below]);
}

double deviation_of(const std::vector<double>& values) {
  if (values.size() < 2) return NAN;
  const double mean = mean_of(values);
  double squares = 0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

ConfidenceInterval student_interval(const std::vector<double>& values, double confidence) {
  if (values.size() < 2) return kUnknown;
  const auto n = static_cast<double>(values.size());
  const double t = boost::math::quantile(boost::math::students_t(n - 1), (1 + confidence) / 2);
  const double mean = mean_of(values), half = t * deviation_of(values) / std::sqrt(n);
  return {mean - half, mean + half};
}

ConfidenceInterval bootstrap_interval(const std::vector<double>& values, double confidence, int samples,
                                      Random& random) {
  if (values.size() < 2) return kUnknown;
  std::vector<double> means(static_cast<std::size_t>(samples)), drawn(values.size());
  for (double& mean : means) {
    for (double& v : drawn) v = values[random.below(values.size())];
    mean = mean_of(drawn);
  }
  std::sort(means.begin(), means.end());
  return {quantile_of(means, (1 - confidence) / 2), quantile_of(means, (1 + confidence) / 2)};
}

ConfidenceInterval wilson_interval(std::size_t part, std::size_t whole, double confidence) {
  if (part > whole) throw std::invalid_argument("a part must not be larger than the whole");
  if (whole == 0) return kUnknown;
  const double z = boost::math::quantile(boost::math::normal(), (1 + confidence) / 2);
  const auto n = static_cast<double>(whole);
  const double share = static_cast<double>(part) / n, shrink = 1 + z * z / n;
  const double middle = (share + z * z / (2 * n)) / shrink;
  const double half = z / shrink * std::sqrt(share * (1 - share) / n + z * z / (4 * n * n));
  return {part == 0 ? 0 : middle - half, part == whole ? 1 : middle + half};
}

}  // namespace talkgraph
