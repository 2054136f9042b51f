#include "nodes/context/perplexity.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nodes/context/automaton.h"
#include "nodes/types/visemes.h"

namespace talkgraph {

Table ContextPerplexity::operator()(const Vlmm& vlmm, const Collected<FrameLabels>& labels) const {
  double bits = 0, missed = 0, symbols = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    AutomatonReader reader(vlmm);
    for (const auto& unit : units(labels[i].labels, !vlmm.repeating)) {
      if (is_end_pause(unit.phone)) continue;
      const double p = reader.read(unit.phone).probability;
      bits -= std::log2(std::max(p, floor));
      missed += p == 0;
      ++symbols;
    }
  }
  if (symbols == 0) throw std::runtime_error("perplexity of no frame: is the selection empty?");
  const double entropy = bits / symbols;
  return {"Perplexity of phonetic contexts",
          "streams",
          {"perplexity", "entropy", "missed", "symbols", "memories", "labels"},
          {"all"},
          {{std::exp2(entropy), entropy, missed / symbols, symbols, static_cast<double>(vlmm.states.size()),
            static_cast<double>(vlmm.windows.size())}}};
}

void describe(Description<ContextPerplexity>& d) {
  d.type("context.perplexity").summary("how well the contexts predict other phone streams");
  d.source("Thesis §5.2.2, Eqns 5.25 and 5.26");
  d.input("vlmm", "the contexts").input("labels", "phones at the video rate").output("table", "one row");
  d.param("floor", &ContextPerplexity::floor).within(1e-12, 1).doc("least probability of a phone");
}

}  // namespace talkgraph
