#include "nodes/speech/preemphasis.h"

namespace talkgraph {

Audio PreEmphasis::operator()(const Audio& audio) const {
  const auto n = audio.samples.size();
  if (n == 0) return audio;
  Audio out{Eigen::VectorXd(n), audio.rate};
  out.samples[0] = before == BeforeFirst::zero ? audio.samples[0] : (1 - k) * audio.samples[0];
  out.samples.tail(n - 1) = audio.samples.tail(n - 1) - k * audio.samples.head(n - 1);
  return out;
}

void describe(Description<PreEmphasis>& d) {
  d.type("speech.preemphasis")
      .version(2)
      .summary("lifts high frequencies: x'[t] = x[t] - k x[t-1]")
      .source("Thesis §3.2, Eqn 3.22");
  d.input("audio", "at any rate").output("audio", "of the same rate and length");
  d.param("k", &PreEmphasis::k).within(0, 1).doc("strength; 0 switches it off");
  d.param("before", &PreEmphasis::before)
      .doc("x[-1]: zero, as in python_speech_features and SPTK's dfs, or the first sample once more (repeat)");
}

Frames FramePreEmphasis::operator()(const Frames& frames) const {
  const auto n = frames.values.cols();
  Frames out = frames;
  if (n == 0) return out;
  out.values.col(0) *= 1 - k;
  out.values.rightCols(n - 1) -= k * frames.values.leftCols(n - 1);
  return out;
}

void describe(Description<FramePreEmphasis>& d) {
  d.type("speech.frame_preemphasis")
      .summary("lifts high frequencies in each frame: x'[t] = x[t] - k x[t-1], x'[0] = (1 - k) x[0]")
      .source("HTK Book, PREEMCOEF; Kaldi");
  d.input("frames", "T x samples").output("frames", "the same, lifted");
  d.param("k", &FramePreEmphasis::k).within(0, 1).doc("strength; 0 switches it off");
}

}  // namespace talkgraph
