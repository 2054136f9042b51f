#pragma once

#include "graph/description.h"
#include "nodes/types/lip_reader.h"
#include "nodes/types/phones.h"
#include "nodes/types/report.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// The units that are read in a track, one a frame: the likeliest path through the reader's network, every unit after
/// the first weighing e^insertion. Lost frames count as not observed. Throws std::runtime_error if the track has
/// another dimension than the reader, or values that are not finite.
std::vector<std::string> read_lips(const LipReader& reader, const Track& track, double insertion);

/// What of the speech can be read off a face that may be synthetic: the units read, one a run, against those that were
/// said. Of N said, pauses left out, H are read right, D are missed, S taken for others, and I read that were not said,
/// by the cheapest edits (HTK's costs: 10 a substitution, 7 a unit missing or extra):
///   x_correct   H/N = (N − D − S)/N
///   x_accuracy  (N − D − S − I)/N, below 0 if much is read that was not said
/// Nothing is given for a sequence without speech. Throws as read_lips does, on a label that is no phone, and if
/// lengths differ by more than two frames.
struct ScoreLipReading {
  std::string name = "phone";  ///< x
  double insertion = 0;

  std::optional<Scores> operator()(const LipReader& reader, const Track& track, const FrameLabels& labels) const;
};
void describe(Description<ScoreLipReading>& d);

}  // namespace talkgraph
