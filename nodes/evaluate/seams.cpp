#include "nodes/evaluate/seams.h"

#include "nodes/types/paired.h"
#include "nodes/types/visemes.h"

namespace talkgraph {

std::optional<Scores> Seams::operator()(const Track& track, const SegmentTrack& segments) const {
  common_frames("the sequence", track.frames(), "frames of the track", segments.frames, "of the segments");
  double at_seams = 0, inside = 0;
  int seams = 0, steps = 0;
  for (const auto& s : segments.segments) {
    const auto end = is_end_pause(s.label) ? s.start + 1 : s.start + s.length;
    for (auto t = std::max<std::int64_t>(s.start, 1); t < end && t < track.values.rows(); ++t) {
      const double step = (track.values.row(t) - track.values.row(t - 1)).norm();
      (t == s.start ? at_seams : inside) += step;
      ++(t == s.start ? seams : steps);
    }
  }
  if (seams == 0 || steps == 0 || inside == 0) return {};
  return Scores{{{"step", (at_seams / seams) / (inside / steps)}}};
}

void describe(Description<Seams>& d) {
  d.type("evaluate.seams").summary("whether a track jumps where its segments meet");
  d.input("track", "visual parameters")
      .input("segments", "of that track")
      .output("scores", "step: mean step where segments meet, as a share of the mean step inside them");
}

}  // namespace talkgraph
