#pragma once

#include <map>
#include <string>
#include <vector>

#include "graph/value.h"

namespace talkgraph {

/// A variable length Markov model of phones as a probabilistic automaton
/// (docs/method.md §5, thesis §5.2.1). Its symbols are the phones of video frames, or of
/// runs of equal frames. Phones are written as indices into `alphabet`; labels
/// as phones joined by '-', oldest first.
struct Vlmm {
  /// A memory w of at most `order` phones, oldest first.
  struct State {
    std::vector<std::int64_t> memory;
    std::vector<double> probability;  ///< of each next phone
    std::vector<std::int64_t> next;   ///< state after each phone, -1 where there is no transition
  };

  std::int64_t order = 6;
  bool repeating = true;                          ///< one symbol a frame; false: one a run of equal frames
  std::vector<std::string> alphabet;              ///< sorted
  std::vector<State> states;                      ///< the first is the empty memory
  std::map<std::string, std::int64_t> occupancy;  ///< training frames that carry each label
  std::map<std::string, std::int64_t> windows;    ///< trainable labels and how often each occurs in training

  /// Single phones of the alphabet always are.
  bool trainable(const std::string& label) const { return windows.contains(label); }
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
