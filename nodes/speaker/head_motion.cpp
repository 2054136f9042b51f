#include "nodes/speaker/head_motion.h"

#include <algorithm>
#include <cmath>

namespace talkgraph {
namespace {

/// A smooth random curve: three slow sines, standard deviation about 1.
class Drift {
 public:
  explicit Drift(Random& random) {
    for (int i = 0; i < 3; ++i)
      waves_[i] = {random.uniform(0.08, 0.18) * (i + 1) * 6.283185307179586, random.uniform(0, 6.283185307179586)};
  }
  double operator()(double t) const {
    double sum = 0;
    for (int i = 0; i < 3; ++i) sum += std::sin(waves_[i].speed * t + waves_[i].phase) / (1 + 0.7 * i);
    return sum;
  }

 private:
  struct {
    double speed, phase;
  } waves_[3];
};

/// Times of events with gaps drawn from `low` to `high` seconds.
std::vector<double> events(double seconds, double low, double high, Random& random) {
  std::vector<double> times;
  for (double t = random.uniform(0.2, high); t < seconds; t += random.uniform(low, high)) times.push_back(t);
  return times;
}

/// A lid closes faster than it opens.
double blink_at(double since) {
  if (since < 0 || since > 0.3) return 0;
  const double x = since < 0.08 ? since / 0.08 : since < 0.13 ? 1 : (0.3 - since) / 0.17;
  return x * x * (3 - 2 * x);
}

double raise_at(double since, double length) {
  if (since < 0 || since > length) return 0;
  const double s = std::sin(3.141592653589793 * since / length);
  return s * s;
}

}  // namespace

std::vector<HeadMotion> head_motion(std::int64_t frames, Rational rate, Random& random) {
  const double seconds = static_cast<double>(frames) / rate.value();
  const Drift x(random), y(random), roll(random), near(random), yaw(random), pitch(random), brow(random);
  const auto blinks = events(seconds, 1.8, 4.5, random);
  const auto raises = events(seconds, 2.5, 6, random);
  const auto glances = events(seconds, 0.8, 2.5, random);
  std::vector<std::pair<double, double>> looks{{0, 0}};
  for (std::size_t i = 0; i < glances.size(); ++i) {
    const double to_x = random.uniform(-0.9, 0.9), to_y = random.uniform(-0.4, 0.4);
    looks.emplace_back(to_x, to_y);
  }

  std::vector<HeadMotion> all(static_cast<std::size_t>(frames));
  for (std::int64_t n = 0; n < frames; ++n) {
    const double t = (static_cast<double>(n) + 0.5) / rate.value();
    auto& h = all[static_cast<std::size_t>(n)];
    h.dx = 2.2 * x(t), h.dy = 1.5 * y(t);
    h.roll = 0.016 * roll(t), h.scale = 1 + 0.008 * near(t);
    h.yaw = 2.6 * yaw(t), h.pitch = 1.5 * pitch(t);
    for (const double at : blinks) h.blink = std::max(h.blink, blink_at(t - at));
    h.brow = 0.15 * brow(t);
    for (const double at : raises) h.brow += 0.8 * raise_at(t - at, 0.9);
    const auto look = static_cast<std::size_t>(std::upper_bound(glances.begin(), glances.end(), t) - glances.begin());
    h.gaze_x = looks[look].first, h.gaze_y = looks[look].second;
  }
  return all;
}

}  // namespace talkgraph
