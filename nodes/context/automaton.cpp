#include "nodes/context/automaton.h"

#include <algorithm>

#include "nodes/types/visemes.h"

namespace talkgraph {
namespace {

/// Index in the sorted alphabet, -1 for an unknown phone.
std::int64_t symbol(const Vlmm& vlmm, const std::string& phone) {
  const auto it = std::lower_bound(vlmm.alphabet.begin(), vlmm.alphabet.end(), phone);
  return it != vlmm.alphabet.end() && *it == phone ? it - vlmm.alphabet.begin() : -1;
}

}  // namespace

std::vector<Unit> units(const std::vector<std::string>& phones, bool runs) {
  std::vector<Unit> all;
  for (std::size_t t = 0; t < phones.size(); ++t) {
    const bool joins = runs || is_end_pause(phones[t]);
    if (joins && !all.empty() && all.back().phone == phones[t])
      ++all.back().length;
    else
      all.push_back({phones[t], static_cast<std::int64_t>(t), 1});
  }
  return all;
}

AutomatonReader::Step AutomatonReader::read(const std::string& phone) {
  const auto s = symbol(vlmm_, phone);
  if (s < 0) {
    state_ = 0;
    return {phone, 0};
  }
  const auto at = static_cast<std::size_t>(s);
  const auto& before = vlmm_.states[state_];
  Step step{phone, 0};
  auto next = before.next[at];
  if (next >= 0) {
    std::string memory;
    for (const auto m : before.memory) memory += vlmm_.alphabet[static_cast<std::size_t>(m)] + "-";
    step = {memory + phone, before.probability[at]};
  } else {
    next = vlmm_.states[0].next[at];
  }
  state_ = static_cast<std::size_t>(std::max<std::int64_t>(next, 0));
  return step;
}

std::string state_label(const Vlmm& vlmm, const std::string& context) {
  std::string suffix = context;
  while (!vlmm.trainable(suffix)) {
    const auto dash = suffix.find('-');
    if (dash == std::string::npos) break;
    suffix.erase(0, dash + 1);
  }
  if (vlmm.trainable(suffix)) return suffix;
  const auto wanted = viseme(suffix);
  std::int64_t most = 0;
  std::string alike = suffix;
  for (const auto& phone : vlmm.alphabet) {
    if (!wanted || viseme(phone) != wanted || vlmm.windows.at(phone) <= most) continue;
    most = vlmm.windows.at(phone);
    alike = phone;
  }
  return alike;
}

}  // namespace talkgraph
