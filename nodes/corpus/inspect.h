#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/recording.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// Looks a recording over before it is trained on. Findings, where there is something to find:
///   sound_rate, sound_seconds, sound_peak
///   fps, frames, width, height, picture_seconds, damaged, damaged_from, damaged_to (frames, as media.check_video sees)
///   blue, green, red (means of the lower face, 0 to 255)
///   transcript, words, phones, landmarks, visual: 1 where the recording has them
///   landmark_frames, landmark_gaps (frames with a point that is not a number)
///   "lag -8" ... "lag 8": how much the mouth follows the sound if it is that many frames late
/// The mouth is what moves from frame to frame in the lower half of the landmarks' box, or without landmarks in the
/// middle of the lower half of the picture; with landmarks of a known scheme, the gap of the inner lips as well.
/// Phones: how often each occurs, as given, else by the pronunciation of the transcript.
/// Throws std::runtime_error naming the file where sound or pictures cannot be read.
struct Inspect {
  int max_lag = 8;

  struct Out {
    Scores findings;
    Scores phones;
  };
  Out operator()(const Recording& recording, Context& context) const;
};
void describe(Description<Inspect>& d);

}  // namespace talkgraph
