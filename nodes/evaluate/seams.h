#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"
#include "nodes/types/segments.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Does the face jump where one segment ends and the next begins?
///   step  mean change between the two frames at a seam / mean change between
///         neighbouring frames inside segments of speech
/// A recorded track scored with the same segments says what is natural: phones
/// change there, so that a face moves more at seams than elsewhere. Nothing is
/// given without a seam, or where nothing moves inside the segments. Throws
/// std::runtime_error if lengths differ by more than two frames.
struct Seams {
  std::optional<Scores> operator()(const Track& track, const SegmentTrack& segments) const;
};
void describe(Description<Seams>& d);

}  // namespace talkgraph
