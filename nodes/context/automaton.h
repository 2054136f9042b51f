#pragma once

#include <string>
#include <vector>

#include "nodes/types/vlmm.h"

namespace talkgraph {

/// A stretch of frames that is one symbol of a Markov model.
struct Unit {
  std::string symbol;
  std::int64_t start = 0, length = 1;  ///< frames
};

/// The symbols of a stream's frames, or of its runs of equal frames. A pause at
/// an end (is_end_pause) is always one.
std::vector<Unit> units(const std::vector<std::string>& symbols, bool runs);

/// The phones of frames, or their visemes; pauses at an end and what has no viseme stay as they are. Throws
/// std::runtime_error if a name is empty or holds '-'.
std::vector<std::string> symbols(std::vector<std::string> phones, bool visemes);

/// A stream of phones as a model reads it.
std::vector<Unit> units(const Vlmm& vlmm, const std::vector<std::string>& phones);

/// Index in the alphabet, -1 for an unknown symbol.
std::int64_t index_of(const Vlmm& vlmm, const std::string& symbol);

/// The state after a symbol (-1: an unknown one, which clears the memory). Without a transition for it the memory
/// restarts with the symbol.
std::size_t state_after(const Vlmm& vlmm, std::size_t state, std::int64_t symbol);

/// Walks the automaton along a stream of symbols, from the empty memory.
class AutomatonReader {
 public:
  explicit AutomatonReader(const Vlmm& vlmm) : vlmm_(vlmm) {}

  struct Step {
    std::string label;       ///< the memory before the symbol, and the symbol; without a transition the symbol alone
    double probability = 0;  ///< of the symbol after that memory; 0 if there is no transition
  };
  Step read(const std::string& symbol);

 private:
  const Vlmm& vlmm_;
  std::size_t state_ = 0;
};

/// The label whose state speaks for a context: its longest trainable suffix; for a phone that is unknown or has too few
/// training windows, the phone of its viseme with most of them; if there is none, or that has too few too, the phone.
std::string state_label(const Vlmm& vlmm, const std::string& context);
/// The same where only the last `most` phones of the context are there; `most` ≥ 1.
std::string state_label(const Vlmm& vlmm, const std::string& context, std::int64_t most);
/// The labels that have a state of their own.
std::vector<std::string> state_labels(const Vlmm& vlmm);

/// How many phones a label has.
std::int64_t phone_count(const std::string& label);

}  // namespace talkgraph
