#include "nodes/speech/rasta.h"

#include <cmath>

namespace talkgraph {

double Rasta::pole_at(Rational rate) const {
  return keep == RastaKeep::pole ? pole : std::pow(pole, 100 / rate.value());
}

void Rasta::step(State& state, double pole, Eigen::Ref<Eigen::VectorXd> bands) const {
  auto& x = state.before;
  if (state.frames == 0) {
    x = bands.replicate<1, 4>();
    state.last.setZero(bands.size());
  }
  if (start == RastaStart::steady || state.frames >= 4)
    state.last = 0.2 * (bands - x.col(3)) + 0.1 * (x.col(0) - x.col(2)) + pole * state.last;
  for (const int age : {3, 2, 1}) x.col(age) = x.col(age - 1);
  x.col(0) = bands;
  bands = state.last;
  ++state.frames;
}

Track Rasta::operator()(const Track& track) const {
  Track out = track;
  const double pole = pole_at(track.rate);
  State state;
  Eigen::VectorXd bands;
  for (Eigen::Index t = 0; t < track.frames(); ++t) {
    bands = track.values.row(t);
    step(state, pole, bands);
    out.values.row(t) = bands;
  }
  return out;
}

void describe(Description<Rasta>& d) {
  d.type("speech.rasta")
      .summary("RASTA: band-pass along time of each band")
      .source("Thesis §3.2.5; Hermansky and Morgan 1994");
  d.input("track", "logs of filter outputs").output("track", "the same, filtered");
  d.param("pole", &Rasta::pole).within(0, 0.9999).doc("per frame at 100 frames per second; 0.94: rastamat, 0.98: 1994");
  d.param("keep", &Rasta::keep)
      .doc("at other frame rates the pole, as rastamat does, or its time_constant: the pole is raised to 100 / rate");
  d.param("start", &Rasta::start)
      .doc("zero: the first four frames are 0 (rastamat); steady: as if the first had been there for ever");
}

}  // namespace talkgraph
