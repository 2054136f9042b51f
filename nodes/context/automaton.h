#pragma once

#include <string>
#include <vector>

#include "nodes/types/vlmm.h"

namespace talkgraph {

/// A stretch of frames that is one symbol of a Markov model.
struct Unit {
  std::string phone;
  std::int64_t start = 0, length = 1;  ///< frames
};

/// The symbols of a phone-per-frame stream: its frames, or its runs of equal frames. A pause at
/// an end (is_end_pause) is always one.
std::vector<Unit> units(const std::vector<std::string>& phones, bool runs);

/// Walks the automaton along a stream of symbols, from the empty memory.
class AutomatonReader {
 public:
  explicit AutomatonReader(const Vlmm& vlmm) : vlmm_(vlmm) {}

  struct Step {
    std::string label;       ///< the memory before the phone, and the phone
    double probability = 0;  ///< of the phone after that memory; 0 if there is no transition
  };
  /// Reads a phone. Without a transition for it the label is the phone alone
  /// and the memory restarts with it; an unknown phone or a pause at an end
  /// clears the memory.
  Step read(const std::string& phone);

 private:
  const Vlmm& vlmm_;
  std::size_t state_ = 0;
};

/// The label whose state speaks for a context: its longest trainable suffix;
/// for an unknown phone, the phone of its viseme with most training windows;
/// if there is none, the phone itself.
std::string state_label(const Vlmm& vlmm, const std::string& context);

}  // namespace talkgraph
