#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace talkgraph {

/// An exact ratio in lowest terms with a positive denominator; frame rates
/// such as 30000/1001 are kept exactly.
class Rational {
 public:
  constexpr Rational() = default;
  /// Throws std::invalid_argument if den is 0.
  Rational(std::int64_t num, std::int64_t den = 1);

  /// Reads "25", "30000/1001" or "29.97" (decimal digits taken exactly).
  /// Throws std::invalid_argument on anything else.
  static Rational parse(std::string_view text);

  std::int64_t num() const { return num_; }
  std::int64_t den() const { return den_; }
  double value() const { return static_cast<double>(num_) / static_cast<double>(den_); }
  std::string str() const;

  Rational operator*(const Rational& o) const;
  Rational operator/(const Rational& o) const;
  bool operator==(const Rational&) const = default;

 private:
  std::int64_t num_ = 0;
  std::int64_t den_ = 1;
};

}  // namespace talkgraph
