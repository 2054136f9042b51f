#pragma once

#include <cstddef>
#include <vector>

#include "graph/description.h"
#include "graph/random.h"

namespace talkgraph {

/// Where a quantity lies with a given confidence; NaN if nothing can be said.
struct ConfidenceInterval {
  double low, high;
};

enum class IntervalKind { student, bootstrap };
template <>
inline constexpr EnumNames<IntervalKind, 2> enum_names<IntervalKind>{
    {{IntervalKind::student, "student"}, {IntervalKind::bootstrap, "bootstrap"}}};

/// NaN of nothing.
double mean_of(const std::vector<double>& values);
/// Of values in rising order, that below which a share of them lies, interpolated linearly; NaN of nothing.
double quantile_of(const std::vector<double>& sorted, double share);
/// Of a sample, that is divided by n − 1; NaN of fewer than two values.
double deviation_of(const std::vector<double>& values);

/// Of the mean of normal values: mean ± t_{n−1} s/√n (Student 1908). NaN of fewer than two values.
ConfidenceInterval student_interval(const std::vector<double>& values, double confidence);

/// Of the mean of values of any distribution: quantiles of the means of `samples` draws with replacement (Efron 1979,
/// the percentile method), interpolated linearly. NaN of fewer than two values.
ConfidenceInterval bootstrap_interval(const std::vector<double>& values, double confidence, int samples,
                                      Random& random);

/// Of a share, `part` of `whole`, whose cases are independent: the shares that a test by the normal approximation would
/// not reject (Wilson 1927); within 0 and 1 also where all or none are part. NaN of nothing. Throws
/// std::invalid_argument if the part is larger than the whole.
ConfidenceInterval wilson_interval(std::size_t part, std::size_t whole, double confidence);

}  // namespace talkgraph
