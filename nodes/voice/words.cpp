#include "nodes/voice/words.h"

#include <Eigen/Core>
#include <algorithm>
#include <cctype>
#include <cstring>
#include <sstream>

#include "nodes/voice/voice.h"

namespace talkgraph {
namespace {

struct Expected {
  std::string phone;
  int word;
};

bool is_vowel(const std::string& phone) { return std::strchr("aeiou", phone[0]) != nullptr; }

double mismatch(const std::string& a, const std::string& b) {
  if (a == b) return 0;
  return is_vowel(a) == is_vowel(b) ? 0.7 : 1.8;
}

std::vector<Expected> expected_phones(const std::vector<std::string>& words) {
  std::vector<Expected> all;
  for (std::size_t w = 0; w < words.size(); ++w)
    for (auto& phone : pronounce(words[w])) all.push_back({std::move(phone), static_cast<int>(w)});
  return all;
}

/// The word of every spoken phone, by least edit distance; a phone that was
/// not expected goes to the word before it.
std::vector<int> assign(const std::vector<const Interval*>& spoken, const std::vector<Expected>& expected) {
  const auto n = static_cast<Eigen::Index>(spoken.size()), m = static_cast<Eigen::Index>(expected.size());
  Eigen::MatrixXd cost(n + 1, m + 1);
  const auto step = [&](Eigen::Index i, Eigen::Index j) {
    return cost(i - 1, j - 1) +
           mismatch(spoken[static_cast<std::size_t>(i - 1)]->label, expected[static_cast<std::size_t>(j - 1)].phone);
  };
  for (Eigen::Index i = 0; i <= n; ++i)
    for (Eigen::Index j = 0; j <= m; ++j) {
      if (i == 0 || j == 0)
        cost(i, j) = static_cast<double>(i + j);
      else
        cost(i, j) = std::min({step(i, j), cost(i - 1, j) + 1, cost(i, j - 1) + 1});
    }
  std::vector<int> word(spoken.size(), -1);
  for (Eigen::Index i = n, j = m; i > 0;) {
    if (j > 0 && cost(i, j) == step(i, j)) {
      word[static_cast<std::size_t>(i - 1)] = expected[static_cast<std::size_t>(j - 1)].word;
      --i, --j;
    } else if (j > 0 && cost(i, j) == cost(i, j - 1) + 1) {
      --j;
    } else {
      --i;
    }
  }
  for (std::size_t i = 0; i < word.size(); ++i)
    if (word[i] < 0) word[i] = i > 0 ? word[i - 1] : expected.front().word;
  return word;
}

}  // namespace

std::vector<std::string> split_words(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream in(text);
  const auto part_of_word = [](unsigned char c) { return std::isalnum(c) || c >= 0x80; };
  for (std::string word; in >> word;) {
    const auto first = std::find_if(word.begin(), word.end(), part_of_word);
    const auto last = std::find_if(word.rbegin(), word.rend(), part_of_word).base();
    if (first >= last) continue;
    word = std::string(first, last);
    for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    words.push_back(word);
  }
  return words;
}

WordTrack find_words(const std::string& text, const PhoneTrack& phones) {
  const auto words = split_words(text);
  const auto expected = expected_phones(words);
  std::vector<const Interval*> spoken;
  for (const auto& phone : phones.phones)
    if (phone.label != "sil") spoken.push_back(&phone);
  if (spoken.empty() || expected.empty()) return {};
  const auto word = assign(spoken, expected);

  WordTrack track;
  std::size_t next = 0;
  int current = -1;
  for (const auto& phone : phones.phones) {
    const int now = phone.label == "sil" ? -1 : word[next++];
    auto& done = track.words;
    const bool pause_within = now < 0 && next > 0 && next < word.size() && word[next - 1] == word[next];
    if (!done.empty() && (now == current || pause_within)) {
      done.back().end = phone.end;
      continue;
    }
    done.push_back({now < 0 ? "sil" : words[static_cast<std::size_t>(now)], phone.start, phone.end});
    current = now;
  }
  return track;
}

}  // namespace talkgraph
