#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "nodes/types/visemes.h"

namespace talkgraph::testing {

/// Contexts straight from their definition (docs/method.md §5), as dictionaries of words and without any care for cost.
class WrittenOutContexts {
 public:
  using Word = std::vector<std::string>;

  struct Settings {
    std::size_t order = 0;
    double prune = 0, keep = 0, min_windows = 1;
  };

  WrittenOutContexts(const std::vector<Word>& streams, const Settings& settings) : settings_(settings) {
    for (const auto& stream : streams)
      for (std::size_t i = 0; i < stream.size(); ++i) {
        alphabet.insert(stream[i]);
        ++total_;
        for (std::size_t n = 1; n <= settings.order + 1 && i + n <= stream.size(); ++n)
          ++count_[Word(stream.begin() + static_cast<std::ptrdiff_t>(i),
                        stream.begin() + static_cast<std::ptrdiff_t>(i + n))];
      }
    find_memories();
    find_windows(streams);
  }

  std::set<std::string> alphabet;
  std::set<Word> memories = {{}};
  std::map<std::string, std::int64_t> windows;

  static std::string joined(const Word& word) {
    std::string text;
    for (const auto& symbol : word) text += (text.empty() ? "" : "-") + symbol;
    return text;
  }

  std::map<std::string, double> next(const Word& word) const {
    std::map<std::string, double> p;
    double sum = 0;
    for (const auto& symbol : alphabet)
      if (const Word longer = word_and(word, symbol); share(longer) > settings_.prune) sum += p[symbol] = count(longer);
    for (auto& entry : p) entry.second /= sum;
    return p;
  }

  Word longest_memory(Word word) const {
    while (!memories.contains(word)) word.erase(word.begin());
    return word;
  }

  /// The label of each symbol and its probability, from a memory on.
  std::vector<std::pair<Word, double>> read(const Word& stream, Word memory = {}) const {
    std::vector<std::pair<Word, double>> labels;
    for (const auto& symbol : stream) {
      const auto p = next(memory);
      const bool goes_on = p.contains(symbol);
      const Word label = goes_on ? word_and(memory, symbol) : Word{symbol};
      labels.emplace_back(label, goes_on ? p.at(symbol) : 0);
      memory = goes_on || next({}).contains(symbol) ? longest_memory(label) : Word{};
    }
    return labels;
  }

  double bits(const Word& stream, const Word& memory, double floor) const {
    double sum = 0;
    for (const auto& step : read(stream, memory)) sum -= std::log2(std::max(step.second, floor));
    return sum;
  }
  double best_path_bits(const Word& stream, double floor) const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& memory : memories) least = std::min(least, bits(stream, memory, floor));
    return least;
  }

  Word state(Word word) const {
    const auto enough = [&](const Word& w) { return count(w) > 0 && count(w) >= settings_.min_windows; };
    while (word.size() > 1 && !(windows.contains(joined(word)) && enough(word))) word.erase(word.begin());
    if (enough(word) || !viseme(word[0])) return word;
    Word commonest;
    for (const auto& symbol : alphabet)
      if (viseme(symbol) == viseme(word[0]) && (commonest.empty() || count({symbol}) > count(commonest)))
        commonest = {symbol};
    return !commonest.empty() && (enough(commonest) || count(word) == 0) ? commonest : word;
  }

  /// Algorithm 4: label and first symbol of each segment.
  std::vector<std::pair<std::string, std::size_t>> segments(const Word& stream) const {
    const auto labels = read(stream);
    std::vector<std::pair<std::string, std::size_t>> found;
    for (std::size_t end = stream.size(); end > 0;) {
      Word label = state(labels[end - 1].first);
      if (label.size() > end) label = state(Word(label.end() - static_cast<std::ptrdiff_t>(end), label.end()));
      end -= label.size();
      found.emplace(found.begin(), joined(label), end);
    }
    return found;
  }

 private:
  static Word word_and(Word word, const std::string& symbol) {
    word.push_back(symbol);
    return word;
  }
  static Word suffix(const Word& word) { return {word.begin() + 1, word.end()}; }

  double count(const Word& word) const {
    const auto found = count_.find(word);
    return found == count_.end() ? 0 : found->second;
  }
  double share(const Word& word) const { return count(word) / total_; }

  double gain(const Word& word) const {
    double sum = 0;
    const auto shorter = next(suffix(word));
    for (const auto& [symbol, p] : next(word)) sum += p * std::log(p / shorter.at(symbol));
    return share(word) * sum;
  }

  void find_memories() {
    std::vector<Word> candidates = {{}};
    while (!candidates.empty()) {
      const Word word = candidates.back();
      candidates.pop_back();
      if (!word.empty() && gain(word) >= settings_.keep)
        for (Word kept = word; !kept.empty(); kept = suffix(kept)) memories.insert(kept);
      if (word.size() == settings_.order) continue;
      for (const auto& symbol : alphabet) {
        Word longer = word;
        longer.insert(longer.begin(), symbol);
        if (share(longer) > settings_.prune) candidates.push_back(longer);
      }
    }
  }

  void find_windows(const std::vector<Word>& streams) {
    for (const auto& symbol : alphabet) windows[symbol] = static_cast<std::int64_t>(count({symbol}));
    for (const auto& stream : streams)
      for (auto [label, p] : read(stream)) {
        while (!label.empty() && count(label) < settings_.min_windows) label.erase(label.begin());
        if (!label.empty()) windows[joined(label)] = static_cast<std::int64_t>(count(label));
      }
  }

  Settings settings_;
  std::map<Word, double> count_;
  double total_ = 0;
};

}  // namespace talkgraph::testing
