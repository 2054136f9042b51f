#include "nodes/types/frames.h"

namespace talkgraph {

void fields(Archive& ar, Frames& f) {
  ar("values", f.values);
  ar("rate", f.rate, "Hz");
  ar("start", f.start, "s");
  ar("sample_rate", f.sample_rate, "Hz");
  ar.note("values", "rate_hz", f.rate.value());
  ar.note("values", "start_s", f.start);
}

void fields(Archive& ar, Spectrum& s) {
  ar("values", s.values);
  ar("rate", s.rate, "Hz");
  ar("start", s.start, "s");
  ar("sample_rate", s.sample_rate, "Hz");
  ar.note("values", "rate_hz", s.rate.value());
  ar.note("values", "start_s", s.start);
  ar.note("values", "bin_hz", s.bin_hz());
  ar("power", s.power);
}

void fields(Archive& ar, Bands& b) {
  ar("centres", b.centres, "Hz");
  ar("nyquist", b.nyquist, "Hz");
}

}  // namespace talkgraph
