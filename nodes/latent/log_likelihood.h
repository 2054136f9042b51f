#pragma once

#include <optional>

#include "graph/description.h"
#include "nodes/types/report.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// How likely a track is under a trained model with a density of its own (Ppca, Gmm, Hmm, Lds): "log_likelihood",
/// ln p(measured frames) over their number; nothing for a track without any. A lost frame counts as not observed.
///
/// Throws std::runtime_error on a model of another type, on other dimensions than the model's, on values that are not
/// finite, and where ln p is not.
struct LogLikelihood {
  std::optional<Scores> operator()(const Value& model, const Track& track) const;
};
void describe(Description<LogLikelihood>& d);

}  // namespace talkgraph
