#include "nodes/context/perplexity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "nodes/context/automaton.h"
#include "nodes/types/visemes.h"

namespace talkgraph {
namespace {

/// Of an utterance as indices into the alphabet, without the pauses at its ends.
std::vector<std::int64_t> utterance(const Vlmm& vlmm, const FrameLabels& labels) {
  std::vector<std::int64_t> all;
  for (const auto& unit : units(vlmm, labels.labels))
    if (!is_end_pause(unit.symbol)) all.push_back(index_of(vlmm, unit.symbol));
  return all;
}

double probability(const Vlmm& vlmm, std::size_t state, std::int64_t symbol) {
  return symbol < 0 ? 0 : vlmm.states[state].probability[static_cast<std::size_t>(symbol)];
}

/// Bits of a stream along the path that makes it likeliest, of those from any memory.
double least_bits(const Vlmm& vlmm, const std::vector<std::int64_t>& stream, double floor) {
  std::map<std::size_t, double> paths;  // the best that end in a state
  for (std::size_t s = 0; s < vlmm.states.size(); ++s) paths[s] = 0;
  for (const auto symbol : stream) {
    std::map<std::size_t, double> longer;
    for (const auto& [state, bits] : paths) {
      const double all = bits - std::log2(std::max(probability(vlmm, state, symbol), floor));
      auto& best = longer.try_emplace(state_after(vlmm, state, symbol), all).first->second;
      best = std::min(best, all);
    }
    paths = std::move(longer);
  }
  double least = std::numeric_limits<double>::infinity();
  for (const auto& path : paths) least = std::min(least, path.second);
  return least;
}

}  // namespace

Table ContextPerplexity::operator()(const Vlmm& vlmm, const Collected<FrameLabels>& labels) const {
  double bits = 0, best = 0, missed = 0, symbols = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const auto stream = utterance(vlmm, labels[i]);
    std::size_t state = 0;
    for (const auto symbol : stream) {
      const double p = probability(vlmm, state, symbol);
      bits -= std::log2(std::max(p, floor));
      missed += p == 0;
      state = state_after(vlmm, state, symbol);
    }
    best += least_bits(vlmm, stream, floor);
    symbols += static_cast<double>(stream.size());
  }
  if (symbols == 0) throw std::runtime_error("perplexity of no frame: is the selection empty?");
  const double entropy = bits / symbols;
  return {"Perplexity of phonetic contexts",
          "streams",
          {"perplexity", "entropy", "best_path", "missed", "symbols", "memories", "trainable"},
          {"all"},
          {{std::exp2(entropy), entropy, best / symbols, missed / symbols, symbols,
            static_cast<double>(vlmm.states.size()), static_cast<double>(state_labels(vlmm).size())}}};
}

void describe(Description<ContextPerplexity>& d) {
  d.type("context.perplexity").version(3).summary("how well the contexts predict other phone streams");
  d.source("Thesis §5.2.2, Eqns 5.25 to 5.27");
  d.input("vlmm", "the contexts").input("labels", "phones at the video rate");
  d.output(
      "table",
      "one row; perplexity: 2 to the power of entropy; entropy: bits a symbol; best_path: entropy along the likeliest "
      "path, bits a symbol; missed: share of symbols without a transition; symbols: frames, or runs of a phone; "
      "memories: those kept; trainable: labels that have a state of their own");
  d.param("floor", &ContextPerplexity::floor).within(1e-12, 1).doc("least probability of a phone");
}

}  // namespace talkgraph
