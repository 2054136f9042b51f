#include "nodes/media/resample.h"

#include "nodes/media/audio_file.h"

namespace talkgraph {

Audio Resample::operator()(const Audio& audio) const { return resampled(audio, rate); }

void describe(Description<Resample>& d) {
  d.type("media.resample").summary("converts sound to another sample rate");
  d.input("audio", "at any rate").output("audio", "at the new rate, of the same length");
  d.param("rate", &Resample::rate).within(1000, 384000).unit("Hz").doc("samples per second");
}

}  // namespace talkgraph
