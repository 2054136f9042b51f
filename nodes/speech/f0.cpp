#include "nodes/speech/f0.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <stdexcept>

#include "nodes/types/best_path.h"

namespace talkgraph {
namespace {

using Eigen::Index;
using std::numbers::pi;

constexpr double periods = 3;  // of the floor in a frame

cv::Mat row(Eigen::VectorXd& v) { return {1, static_cast<int>(v.size()), CV_64F, v.data()}; }

/// Autocorrelation of a Hann window of length 1, 1 at lag 0.
double hann_autocorrelation(double lag) {
  return (1 - lag) * (2.0 / 3 + std::cos(2 * pi * lag) / 3) + std::sin(2 * pi * lag) / (2 * pi);
}

/// Largest sample in the middle of a frame, within one period of the floor.
double middle_peak(const F0& how, const Eigen::Ref<const Eigen::VectorXd>& frame, double sample_rate) {
  const auto n = std::min(frame.size(), static_cast<Index>(sample_rate / how.floor) + 1);
  return frame.segment((frame.size() - n) / 2, n).cwiseAbs().maxCoeff();
}

/// Cost of going from one candidate to the next, 10 ms apart.
double transition(const F0& how, const F0Candidate& a, const F0Candidate& b) {
  const bool from = a.f0 > 0, to = b.f0 > 0;
  if (from != to) return how.voicing_cost;
  return from ? how.octave_jump_cost * std::abs(std::log2(a.f0 / b.f0)) : 0;
}

double local_score(const F0& how, const F0Candidate& c, double loudness) {
  if (c.f0 > 0) return c.strength - how.octave_cost * std::log2(how.ceiling / c.f0);
  const double quiet =
      how.silence_threshold > 0 ? 2 - loudness * (1 + how.voicing_threshold) / how.silence_threshold : 0;
  return how.voicing_threshold + std::max(0.0, quiet);
}

/// Which candidate each frame takes, hundredths of a second apart.
std::vector<Index> chosen_candidates(const F0& how, const std::vector<std::vector<F0Candidate>>& frames,
                                     const Eigen::VectorXd& loudness, double hundredths) {
  const auto size = [&](Index t) { return static_cast<Index>(frames[static_cast<std::size_t>(t)].size()); };
  const auto at = [&](Index t, Index i) -> const F0Candidate& {
    return frames[static_cast<std::size_t>(t)][static_cast<std::size_t>(i)];
  };
  const auto scores = [&](Index t) -> Eigen::VectorXd {
    return Eigen::VectorXd::NullaryExpr(size(t), [&](Index i) { return local_score(how, at(t, i), loudness[t]); });
  };
  const auto steps = [&](Index t) -> Eigen::MatrixXd {
    return Eigen::MatrixXd::NullaryExpr(
        size(t - 1), size(t), [&](Index i, Index j) { return -hundredths * transition(how, at(t - 1, i), at(t, j)); });
  };
  return best_path(static_cast<Index>(frames.size()), scores, steps).states;
}

void bridge(Eigen::Ref<Eigen::VectorXd> f0) {
  Index before = -1;
  for (Index t = 0; t < f0.size(); ++t) {
    if (f0[t] <= 0) continue;
    if (before < 0) f0.head(t).setConstant(f0[t]);
    for (Index i = before + 1; before >= 0 && i < t; ++i)
      f0[i] =
          f0[before] * std::pow(f0[t] / f0[before], static_cast<double>(i - before) / static_cast<double>(t - before));
    before = t;
  }
  if (before >= 0) f0.tail(f0.size() - 1 - before).setConstant(f0[before]);
}

}  // namespace

NormalisedAutocorrelation::NormalisedAutocorrelation(Index length, double sample_rate, Index longest) {
  const auto size = std::bit_ceil(static_cast<std::size_t>(length + longest + 2));
  const auto finer = std::bit_ceil(static_cast<std::size_t>(std::ceil(64000 / sample_rate)));
  lags_per_second_ = sample_rate * static_cast<double>(finer);
  window_.resize(length);
  for (Index i = 0; i < length; ++i)
    window_[i] = 0.5 - 0.5 * std::cos(2 * pi * (static_cast<double>(i) + 0.5) / static_cast<double>(length));
  padded_.setZero(static_cast<Index>(size));
  bins_.resize(padded_.size());
  lags_.resize(padded_.size() * static_cast<Index>(finer));
  out_.setZero((longest + 1) * static_cast<Index>(finer));
  window_lags_.resize(out_.size());
  for (Index i = 0; i < out_.size(); ++i)
    window_lags_[i] =
        hann_autocorrelation(static_cast<double>(i) / static_cast<double>(length * static_cast<Index>(finer)));
}

const Eigen::VectorXd& NormalisedAutocorrelation::operator()(const Eigen::Ref<const Eigen::VectorXd>& frame) {
  padded_.head(window_.size()) = (frame.array() - frame.mean()) * window_.array();
  cv::Mat bins = row(bins_), lags = row(lags_);
  cv::dft(row(padded_), bins);
  cv::mulSpectrums(bins, bins, bins, 0, true);
  // Zeros above the spectrum put the lags between samples in: band-limited interpolation.
  lags_.setZero();
  lags_.head(bins_.size()) = bins_;
  if (lags_.size() > bins_.size()) lags_[bins_.size() - 1] /= 2;  // the Nyquist bin is now two
  cv::dft(lags, lags, cv::DFT_INVERSE | cv::DFT_REAL_OUTPUT);
  const double power = lags_[0];
  if (power > 0)
    out_ = lags_.head(out_.size()).array() / (power * window_lags_.array());
  else
    out_.setZero();
  return out_;
}

void f0_candidates(const F0& how, const Eigen::VectorXd& r, double lags_per_second, std::vector<F0Candidate>& out) {
  out.assign(1, {});
  const auto first = std::max<Index>(1, static_cast<Index>(lags_per_second / how.ceiling));
  const auto rank = [&](const F0Candidate& c) { return c.strength + how.octave_cost * std::log2(c.f0 / how.floor); };
  for (Index i = first; i + 1 < r.size(); ++i) {
    if (!(r[i] > how.voicing_threshold / 2 && r[i] > r[i - 1] && r[i] >= r[i + 1])) continue;
    const double slope = (r[i + 1] - r[i - 1]) / 2, curve = 2 * r[i] - r[i - 1] - r[i + 1],
                 peak = r[i] + slope * slope / (2 * curve);
    const F0Candidate c{lags_per_second / (static_cast<double>(i) + slope / curve), peak > 1 ? 1 / peak : peak};
    if (c.f0 <= how.ceiling && c.f0 >= how.floor) out.push_back(c);
  }
  const auto keep = std::min(out.size(), static_cast<std::size_t>(how.candidates));
  std::stable_sort(out.begin() + 1, out.end(), [&](const auto& a, const auto& b) { return rank(a) > rank(b); });
  out.resize(keep);
}

Track F0::operator()(const Frames& frames) const {
  const auto count = frames.values.rows(), length = frames.values.cols();
  const double period = frames.sample_rate / floor;
  if (ceiling <= floor) throw std::invalid_argument("the ceiling of f0 must lie above its floor");
  if (static_cast<double>(length) < periods * period - 1)
    throw std::invalid_argument(fmt::format("frames of {:.4g} s are too short for a fundamental of {} Hz: cut {:.4g} s",
                                            static_cast<double>(length) / frames.sample_rate, floor, periods / floor));
  Track out;
  out.rate = frames.rate;
  out.start = frames.start;
  out.names = {"f0", "voicing"};
  out.values.setZero(count, 2);

  NormalisedAutocorrelation autocorrelation(length, frames.sample_rate, static_cast<Index>(period) + 2);
  std::vector<std::vector<F0Candidate>> candidates(static_cast<std::size_t>(count));
  Eigen::VectorXd loudness(count), frame(length);
  for (Index t = 0; t < count; ++t) {
    const auto row = frames.values.row(t);
    frame = row.array() - row.mean();
    if (frame.cwiseAbs().maxCoeff() < 1e-12 * row.cwiseAbs().maxCoeff()) frame.setZero();  // rounding errors
    loudness[t] = middle_peak(*this, frame, frames.sample_rate);
    f0_candidates(*this, autocorrelation(frame), autocorrelation.lags_per_second(),
                  candidates[static_cast<std::size_t>(t)]);
  }
  if (const double loudest = loudness.maxCoeff(); loudest > 0) loudness /= loudest;

  const auto path = chosen_candidates(*this, candidates, loudness, 0.01 * frames.rate.value());
  for (Index t = 0; t < count; ++t) {
    const auto i = static_cast<std::size_t>(t);
    const auto& chosen = candidates[i][static_cast<std::size_t>(path[i])];
    out.values.row(t) << chosen.f0, chosen.strength;
  }
  if (unvoiced == Unvoiced::bridged) bridge(out.values.col(0));
  return out;
}

void describe(Description<F0>& d) {
  d.type("speech.f0")
      .summary("fundamental frequency and voicing of each frame")
      .source("Boersma 1993; Praat, To Pitch (ac)");
  d.input("frames", "T x samples, without a window, of at least 3 / floor seconds");
  d.output("track", "T x 2: f0 in Hz, voicing (0 in unvoiced frames, up to 1)");
  d.param("floor", &F0::floor).positive().unit("Hz").doc("lowest fundamental");
  d.param("ceiling", &F0::ceiling).positive().unit("Hz").doc("highest fundamental");
  d.param("candidates", &F0::candidates).within(2, 1000).doc("of a frame, with the unvoiced one");
  d.param("silence_threshold", &F0::silence_threshold)
      .within(0, 1)
      .doc("frames whose peak is below this share of the loudest tend to be unvoiced");
  d.param("voicing_threshold", &F0::voicing_threshold).within(0, 1).doc("strength that a voiced frame needs");
  d.param("octave_cost", &F0::octave_cost).at_least(0).doc("favours high fundamentals, per octave");
  d.param("octave_jump_cost", &F0::octave_jump_cost).at_least(0).doc("of a jump, per octave and 10 ms");
  d.param("voicing_cost", &F0::voicing_cost).at_least(0).doc("of a change of voicing, per 10 ms");
  d.param("unvoiced", &F0::unvoiced)
      .doc("f0 of unvoiced frames: zero, or bridged, interpolated in log f0 between voiced ones");
}

}  // namespace talkgraph
