#include "nodes/context/automaton.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "nodes/types/visemes.h"

namespace talkgraph {
std::vector<Unit> units(const std::vector<std::string>& symbols, bool runs) {
  std::vector<Unit> all;
  for (std::size_t t = 0; t < symbols.size(); ++t) {
    const bool joins = runs || is_end_pause(symbols[t]);
    if (joins && !all.empty() && all.back().symbol == symbols[t])
      ++all.back().length;
    else
      all.push_back({symbols[t], static_cast<std::int64_t>(t), 1});
  }
  return all;
}

std::vector<std::string> symbols(std::vector<std::string> phones, bool visemes) {
  for (std::size_t t = 0; t < phones.size(); ++t)
    if (phones[t].empty() || phones[t].find('-') != std::string::npos)
      throw std::runtime_error(
          fmt::format("frame {}: \"{}\" cannot be a phone: name it without '-', which joins the phones of a context", t,
                      phones[t]));
  if (visemes)
    for (auto& phone : phones)
      if (!is_end_pause(phone)) phone = viseme_label(phone).value_or(phone);
  return phones;
}

std::vector<Unit> units(const Vlmm& vlmm, const std::vector<std::string>& phones) {
  return units(symbols(phones, vlmm.visemes), !vlmm.repeating);
}

std::int64_t index_of(const Vlmm& vlmm, const std::string& symbol) {
  const auto it = std::lower_bound(vlmm.alphabet.begin(), vlmm.alphabet.end(), symbol);
  return it != vlmm.alphabet.end() && *it == symbol ? it - vlmm.alphabet.begin() : -1;
}

std::size_t state_after(const Vlmm& vlmm, std::size_t state, std::int64_t symbol) {
  if (symbol < 0) return 0;
  const auto at = static_cast<std::size_t>(symbol);
  const auto next = vlmm.states[state].next[at];
  return static_cast<std::size_t>(std::max<std::int64_t>(next >= 0 ? next : vlmm.states[0].next[at], 0));
}

AutomatonReader::Step AutomatonReader::read(const std::string& symbol) {
  const auto s = index_of(vlmm_, symbol);
  const auto& before = vlmm_.states[state_];
  state_ = state_after(vlmm_, state_, s);
  if (s < 0 || before.next[static_cast<std::size_t>(s)] < 0) return {symbol, 0};
  const std::string memory = memory_label(vlmm_, before.memory);
  return {memory + (memory.empty() ? "" : "-") + symbol, before.probability[static_cast<std::size_t>(s)]};
}

namespace {

/// The commonest phone of the same viseme; the symbol itself where there is none.
std::string commonest_alike(const Vlmm& vlmm, const std::string& symbol) {
  const auto wanted = viseme(symbol);
  std::int64_t most = 0;
  std::string alike = symbol;
  for (const auto& phone : vlmm.alphabet) {
    if (!wanted || viseme(phone) != wanted || vlmm.windows.at(phone) <= most) continue;
    most = vlmm.windows.at(phone);
    alike = phone;
  }
  return alike;
}

}  // namespace

std::string state_label(const Vlmm& vlmm, const std::string& context) {
  std::string suffix = context;
  while (!vlmm.trainable(suffix)) {
    const auto dash = suffix.find('-');
    if (dash == std::string::npos) break;
    suffix.erase(0, dash + 1);
  }
  if (vlmm.trainable(suffix)) return suffix;
  std::string alike = commonest_alike(vlmm, suffix);
  return vlmm.trainable(alike) || !vlmm.windows.contains(suffix) ? alike : suffix;
}

std::string state_label(const Vlmm& vlmm, const std::string& context, std::int64_t most) {
  std::string label = state_label(vlmm, context);
  if (phone_count(label) <= most) return label;
  const auto phones = label_phones(label);
  return state_label(vlmm, join_phones(phones, phones.size() - static_cast<std::size_t>(most), phones.size()));
}

std::vector<std::string> state_labels(const Vlmm& vlmm) {
  std::vector<std::string> labels;
  for (const auto& [label, count] : vlmm.windows)
    if (state_label(vlmm, label) == label) labels.push_back(label);
  return labels;
}

std::int64_t phone_count(const std::string& label) { return 1 + std::count(label.begin(), label.end(), '-'); }

}  // namespace talkgraph
