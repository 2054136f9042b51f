#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace talkgraph {

/// A seeded generator whose numbers are the same on every machine
/// (xoshiro256**, Blackman & Vigna 2018, seeded by splitmix64). The standard
/// library's distributions differ between implementations and are not used.
class Random {
 public:
  explicit Random(std::uint64_t seed = 1);
  /// The stream of one node for one item.
  Random(std::uint64_t seed, std::string_view node_type, std::string_view key);

  std::uint64_t bits();
  /// Uniform in [0, 1), 53 bits.
  double uniform();
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform in 0..n-1, unbiased; n must be positive.
  std::uint64_t below(std::uint64_t n);
  /// Standard normal (polar Box-Muller).
  double normal();

  template <class T>
  void shuffle(std::vector<T>& v) {
    for (std::size_t i = v.size(); i > 1; --i) std::swap(v[i - 1], v[below(i)]);
  }

 private:
  std::uint64_t s_[4];
};

}  // namespace talkgraph
