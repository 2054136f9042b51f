#include "nodes/voice/speak.h"

namespace talkgraph {

Utterance Speak::operator()(const Transcript& transcript) const { return speak(transcript.text, voice); }

void describe(Description<Speak>& d) {
  d.type("voice.speak").version(1).summary("speaks a text through espeak-ng, with the times of its phones and words");
  d.input("transcript", "English text");
  d.output("audio", &Utterance::audio, "speech at 22050 Hz");
  d.output("phones", &Utterance::phones, "CMU phones, sil in pauses");
  d.output("words", &Utterance::words, "words, sil in pauses");
  d.param("voice", &Speak::voice).doc("how it sounds");
}

void parameters(Parameters<Voice>& p) {
  p.param("name", &Voice::name).doc("voice of espeak-ng: en-us, en-us+f3");
  p.param("rate", &Voice::rate).within(80, 450).unit("words per minute").doc("speaking rate");
  p.param("pitch", &Voice::pitch).within(0, 100).doc("pitch of the voice; 50 is its own");
  p.param("volume", &Voice::volume).within(0, 200).doc("loudness; above 100 it may clip");
}

}  // namespace talkgraph
