#pragma once

#include "graph/description.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// All scores of one sequence together, as far as there are any. Throws std::runtime_error if two have one name.
struct JoinScores {
  Scores operator()(const Scores& a, const Scores* b, const Scores* c, const Scores* d, const Scores* e,
                    const Scores* f, const Scores* g) const;
};
void describe(Description<JoinScores>& d);

}  // namespace talkgraph
