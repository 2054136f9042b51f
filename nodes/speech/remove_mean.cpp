#include "nodes/speech/remove_mean.h"

namespace talkgraph {

Frames RemoveMean::operator()(const Frames& frames) const {
  Frames out = frames;
  if (out.values.size() > 0) out.values.colwise() -= frames.values.rowwise().mean();
  return out;
}

void describe(Description<RemoveMean>& d) {
  d.type("speech.remove_mean").summary("takes each frame's mean off").source("HTK Book, ZMEANSOURCE; Kaldi");
  d.input("frames", "T x samples").output("frames", "the same, without offset");
}

}  // namespace talkgraph
