#include "nodes/speech/resynthesise.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "graph/random.h"
#include "nodes/speech/lattice.h"

namespace talkgraph {
namespace {

void check(const Track* track, Eigen::Index columns, const char* what) {
  if (track && (track->frames() == 0 || track->dimension() < columns || !track->values.allFinite()))
    throw std::runtime_error(std::string(what) + " must be a track of at least one frame and " +
                             std::to_string(columns) + " finite column(s)");
}

/// Pulses and noise of power 1 and mean 0, mixed by voicing.
class Source {
 public:
  Source(double sample_rate, Random& random) : sample_rate_(sample_rate), random_(random) {}

  double next(double f0, double voicing) {
    const double noise = random_.normal();
    phase_ += f0 / sample_rate_;
    const bool pulse = phase_ >= 1;
    phase_ -= std::floor(phase_);
    const double share = std::min(1.0, f0 / sample_rate_);  // of samples that are pulses
    const double height = pulse ? std::sqrt(1 / share) : 0;
    return std::sqrt(1 - voicing) * noise + std::sqrt(voicing) * (height - std::sqrt(share));
  }

 private:
  double sample_rate_;
  Random& random_;
  double phase_ = 0;
};

/// Fundamental and voicing of a track whose unvoiced frames have the fundamental of the voiced frame before, the first
/// ones that of the frame behind.
Track voiced(const Track& f0, double otherwise) {
  Track out = f0;
  double before = otherwise;
  for (Eigen::Index t = out.frames() - 1; t >= 0; --t)
    if (out.values(t, 0) > 0) before = out.values(t, 0);
  for (Eigen::Index t = 0; t < out.frames(); ++t) {
    auto row = out.values.row(t);
    if (row[0] > 0)
      before = row[0];
    else
      row.head(2) << before, 0;
    row[1] = std::clamp(row[1], 0.0, 1.0);
  }
  return out;
}

}  // namespace

Audio Resynthesise::operator()(const Track& lsf, const Track* gain, const Track* f0_track, const Audio* excitation,
                               Random& random) const {
  check(gain, 1, "the gain");
  check(f0_track, 2, "f0, with its voicing,");
  const double rate = excitation ? excitation->rate : sample_rate;
  const LatticeTrack filters(lsf, rate, step, spacing);
  const Track pitch = f0_track ? voiced(*f0_track, f0) : Track{};
  Source source(rate, random);
  Audio out{Eigen::VectorXd(excitation ? excitation->samples.size() : filters.samples()), rate};
  filters.each(out.samples.size(), [&](Lattice& lattice, Eigen::Index from, Eigen::Index to, double seconds) {
    const Eigen::RowVector2d given(f0, f0 > 0);
    const Eigen::RowVector2d tone = f0_track ? value_at(pitch, seconds).head<2>().eval() : given;
    const double amplitude = gain ? value_at(*gain, seconds)[0] : level;
    for (auto t = from; t < to; ++t)
      out.samples[t] =
          lattice.synthesise(excitation ? excitation->samples[t] : amplitude * source.next(tone[0], tone[1]));
  });
  return out;
}

void describe(Description<Resynthesise>& d) {
  d.type("speech.resynthesise").summary("sound of line spectral frequencies").source("Thesis §5.5");
  d.input("lsf", "T x order, rad a sample")
      .input("gain", "T x 1, of speech.lpc")
      .input("f0", "T x 2: Hz and voicing, of speech.f0")
      .input("excitation", "in place of pulses and noise: of speech.residual");
  d.output("audio", "with the pre-emphasis of what was analysed");
  d.param("sample_rate", &Resynthesise::sample_rate).positive().unit("1/s").doc("of the sound that was analysed");
  d.param("f0", &Resynthesise::f0).at_least(0).unit("Hz").doc("fundamental where none is given; 0: noise");
  d.param("level", &Resynthesise::level).at_least(0).doc("gain where none is given, full scale 1");
  d.param("step", &Resynthesise::step).positive().unit("s").doc("time that a predictor serves");
  d.param("spacing", &Resynthesise::spacing).at_least(0).unit("rad").doc("least distance of two frequencies");
}

}  // namespace talkgraph
