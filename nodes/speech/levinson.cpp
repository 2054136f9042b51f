#include "nodes/speech/levinson.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talkgraph {

void levinson(const Eigen::Ref<const Eigen::VectorXd>& r, LinearPrediction& out) {
  const auto order = r.size() - 1;
  auto& a = out.a;
  a.setZero(order);
  out.reflection.setZero(order);
  out.error = std::max(0.0, r[0]);
  const double rounding = std::numeric_limits<double>::epsilon() * r[0];
  for (Eigen::Index m = 0; m < order && out.error > rounding; ++m) {
    double rest = r[m + 1];
    for (Eigen::Index i = 0; i < m; ++i) rest -= a[i] * r[m - i];
    const double k = rest / out.error;
    if (!(std::abs(k) < 1)) break;
    step_up(a, m, k);
    out.reflection[m] = k;
    out.error *= 1 - k * k;
  }
}

void step_up(Eigen::VectorXd& a, Eigen::Index m, double k) {
  for (Eigen::Index i = 0, j = m - 1; i <= j; ++i, --j) {
    const double front = a[i], back = a[j];
    a[i] = front - k * back;
    a[j] = back - k * front;
  }
  a[m] = k;
}

}  // namespace talkgraph
