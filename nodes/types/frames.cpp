#include "nodes/types/frames.h"

namespace talkgraph {

void fields(Archive& ar, Frames& f) {
  ar("values", f.values);
  ar("rate", f.rate);
  ar("start", f.start);
  ar("sample_rate", f.sample_rate);
}

void fields(Archive& ar, Spectrum& s) {
  ar("values", s.values);
  ar("rate", s.rate);
  ar("start", s.start);
  ar("sample_rate", s.sample_rate);
  ar("power", s.power);
}

}  // namespace talkgraph
