#pragma once

#include <vector>

#include "nodes/types/phones.h"

namespace talkgraph {

/// Where the articulators stand at one moment. All zero is a mouth at rest.
struct Articulators {
  double jaw = 0;         ///< 0 closed, 1 wide open
  double width = 0;       ///< -1 narrow, 1 spread
  double protrusion = 0;  ///< 0 flat, 1 pushed out and rounded
  double upper_lip = 0;   ///< 1 raised off the upper teeth
  double lower_lip = 0;   ///< 1 dropped off the lower teeth
  double closure = 0;     ///< 1 lips pressed together, as on p, b, m
  double bite = 0;        ///< 1 lower lip at the upper teeth, as on f, v
  double tongue_tip = 0;  ///< 0 low, 1 behind the upper teeth, as on l
  double tongue_out = 0;  ///< 1 between the teeth, as on th, dh
};

/// How much is put into an utterance: 1 is plain speech.
struct Effort {
  double opening = 1;  ///< scales the jaw and the lips apart; louder and slower speech opens more
};

/// Articulators at the frame centres (n + 0.5) / rate. Every phone has targets
/// that it pulls the articulators to with a strength that falls off in time
/// (dominance functions of Cohen & Massaro 1993), so that phones colour their
/// neighbours; closure, bite and tongue_out are held during their phones
/// whatever the neighbours do. Throws std::runtime_error on an unknown phone.
std::vector<Articulators> articulate(const PhoneTrack& phones, Rational rate, std::int64_t frames,
                                     const Effort& effort);

}  // namespace talkgraph
