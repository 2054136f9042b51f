#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Scores of each dimension by itself, a row each: mean and standard deviation over sequences of
///   acc    correlation, 0 where either does not vary
///   l1     mean absolute error (Eqn 6.1)
///   l2     root mean square error (Eqn 6.2)
///   mse    mean squared error (Eqn 6.3)
///   linf   largest absolute error of a frame (Eqn 6.4)
///   range  standard deviation, prediction / truth
/// Frames count as in evaluate.score. Sequences that an input lacks, and those without a frame that counts, are left
/// out. Throws std::runtime_error, naming the sequence, as scored_frames does, and if sequences differ in dimension.
struct ScoreDimensions {
  std::string title = "Scores of each dimension";

  Table operator()(const Collected<Track>& truth, const Collected<Track>& predicted,
                   const Collected<Mask>& speech) const;
};
void describe(Description<ScoreDimensions>& d);

}  // namespace talkgraph
