#include "nodes/phones/recognise.h"

#include "nodes/phones/decoder_pool.h"
#include "nodes/phones/pocketsphinx.h"
#include "nodes/phones/sound.h"

namespace talkgraph {

PhoneTrack Recognise::operator()(const Audio& audio, const PhoneTrack* known, Context& context) const {
  if (known) return *known;
  if (is_blank(audio)) return all_silence(audio);
  context.log("no transcript: phones are recognised, about 40 % of them will be wrong; give a transcript if you can");
  const auto phones = decoder_pool<SphinxPhoneLoop>().take()->decode(sphinx_samples(audio));
  return phones.empty() ? all_silence(audio) : phone_track(phones, audio.seconds());
}

void describe(Description<Recognise>& d) {
  d.type("phones.recognise").summary("phones of speech whose words are not known; about 40 % are wrong").stored();
  d.source("PocketSphinx 0.8+5prealpha with its en-us model");
  d.input("audio").input("known", "phones that are known already, passed on");
  d.output("phones");
}

}  // namespace talkgraph
