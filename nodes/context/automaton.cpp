#include "nodes/context/automaton.h"

#include <algorithm>
#include <map>

namespace talkgraph {
namespace {

using Symbols = std::vector<std::int64_t>;

/// The state of the longest suffix; the empty memory is a suffix of all.
class SuffixStates {
 public:
  explicit SuffixStates(const Vlmm& vlmm) {
    for (std::size_t i = 0; i < vlmm.states.size(); ++i) index_[vlmm.states[i].memory] = static_cast<std::int64_t>(i);
  }
  std::int64_t longest(const Symbols& string) const {
    for (auto from = string.begin();; ++from)
      if (const auto it = index_.find(Symbols(from, string.end())); it != index_.end()) return it->second;
  }

 private:
  std::map<Symbols, std::int64_t> index_;
};

}  // namespace

void connect_states(Vlmm& vlmm) {
  const SuffixStates states(vlmm);
  for (auto& state : vlmm.states) {
    state.next.assign(vlmm.alphabet.size(), -1);
    Symbols longer = state.memory;
    longer.push_back(0);
    for (std::size_t s = 0; s < vlmm.alphabet.size(); ++s) {
      longer.back() = static_cast<std::int64_t>(s);
      if (state.probability[s] > 0) state.next[s] = states.longest(longer);
    }
  }
}

std::vector<std::string> context_labels(const Vlmm& vlmm, const std::vector<std::string>& phones) {
  const auto index = [&](const std::string& phone) -> std::int64_t {
    const auto it = std::lower_bound(vlmm.alphabet.begin(), vlmm.alphabet.end(), phone);
    return it != vlmm.alphabet.end() && *it == phone ? it - vlmm.alphabet.begin() : -1;
  };
  std::vector<std::string> labels;
  std::size_t state = 0;  // the empty memory
  for (const auto& phone : phones) {
    const auto symbol = index(phone);
    auto next = symbol < 0 ? -1 : vlmm.states[state].next[static_cast<std::size_t>(symbol)];
    std::string label;
    if (next >= 0)
      for (const auto s : vlmm.states[state].memory) label += vlmm.alphabet[static_cast<std::size_t>(s)] + "-";
    labels.push_back(label + phone);
    if (next < 0 && symbol >= 0) next = vlmm.states[0].next[static_cast<std::size_t>(symbol)];
    state = static_cast<std::size_t>(std::max<std::int64_t>(next, 0));
  }
  return labels;
}

std::string trainable_suffix(const Vlmm& vlmm, const std::string& label) {
  std::string suffix = label;
  while (!vlmm.trainable(suffix)) {
    const auto dash = suffix.find('-');
    if (dash == std::string::npos) break;
    suffix.erase(0, dash + 1);
  }
  return suffix;
}

}  // namespace talkgraph
