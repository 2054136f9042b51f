#include "nodes/speech/lsf.h"

#include <fmt/format.h>

#include <stdexcept>

#include "nodes/speech/line_spectrum.h"

namespace talkgraph {
namespace {

/// A track like `from` with the step's answer for each frame, whose columns are named `name`1, `name`2 ...
template <class Step>
Track converted(const Track& from, const std::string& name, Step step) {
  Track out = from;
  out.names.clear();
  for (Eigen::Index k = 1; k <= from.dimension(); ++k) out.names.push_back(name + std::to_string(k));
  Eigen::VectorXd in(from.dimension()), made(from.dimension());
  for (Eigen::Index t = 0; t < from.frames(); ++t) {
    in = from.values.row(t);
    if (!in.allFinite()) throw std::runtime_error(fmt::format("frame {} of the track has NaN or infinite values", t));
    step(in, made);
    out.values.row(t) = made;
  }
  return out;
}

void warn_of(Eigen::Index mirrored, Eigen::Index frames, Context& context) {
  if (mirrored > 0)
    context.warn(
        fmt::format("{} of {} frames have predictors that are not of minimum phase: roots were mirrored into "
                    "the unit circle",
                    mirrored, frames));
}

}  // namespace

Track Lsf::operator()(const Track& lpc, Context& context) const {
  LineSpectrum spectrum;
  Eigen::Index mirrored = 0;
  Track out =
      converted(lpc, "lsf", [&](const Eigen::VectorXd& a, Eigen::VectorXd& lsf) { mirrored += !spectrum(a, lsf); });
  warn_of(mirrored, lpc.frames(), context);
  return out;
}

Track FromLsf::operator()(const Track& lsf) const {
  check_spacing(spacing, lsf.dimension());
  return converted(lsf, "a", [&](Eigen::VectorXd& frequencies, Eigen::VectorXd& a) {
    keep_apart(spacing, frequencies);
    predictor_of(frequencies, a);
  });
}

Track Reflection::operator()(const Track& lpc, Context& context) const {
  Eigen::Index mirrored = 0;
  Track out = converted(lpc, "k", [&](const Eigen::VectorXd& a, Eigen::VectorXd& k) {
    if (step_down(a, k)) return;
    step_down(minimum_phase(a), k);
    ++mirrored;
  });
  warn_of(mirrored, lpc.frames(), context);
  return out;
}

void describe(Description<Lsf>& d) {
  d.type("speech.lsf").summary("line spectral frequencies of predictors").source("Thesis §3.2");
  d.input("lpc", "T x order, of speech.lpc").output("lsf", "T x order, rad a sample, ascending in (0, π)");
}

void describe(Description<FromLsf>& d) {
  d.type("speech.from_lsf").summary("predictors of line spectral frequencies").source("Thesis §3.2");
  d.input("lsf", "T x order, rad a sample").output("lpc", "T x order: a_1 ... a_p of A(z) = 1 - Σ a_k z^-k");
  d.param("spacing", &FromLsf::spacing).at_least(0).unit("rad").doc("least distance of two frequencies");
}

void describe(Description<Reflection>& d) {
  d.type("speech.reflection").summary("reflection coefficients of predictors").source("Thesis §3.2");
  d.input("lpc", "T x order, of speech.lpc").output("reflection", "T x order, between -1 and 1");
}

}  // namespace talkgraph
