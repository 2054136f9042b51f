#include "nodes/phones/words.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>

namespace talkgraph {
namespace {

using Words = std::vector<std::string>;

constexpr std::array kSmall = {"zero",     "one",     "two",     "three",     "four",     "five",    "six",
                               "seven",    "eight",   "nine",    "ten",       "eleven",   "twelve",  "thirteen",
                               "fourteen", "fifteen", "sixteen", "seventeen", "eighteen", "nineteen"};
constexpr std::array kTens = {"", "", "twenty", "thirty", "forty", "fifty", "sixty", "seventy", "eighty", "ninety"};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || static_cast<unsigned char>(c) >= 0x80; }

void append(Words& words, const Words& more) { words.insert(words.end(), more.begin(), more.end()); }

Words cardinal(std::uint64_t n) {
  if (n < 20) return {kSmall[n]};
  Words words;
  const auto rest = [&](std::uint64_t r) {
    if (r) append(words, cardinal(r));
  };
  if (n < 100) {
    words = {kTens[n / 10]};
    rest(n % 10);
    return words;
  }
  constexpr std::pair<std::uint64_t, const char*> kScales[] = {
      {1'000'000'000, "billion"}, {1'000'000, "million"}, {1'000, "thousand"}, {100, "hundred"}};
  for (const auto& [scale, name] : kScales)
    if (n >= scale) {
      words = cardinal(n / scale);
      words.emplace_back(name);
      rest(n % scale);
      return words;
    }
  return words;
}

Words digits(std::string_view number) {
  Words words;
  for (const char c : number) words.emplace_back(kSmall[c - '0']);
  return words;
}

/// 1984, 1900 and 2015 are read in two halves.
bool reads_as_year(std::string_view number, std::uint64_t n) {
  return number.size() == 4 && ((n >= 1100 && n < 2000) || (n >= 2010 && n < 2100));
}

Words whole_number(std::string_view number, bool plain) {
  if (number.size() > 12 || (number.size() > 1 && number[0] == '0')) return digits(number);
  const std::uint64_t n = std::stoull(std::string(number));
  if (!plain || !reads_as_year(number, n)) return cardinal(n);
  Words words = cardinal(n / 100);
  if (n % 100 == 0) {
    words.emplace_back("hundred");
    return words;
  }
  if (n % 100 < 10) words.emplace_back("oh");
  append(words, cardinal(n % 100));
  return words;
}

Words ordinal(Words words) {
  static const std::map<std::string, std::string> irregular = {
      {"one", "first"},    {"two", "second"}, {"three", "third"},   {"five", "fifth"},
      {"eight", "eighth"}, {"nine", "ninth"}, {"twelve", "twelfth"}};
  std::string& last = words.back();
  if (const auto found = irregular.find(last); found != irregular.end())
    last = found->second;
  else if (last.back() == 'y')
    last.replace(last.size() - 1, 1, "ieth");
  else
    last += "th";
  return words;
}

/// "nineteen ninety" as "nineteen nineties".
Words plural(Words words) {
  std::string& last = words.back();
  if (last.back() == 'y')
    last.replace(last.size() - 1, 1, "ies");
  else
    last += last.ends_with("x") ? "es" : "s";
  return words;
}

/// Takes a number from the start of the text: 1,000 · 3.5 · 2nd · 1990s.
Words take_number(std::string_view& text) {
  std::string number;
  bool plain = true;
  std::size_t at = 0;
  const auto digit_at = [&](std::size_t i) { return i < text.size() && is_digit(text[i]); };
  for (; at < text.size(); ++at) {
    if (is_digit(text[at])) {
      number += text[at];
    } else if (text[at] == ',' && digit_at(at + 1) && digit_at(at + 2) && digit_at(at + 3) && !digit_at(at + 4)) {
      plain = false;
    } else {
      break;
    }
  }
  std::string_view decimals;
  if (at < text.size() && text[at] == '.' && digit_at(at + 1)) {
    std::size_t end = at + 1;
    while (digit_at(end)) ++end;
    decimals = text.substr(at + 1, end - at - 1);
    at = end;
  }
  text.remove_prefix(at);
  if (!decimals.empty()) {
    Words words = whole_number(number, false);
    words.emplace_back("point");
    append(words, digits(decimals));
    return words;
  }
  for (const std::string_view suffix : {"st", "nd", "rd", "th"})
    if (text.starts_with(suffix) && (text.size() == 2 || !is_letter(text[2]))) {
      text.remove_prefix(2);
      return ordinal(whole_number(number, false));
    }
  if (text.starts_with("s") && (text.size() == 1 || !is_letter(text[1]))) {
    text.remove_prefix(1);
    return plural(whole_number(number, plain));
  }
  return whole_number(number, plain);
}

/// A sign of money at the start of the text with a number behind it.
struct Money {
  std::string_view sign;
  const char* one;
  const char* several;
};
const Money* money_at(std::string_view text) {
  static constexpr Money kinds[] = {
      {"$", "dollar", "dollars"}, {"\u00a3", "pound", "pounds"}, {"\u20ac", "euro", "euros"}};
  for (const auto& kind : kinds)
    if (text.starts_with(kind.sign) && text.size() > kind.sign.size() && is_digit(text[kind.sign.size()])) return &kind;
  return nullptr;
}

/// Takes a sum of money: $5 · $3.50 · £2 million.
Words take_money(const Money& kind, std::string_view& text) {
  text.remove_prefix(kind.sign.size());
  Words words = take_number(text);
  const auto point = std::find(words.begin(), words.end(), "point");
  const bool hundredths = words.end() - point == 3;  // with two decimals
  Words cents;
  if (hundredths) {
    const auto digit = [](const std::string& name) { return std::find(kSmall.begin(), kSmall.end(), name); };
    const auto value = 10 * (digit(point[1]) - kSmall.begin()) + (digit(point[2]) - kSmall.begin());
    if (value > 0) cents = cardinal(static_cast<std::uint64_t>(value));
    words.erase(point, words.end());
  }
  for (const std::string_view scale : {" thousand", " million", " billion", " trillion"})
    if (text.starts_with(scale)) {
      words.emplace_back(scale.substr(1));
      text.remove_prefix(scale.size());
    }
  words.emplace_back(words == Words{"one"} ? kind.one : kind.several);
  append(words, cents);
  return words;
}

/// Bytes of a space, punctuation mark or symbol beyond ASCII at the start of the text; 0 where there is none.
std::size_t sign_size(std::string_view text) {
  if (money_at(text)) return 0;
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0; };
  if (byte(0) == 0xc2) return 2;                     // U+0080 to U+00BF
  if (byte(0) == 0xe2 && byte(1) < 0xb0) return 3;   // U+2000 to U+2BFF
  if (byte(0) == 0xe3 && byte(1) == 0x80) return 3;  // U+3000 to U+303F
  return byte(0) >= 0xf0 ? 4 : 0;                    // U+10000 and above: emoji
}

std::string lower_with_plain_apostrophes(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    std::size_t size = 1;
    if (text.starts_with("\u2019")) {
      plain += '\'';
      size = 3;
    } else if (const auto sign = sign_size(text)) {
      plain += ' ';
      size = sign;
    } else {
      plain += text[0] >= 'A' && text[0] <= 'Z' ? static_cast<char>(text[0] - 'A' + 'a') : text[0];
    }
    text.remove_prefix(std::min(size, text.size()));
  }
  return plain;
}

}  // namespace

Words spoken_words(std::string_view text) {
  const std::string plain = lower_with_plain_apostrophes(text);
  std::string_view rest = plain;
  Words words;
  while (!rest.empty()) {
    if (const Money* kind = money_at(rest)) {
      append(words, take_money(*kind, rest));
    } else if (is_digit(rest[0])) {
      append(words, take_number(rest));
    } else if (is_letter(rest[0])) {
      std::size_t end = 1;
      while (end < rest.size() && (is_letter(rest[end]) || rest[end] == '\'')) ++end;
      std::string word(rest.substr(0, end));
      rest.remove_prefix(end);
      while (word.back() == '\'') word.pop_back();
      words.push_back(std::move(word));
    } else {
      if (rest[0] == '%') words.emplace_back("percent");
      if (rest[0] == '&') words.emplace_back("and");
      rest.remove_prefix(1);
    }
  }
  return words;
}

}  // namespace talkgraph
