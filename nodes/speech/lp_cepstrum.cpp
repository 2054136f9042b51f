#include "nodes/speech/lp_cepstrum.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talkgraph {

void lp_cepstrum(const LinearPrediction& predictor, Eigen::Ref<Eigen::VectorXd> out) {
  const auto& a = predictor.a;
  const auto order = a.size();
  out[0] = std::log(std::max(predictor.error, std::numeric_limits<double>::min()));
  for (Eigen::Index n = 1; n < out.size(); ++n) {
    double sum = 0;
    for (Eigen::Index k = 1; k <= std::min(order, n - 1); ++k)
      sum += static_cast<double>(n - k) * a[k - 1] * out[n - k];
    out[n] = sum / static_cast<double>(n) + (n <= order ? a[n - 1] : 0);
  }
}

}  // namespace talkgraph
