#include "nodes/speech/residual.h"

#include "nodes/speech/lattice.h"

namespace talkgraph {

Audio Residual::operator()(const Audio& audio, const Track& lsf) const {
  Audio out = audio;
  LatticeTrack(lsf, audio.rate, step, spacing)
      .each(out.samples.size(), [&](Lattice& lattice, Eigen::Index from, Eigen::Index to, double) {
        for (auto t = from; t < to; ++t) out.samples[t] = lattice.analyse(out.samples[t]);
      });
  return out;
}

void describe(Description<Residual>& d) {
  d.type("speech.residual").summary("what linear prediction leaves of sound").source("Thesis §3.2");
  d.input("audio", "as it was framed, with pre-emphasis if the frames had it").input("lsf", "T x order, rad a sample");
  d.output("audio", "the residual, of the same rate and length");
  d.param("step", &Residual::step).positive().unit("s").doc("time that a predictor serves");
  d.param("spacing", &Residual::spacing).at_least(0).unit("rad").doc("least distance of two frequencies");
}

}  // namespace talkgraph
