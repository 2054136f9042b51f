#pragma once

#include <map>
#include <string>
#include <vector>

#include "graph/value.h"

namespace talkgraph {

/// A variable length Markov model of phones as a probabilistic automaton
/// (docs/method.md §5, thesis §5.2.1). Its symbols are the phones of video frames, or of
/// runs of equal frames, or their visemes. They are written as indices into `alphabet`; labels
/// as phones joined by '-', oldest first.
struct Vlmm {
  /// A memory w of at most `order` symbols, oldest first.
  struct State {
    std::vector<std::int64_t> memory;
    std::vector<double> probability;  ///< of each next symbol
    std::vector<std::int64_t> next;   ///< state after each symbol, -1 where there is no transition
    double end = 0;                   ///< share of the memory's occurrences at the end of a stream
  };

  std::int64_t order = 6;
  bool repeating = true;                          ///< one symbol a frame; false: one a run of equal frames
  bool visemes = false;                           ///< the symbols are visemes (viseme_label), not phones
  std::vector<std::string> alphabet;              ///< sorted
  std::vector<State> states;                      ///< the first is the empty memory
  std::map<std::string, std::int64_t> occupancy;  ///< training frames that carry each label
  /// How often each label that is worth a state occurs in training, and each symbol of the alphabet.
  std::map<std::string, std::int64_t> windows;
  std::int64_t min_windows = 1;  ///< fewest of a label that can be trained

  bool trainable(const std::string& label) const {
    const auto found = windows.find(label);
    return found != windows.end() && found->second >= min_windows;
  }
};
template <>
inline constexpr PortType port_type<Vlmm>{"Vlmm", 3};
/// Throws std::runtime_error if what is loaded does not fit together.
void fields(Archive& ar, Vlmm& v);

/// Training frames read in a state's memory. Those for which there was no transition count for the first state.
std::int64_t frames_read(const Vlmm& v, std::size_t state);

/// {3, 1, 4} -> "k-ae-t"
std::string memory_label(const Vlmm& v, const std::vector<std::int64_t>& memory);
/// "k-ae-t" -> {"k", "ae", "t"}
std::vector<std::string> label_phones(const std::string& label);
/// The inverse, of phones[from] to phones[to - 1].
std::string join_phones(const std::vector<std::string>& phones, std::size_t from, std::size_t to);
/// The phone that a label ends in.
std::string last_phone(const std::string& label);

/// What speaks for a label, met in training or not: what its longest suffix has that has any, itself included; else
/// what the label has that `ending` names for its last phone; else none.
template <class Value>
const Value* value_for_label(const std::string& label, const std::map<std::string, Value>& values,
                             const std::map<std::string, std::string>& ending) {
  for (std::size_t from = 0;;) {
    if (const auto found = values.find(label.substr(from)); found != values.end()) return &found->second;
    const auto dash = label.find('-', from);
    if (dash == std::string::npos) break;
    from = dash + 1;
  }
  const auto found = ending.find(last_phone(label));
  return found == ending.end() ? nullptr : &values.at(found->second);
}

}  // namespace talkgraph
