#include "nodes/phones/recognise.h"

#include <fmt/format.h>

#include <stdexcept>

#include "nodes/phones/decoder_pool.h"
#include "nodes/phones/pocketsphinx.h"
#include "nodes/phones/sound.h"

namespace talkgraph {

PhoneTrack Recognise::operator()(const Audio& audio, const PhoneTrack* known, Context& context) const {
  if (known) return *known;
  if (is_blank(audio)) return all_silence(audio);
  if (audio.seconds() > kLongest)
    throw std::runtime_error(fmt::format(
        "phones.recognise: the sound lasts {:.0f} s, PocketSphinx takes at most {:.0f} s at once; cut it at a pause",
        audio.seconds(), kLongest));
  context.warn("no transcript: about four in ten of the phones recognised will be wrong; give a transcript if you can");
  const auto phones = decoder_pool<SphinxPhoneLoop>().take()->decode(sphinx_samples(audio));
  return phones.empty() ? all_silence(audio) : phone_track(phones, audio.seconds());
}

void describe(Description<Recognise>& d) {
  d.type("phones.recognise")
      .summary("phones of speech whose words are not known; about four in ten are wrong")
      .stored();
  d.source("PocketSphinx 0.8+5prealpha with its en-us model");
  d.input("audio", "the speech").input("known", "phones that are known already, passed on");
  d.output("phones", "with their times");
}

}  // namespace talkgraph
