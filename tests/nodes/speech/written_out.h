#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "graph/random.h"
#include "nodes/types/audio.h"

/// The stages of speech parameters once more, slowly and straight from their formulas, to hold the nodes to.
namespace talkgraph::test {

using Numbers = std::vector<double>;
inline constexpr double pi = std::numbers::pi;

inline Audio noise(int samples, double rate = 16000) {
  Audio a;
  a.rate = rate;
  a.samples.resize(samples);
  Random random(7);
  for (auto& x : a.samples) x = 0.1 * random.normal();
  return a;
}

/// Pulses through two resonances that move, and a little noise.
inline Audio voice(double seconds, double rate = 16000) {
  Audio a = noise(static_cast<int>(seconds * rate), rate);
  double y1 = 0, y2 = 0, z1 = 0, z2 = 0, phase = 0;
  for (Eigen::Index t = 0; t < a.samples.size(); ++t) {
    const double time = static_cast<double>(t) / rate;
    phase += (110 + 30 * std::sin(3 * time)) / rate;
    double x = 0.002 * a.samples[t];
    if (phase >= 1) phase -= 1, x += 0.05;
    const double f1 = 500 + 250 * std::sin(9 * time), f2 = 1500 + 600 * std::sin(7 * time + 1);
    const double r1 = std::exp(-pi * 80 / rate), r2 = std::exp(-pi * 120 / rate);
    const double y = x + 2 * r1 * std::cos(2 * pi * f1 / rate) * y1 - r1 * r1 * y2;
    const double z = y + 2 * r2 * std::cos(2 * pi * f2 / rate) * z1 - r2 * r2 * z2;
    y2 = y1, y1 = y, z2 = z1, z1 = z;
    a.samples[t] = 0.05 * z;
  }
  return a;
}

inline Numbers magnitudes(const Numbers& x, int size) {
  Numbers out(size / 2 + 1);
  for (int k = 0; k <= size / 2; ++k) {
    std::complex<double> sum = 0;
    for (int i = 0; i < static_cast<int>(x.size()); ++i) {
      const int turn = static_cast<int>(static_cast<long>(k) * i % size);
      sum += x[i] * std::polar(1.0, -2 * pi * turn / size);
    }
    out[k] = std::abs(sum);
  }
  return out;
}

inline double mel(double hz) { return 1127 * std::log(1 + hz / 700); }

/// Sums of `spectrum` under triangles that are linear in mel, as HTK and Kaldi have them.
inline Numbers mel_sums(const Numbers& spectrum, int filters, double rate, double low) {
  Numbers out(filters);
  const double step = (mel(rate / 2) - mel(low)) / (filters + 1);
  for (int m = 0; m < filters; ++m) {
    const double left = mel(low) + m * step, centre = left + step, right = centre + step;
    for (std::size_t k = 0; k < spectrum.size(); ++k) {
      const double at = mel(static_cast<double>(k) * rate / 2 / static_cast<double>(spectrum.size() - 1));
      if (at > left && at <= centre) out[m] += spectrum[k] * (at - left) / step;
      if (at > centre && at < right) out[m] += spectrum[k] * (right - at) / step;
    }
  }
  return out;
}

/// DCT of the logs, c_1 ... c_count, each by √(2 / filters).
inline Numbers dct_of_logs(const Numbers& sums, double floor, int count) {
  Numbers c;
  const auto filters = static_cast<int>(sums.size());
  for (int i = 1; i <= count; ++i) {
    double sum = 0;
    for (int m = 0; m < filters; ++m)
      sum += std::log(std::max(floor, sums[m])) * std::cos(pi * i * (m + 0.5) / filters);
    c.push_back(std::sqrt(2.0 / filters) * sum);
  }
  return c;
}

/// x' of the whole signal, then frame t under a window.
inline Numbers windowed_frame(const Audio& audio, int t, int n, int hop, double k, double (*window)(int, int)) {
  Numbers x(n);
  for (int i = 0; i < n; ++i) {
    const int at = t * hop + i;
    x[i] = 32768 * (audio.samples[at] - k * (at > 0 ? audio.samples[at - 1] : 0)) * window(i, n);
  }
  return x;
}

inline double hamming(int i, int n) { return 0.54 - 0.46 * std::cos(2 * pi * i / (n - 1)); }

/// MATLAB's hanning, of rastamat.
inline double hanning(int i, int n) { return 0.5 * (1 - std::cos(2 * pi * (i + 1) / (n + 1))); }

}  // namespace talkgraph::test
