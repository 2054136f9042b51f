#include "graph/rational.h"

#include <charconv>
#include <numeric>
#include <stdexcept>

namespace talkgraph {
namespace {

std::int64_t whole(std::string_view text, std::string_view all) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || text.empty())
    throw std::invalid_argument("\"" + std::string(all) + "\" is not a ratio such as 25, 29.97 or 30000/1001");
  return value;
}

}  // namespace

Rational::Rational(std::int64_t num, std::int64_t den) : num_(num), den_(den) {
  if (den == 0) throw std::invalid_argument("a ratio with denominator 0");
  const std::int64_t divisor = std::gcd(num, den) * (den < 0 ? -1 : 1);
  num_ /= divisor;
  den_ /= divisor;
}

Rational Rational::parse(std::string_view text) {
  if (const auto slash = text.find('/'); slash != text.npos)
    return {whole(text.substr(0, slash), text), whole(text.substr(slash + 1), text)};
  const auto dot = text.find('.');
  if (dot == text.npos) return {whole(text, text)};
  const std::string digits = std::string(text.substr(0, dot)) + std::string(text.substr(dot + 1));
  std::int64_t den = 1;
  for (std::size_t i = dot + 1; i < text.size(); ++i) den *= 10;
  if (text.size() - dot > 15) throw std::invalid_argument("\"" + std::string(text) + "\" has too many digits");
  return {whole(digits, text), den};
}

std::string Rational::str() const {
  return den_ == 1 ? std::to_string(num_) : std::to_string(num_) + "/" + std::to_string(den_);
}

Rational Rational::operator*(const Rational& o) const { return {num_ * o.num_, den_ * o.den_}; }
Rational Rational::operator/(const Rational& o) const { return {num_ * o.den_, den_ * o.num_}; }

}  // namespace talkgraph
