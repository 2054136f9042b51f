#pragma once

#include <map>
#include <string>
#include <vector>

#include "graph/value.h"

namespace talkgraph {

/// A variable length Markov model of phones, one symbol a video frame, as a
/// probabilistic automaton (spec §5, thesis §5.2.1). Phones are written as
/// indices into `alphabet`; labels as phones joined by '-', oldest first.
struct Vlmm {
  /// A memory w of at most `order` phones, oldest first.
  struct State {
    std::vector<std::int64_t> memory;
    std::vector<double> probability;  ///< of each next phone
    std::vector<std::int64_t> next;   ///< state after each phone, -1 where that was never seen
  };

  std::int64_t order = 6;
  std::vector<std::string> alphabet;
  std::vector<State> states;                      ///< the first is the empty memory
  std::map<std::string, std::int64_t> occupancy;  ///< training frames that carry each label
  std::map<std::string, std::int64_t> windows;    ///< training windows that equal each label
  std::int64_t min_windows = 1;                   ///< a label with fewer is not trained

  /// Single phones always are, so that every stream has an answer.
  bool trainable(const std::string& label) const;
};
void fields(Archive& ar, Vlmm::State& s);
template <>
inline constexpr PortType port_type<Vlmm>{"Vlmm", 1};
void fields(Archive& ar, Vlmm& v);

/// "k-ae-t" -> {"k", "ae", "t"}
std::vector<std::string> label_phones(const std::string& label);
/// The inverse, of phones[from] to phones[to - 1].
std::string join_phones(const std::vector<std::string>& phones, std::size_t from, std::size_t to);

}  // namespace talkgraph
