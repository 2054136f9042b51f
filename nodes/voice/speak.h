#pragma once

#include "graph/description.h"
#include "nodes/voice/voice.h"

namespace talkgraph {

/// Speech for a text, with its phones and words. Errors as of talkgraph::speak.
struct Speak {
  Voice voice;

  Utterance operator()(const Transcript& transcript) const;
};
void describe(Description<Speak>& d);
void parameters(Parameters<Voice>& p);

}  // namespace talkgraph
