#include "nodes/phones/recognise.h"

#include "nodes/media/audio_file.h"
#include "nodes/phones/boundaries.h"
#include "nodes/phones/decoder_pool.h"
#include "nodes/phones/pocketsphinx.h"
#include "nodes/phones/sound.h"

namespace talkgraph {

PhoneTrack Recognise::operator()(const Audio& audio, const PhoneTrack* known, Context& context) const {
  if (known) return *known;
  if (is_blank(audio)) return all_silence(audio);
  context.warn("no transcript: more than half of the phones recognised will be wrong; give a transcript if you can");
  const Audio sound = resampled(audio, kSphinxRate);
  const auto phones = decoder_pool<SphinxPhoneLoop>().take()->decode(sphinx_samples(sound));
  return phones.empty() ? all_silence(audio) : phone_track(phones, phone_starts(phones, sound), audio.seconds());
}

void describe(Description<Recognise>& d) {
  d.type("phones.recognise")
      .version(3)
      .summary("phones of speech whose words are not known; more than half are wrong")
      .stored();
  d.source("PocketSphinx 0.8+5prealpha with its en-us model");
  d.input("audio", "the speech").input("known", "phones that are known already, passed on");
  d.output("phones", "with their times");
}

}  // namespace talkgraph
