#include "nodes/evaluate/join.h"

#include <stdexcept>

namespace talkgraph {

Scores JoinScores::operator()(const Scores& a, const Scores* b, const Scores* c, const Scores* d, const Scores* e,
                              const Scores* f, const Scores* g) const {
  Scores all = a;
  for (const Scores* more : {b, c, d, e, f, g}) {
    if (!more) continue;
    for (const auto& score : more->values)
      if (!all.values.insert(score).second) throw std::runtime_error("two inputs have a score \"" + score.first + "\"");
  }
  return all;
}

void describe(Description<JoinScores>& d) {
  d.type("evaluate.join").summary("scores of several nodes as one");
  d.input("a", "of each sequence");
  for (const char* name : {"b", "c", "d", "e", "f", "g"}) d.input(name, "more scores of these sequences");
  d.output("scores", "all of them");
}

}  // namespace talkgraph
