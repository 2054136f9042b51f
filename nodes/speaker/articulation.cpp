#include "nodes/speaker/articulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <unordered_map>

namespace talkgraph {
namespace {

/// What a phone wants (targets) and how much it insists (strengths).
struct Target {
  double jaw, width, protrusion, upper_lip, lower_lip, tongue_tip;
  double jaw_strength, lips_strength, tongue_strength;
};

const std::unordered_map<std::string, Target>& targets() {
  static const std::unordered_map<std::string, Target> table{
      // jaw, width, protrusion, upper, lower, tongue; strengths of jaw, lips, tongue
      {"sil", {0.03, 0, 0, 0, 0, 0.2, 0.5, 0.4, 0.3}},
      {"breath", {0.2, 0, 0, 0.1, 0, 0.1, 0.6, 0.4, 0.3}},
      {"aa", {0.92, 0.05, 0, 0.25, 0.2, 0, 1.2, 0.9, 0.6}},
      {"ae", {0.85, 0.45, 0, 0.45, 0.35, 0.05, 1.2, 0.9, 0.6}},
      {"ah", {0.55, 0.1, 0, 0.2, 0.2, 0.1, 0.8, 0.5, 0.5}},
      {"ao", {0.72, -0.45, 0.55, 0.2, 0.2, 0, 1.1, 1.2, 0.6}},
      {"eh", {0.62, 0.4, 0, 0.3, 0.3, 0.1, 1, 0.9, 0.5}},
      {"er", {0.34, -0.35, 0.5, 0.15, 0.3, 0.35, 0.9, 1, 0.6}},
      {"ih", {0.38, 0.45, 0, 0.25, 0.35, 0.2, 0.8, 0.7, 0.5}},
      {"iy", {0.24, 0.9, 0, 0.4, 0.45, 0.25, 1, 1.2, 0.6}},
      {"uh", {0.34, -0.45, 0.55, 0.15, 0.2, 0.1, 0.8, 1, 0.5}},
      {"uw", {0.22, -0.9, 1, 0.1, 0.15, 0.05, 1, 1.6, 0.5}},
      {"p", {0.1, 0, 0, 0, 0, 0.2, 0.8, 0.35, 0.2}},
      {"b", {0.12, 0, 0, 0, 0, 0.2, 0.8, 0.35, 0.2}},
      {"m", {0.12, 0, 0, 0, 0, 0.2, 0.8, 0.35, 0.2}},
      {"f", {0.14, 0.15, 0, 0.45, 0, 0.2, 1.1, 0.6, 0.2}},
      {"v", {0.15, 0.15, 0, 0.4, 0, 0.2, 1.1, 0.6, 0.2}},
      {"th", {0.24, 0.15, 0, 0.25, 0.25, 0.8, 1.1, 0.5, 2}},
      {"dh", {0.24, 0.15, 0, 0.25, 0.25, 0.8, 1, 0.4, 2}},
      {"t", {0.2, 0.15, 0, 0.15, 0.25, 0.9, 0.8, 0.25, 1.5}},
      {"d", {0.22, 0.15, 0, 0.15, 0.25, 0.9, 0.8, 0.25, 1.5}},
      {"n", {0.24, 0.1, 0, 0.15, 0.25, 0.9, 0.7, 0.25, 1.5}},
      {"l", {0.38, 0.1, 0, 0.2, 0.25, 1, 0.8, 0.3, 2}},
      {"s", {0.1, 0.4, 0, 0.3, 0.55, 0.5, 1.6, 0.6, 1}},
      {"z", {0.11, 0.4, 0, 0.3, 0.55, 0.5, 1.5, 0.6, 1}},
      {"sh", {0.14, -0.5, 0.7, 0.4, 0.75, 0.3, 1.5, 1.4, 1}},
      {"zh", {0.15, -0.5, 0.7, 0.4, 0.75, 0.3, 1.4, 1.4, 1}},
      {"ch", {0.14, -0.5, 0.7, 0.4, 0.7, 0.6, 1.4, 1.3, 1}},
      {"jh", {0.15, -0.45, 0.65, 0.4, 0.7, 0.6, 1.4, 1.3, 1}},
      {"k", {0.3, 0.05, 0, 0.1, 0.15, 0, 0.45, 0.12, 0.5}},
      {"g", {0.3, 0.05, 0, 0.1, 0.15, 0, 0.45, 0.12, 0.5}},
      {"ng", {0.3, 0.05, 0, 0.1, 0.15, 0, 0.45, 0.12, 0.5}},
      {"hh", {0.36, 0.05, 0, 0.1, 0.1, 0.1, 0.25, 0.1, 0.2}},
      {"r", {0.22, -0.4, 0.6, 0.2, 0.3, 0.35, 0.9, 1, 0.8}},
      {"w", {0.13, -0.95, 1, 0, 0, 0.1, 1.2, 1.8, 0.4}},
      {"y", {0.2, 0.55, 0, 0.25, 0.3, 0.3, 0.8, 0.7, 0.8}},
  };
  return table;
}

/// Diphthongs move from one vowel to another.
const std::unordered_map<std::string, std::pair<std::string, std::string>>& diphthongs() {
  static const std::unordered_map<std::string, std::pair<std::string, std::string>> table{
      {"ay", {"aa", "iy"}}, {"aw", {"aa", "uw"}}, {"oy", {"ao", "iy"}}, {"ey", {"eh", "iy"}}, {"ow", {"ao", "uw"}}};
  return table;
}

/// A target with its stretch of time, seconds.
struct Pull {
  Target target;
  double start, end;
};

const Target& find_target(const std::string& phone) {
  const auto found = targets().find(phone);
  if (found == targets().end())
    throw std::runtime_error("articulation: phone \"" + phone + "\" is unknown; give CMU phones without stress");
  return found->second;
}

std::vector<Pull> pulls_of(const PhoneTrack& phones) {
  std::vector<Pull> pulls;
  for (const auto& p : phones.phones) {
    const auto two = diphthongs().find(p.label);
    if (two == diphthongs().end()) {
      pulls.push_back({find_target(p.label), p.start, p.end});
      continue;
    }
    const double turn = p.start + 0.55 * (p.end - p.start);
    pulls.push_back({find_target(two->second.first), p.start, turn});
    pulls.push_back({find_target(two->second.second), turn, p.end});
  }
  return pulls;
}

/// Dominance at time t of a phone that insists with strength 1: flat in its
/// middle, falling off within `before` seconds ahead of it and `after` behind.
double dominance(const Pull& p, double t, double before, double after) {
  const double middle = 0.5 * (p.start + p.end), core = 0.2 * (p.end - p.start);
  const double distance = std::abs(t - middle) - core;
  if (distance <= 0) return 1;
  const double x = distance / (t < middle ? before : after);
  return std::exp(-x * std::sqrt(x));
}

/// Strength-weighted means of the targets around time t.
Articulators blend(const std::vector<Pull>& pulls, double t) {
  constexpr double reach = 0.6;
  Articulators a;
  double jaw = 1e-9, lips = 1e-9, tongue = 1e-9;
  for (const auto& p : pulls) {
    if (p.end < t - reach || p.start > t + reach) continue;
    const double dj = p.target.jaw_strength * dominance(p, t, 0.055, 0.06);
    const double dl = p.target.lips_strength * dominance(p, t, p.target.protrusion > 0.4 ? 0.12 : 0.07, 0.08);
    const double dt = p.target.tongue_strength * dominance(p, t, 0.05, 0.05);
    jaw += dj, lips += dl, tongue += dt;
    a.jaw += dj * p.target.jaw;
    a.width += dl * p.target.width;
    a.protrusion += dl * p.target.protrusion;
    a.upper_lip += dl * p.target.upper_lip;
    a.lower_lip += dl * p.target.lower_lip;
    a.tongue_tip += dt * p.target.tongue_tip;
  }
  a.jaw /= jaw;
  for (double* lip : {&a.width, &a.protrusion, &a.upper_lip, &a.lower_lip}) *lip /= lips;
  a.tongue_tip /= tongue;
  return a;
}

double smoothstep(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

/// 1 during a phone but for its last `release` share, with smooth flanks.
double hold(const Interval& p, double t, double attack, double decay, double release) {
  const double end = p.end - release * (p.end - p.start);
  if (t < p.start) return smoothstep(1 - (p.start - t) / attack);
  return t <= end ? 1 : smoothstep(1 - (t - end) / decay);
}

void apply_constraints(const PhoneTrack& phones, double t, Articulators& a) {
  for (const auto& p : phones.phones) {
    if (p.end < t - 0.2 || p.start > t + 0.2) continue;
    const auto& l = p.label;
    if (l == "p" || l == "b" || l == "m") a.closure = std::max(a.closure, hold(p, t, 0.07, 0.06, 0.15));
    if (l == "f" || l == "v") a.bite = std::max(a.bite, hold(p, t, 0.06, 0.06, 0.15));
    if (l == "th" || l == "dh") a.tongue_out = std::max(a.tongue_out, hold(p, t, 0.05, 0.05, 0.2));
  }
}

}  // namespace

std::vector<Articulators> articulate(const PhoneTrack& phones, Rational rate, std::int64_t frames,
                                     const Effort& effort) {
  const auto pulls = pulls_of(phones);
  std::vector<Articulators> all;
  for (std::int64_t n = 0; n < frames; ++n) {
    const double t = (static_cast<double>(n) + 0.5) / rate.value();
    auto a = blend(pulls, t);
    a.jaw = std::min(1.25, a.jaw * effort.opening);
    a.upper_lip *= effort.opening;
    a.lower_lip *= effort.opening;
    apply_constraints(phones, t, a);
    all.push_back(a);
  }
  return all;
}

}  // namespace talkgraph
