#include "nodes/speech/lpc.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talkgraph {
namespace {

using Eigen::Index;
using Signal = Eigen::Ref<const Eigen::VectorXd>;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

double mean(double sum, Index count) { return sum / static_cast<double>(std::max<Index>(1, count)); }

void autocorrelation(const Lpc& how, const Signal& x, LpcStep& step) {
  const auto n = x.size();
  auto& r = step.products;
  r.setZero(how.order + 1);
  for (Index m = 0; m < std::min<Index>(n, r.size()); ++m) r[m] = x.head(n - m).dot(x.tail(n - m));
  r[0] *= 1 + how.ridge;
  levinson(r, step.levinson);
  step.a = step.levinson.a;
  step.power = mean(step.levinson.error, n);
}

// Cholesky factor of the products of delayed frames, row by row: the rows that stand are the predictor of lower order.
void covariance(const Lpc& how, const Signal& x, LpcStep& step) {
  const Index p = how.order, n = x.size() - p;
  step.a.setZero(p);
  if (n < 1) {
    step.power = mean(x.squaredNorm(), x.size());
    return;
  }
  const auto delayed = [&](Index k) { return x.segment(p - k, n); };
  auto& factor = step.factor;
  auto& solved = step.products;
  factor.resize(p, p);
  solved.resize(p);
  double power = delayed(0).squaredNorm();
  Index rank = 0;
  for (; rank < p; ++rank) {
    const auto row = delayed(rank + 1);
    for (Index j = 0; j < rank; ++j)
      factor(rank, j) = (row.dot(delayed(j + 1)) - factor.row(rank).head(j).dot(factor.row(j).head(j))) / factor(j, j);
    const double energy = row.squaredNorm() * (1 + how.ridge);
    const double pivot = energy - factor.row(rank).head(rank).squaredNorm();
    if (!(pivot > static_cast<double>(n) * epsilon * energy)) break;
    factor(rank, rank) = std::sqrt(pivot);
    solved[rank] = (row.dot(delayed(0)) - factor.row(rank).head(rank).dot(solved.head(rank))) / factor(rank, rank);
    power -= solved[rank] * solved[rank];
  }
  step.a.head(rank) =
      factor.topLeftCorner(rank, rank).transpose().triangularView<Eigen::Upper>().solve(solved.head(rank));
  step.power = mean(std::max(0.0, power), n);
}

void burg(const Lpc& how, const Signal& x, LpcStep& step) {
  auto& a = step.a;
  auto& forward = step.forward;
  auto& backward = step.backward;
  a.setZero(how.order);
  forward = backward = x;
  step.power = mean(x.squaredNorm(), x.size());
  const double rounding = epsilon * step.power;
  const Index last = std::min<Index>(how.order, x.size() - 1);
  for (Index m = 0; m < last && step.power > rounding; ++m) {
    const Index n = x.size() - 1 - m;
    auto f = forward.tail(n);
    auto b = backward.head(n);  // one sample behind f
    const double energy = (f.squaredNorm() + b.squaredNorm()) * (1 + how.ridge);
    if (!(energy > 0)) break;
    const double k = std::clamp(2 * f.dot(b) / energy, epsilon - 1, 1 - epsilon);
    for (Index i = 0; i < n; ++i) {
      const double ahead = f[i], behind = b[i];
      f[i] = ahead - k * behind;
      b[i] = behind - k * ahead;
    }
    step_up(a, m, k);
    step.power *= 1 - k * k;
  }
}

}  // namespace

void linear_prediction(const Lpc& how, const Signal& frame, LpcStep& step) {
  if (step.weights.size() != frame.size()) step.weights = how.window.weights(frame.size());
  step.weighed = frame.cwiseProduct(step.weights);
  if (how.method == LpcMethod::autocorrelation)
    autocorrelation(how, step.weighed, step);
  else if (how.method == LpcMethod::covariance)
    covariance(how, step.weighed, step);
  else
    burg(how, step.weighed, step);
  step.power /= mean(step.weights.squaredNorm(), frame.size());
}

LpcTracks Lpc::operator()(const Frames& frames) const {
  LpcTracks out;
  out.lpc.rate = out.gain.rate = frames.rate;
  out.lpc.start = out.gain.start = frames.start;
  out.lpc.values.resize(frames.values.rows(), order);
  out.gain.values.resize(frames.values.rows(), 1);
  for (int k = 1; k <= order; ++k) out.lpc.names.push_back("a" + std::to_string(k));
  out.gain.names = {"gain"};
  LpcStep step;
  for (Index t = 0; t < frames.values.rows(); ++t) {
    linear_prediction(*this, frames.values.row(t).transpose(), step);
    out.lpc.values.row(t) = step.a;
    out.gain.values(t, 0) = std::sqrt(step.power);
  }
  return out;
}

void describe(Description<Lpc>& d) {
  d.type("speech.lpc").summary("linear prediction of each frame, and its residual's level").source("Thesis §3.2");
  d.input("frames", "T x samples");
  d.output("lpc", &LpcTracks::lpc, "T x order: a_1 ... a_p of A(z) = 1 - Σ a_k z^-k");
  d.output("gain", &LpcTracks::gain, "T x 1: root mean square of the residual");
  d.param("window", &Lpc::window)
      .doc("what the frames are weighed with first; none by default, hamming suits autocorrelation");
  d.param("method", &Lpc::method)
      .doc("autocorrelation (Levinson-Durbin), covariance (may be unstable) or burg (the lattice)");
  d.param("order", &Lpc::order).within(1, 1000).doc("number of coefficients");
  d.param("ridge", &Lpc::ridge).at_least(0).doc("white noise added, as a share of the energy");
}

}  // namespace talkgraph
