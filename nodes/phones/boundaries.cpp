#include "nodes/phones/boundaries.h"

#include <algorithm>
#include <cmath>

#include "nodes/phones/sound.h"
#include "nodes/speech/frame.h"
#include "nodes/speech/mel.h"
#include "nodes/speech/spectrum.h"

namespace talkgraph {
namespace {

constexpr double kRate = 500;         // spectra a second
constexpr double kWindow = 0.012;     // of a spectrum, seconds
constexpr Eigen::Index kSide = 6;     // spectra averaged on either side of a boundary
constexpr double kReach = 0.02;       // how far a boundary moves, seconds
constexpr double kTrust = 0.015;      // deviation of the model's boundaries, seconds
constexpr double kDynamicRange = 11;  // of log power spectra
constexpr double kClosure = 0.1;      // of a stop at most, seconds

bool one_of(std::string_view phone, std::initializer_list<std::string_view> set) {
  return std::find(set.begin(), set.end(), phone) != set.end();
}
bool is_nasal(std::string_view phone) { return one_of(phone, {"m", "n", "ng"}); }
bool is_voiced_stop(std::string_view phone) { return one_of(phone, {"b", "d", "g", "jh"}); }
bool is_stop(std::string_view phone) { return is_voiced_stop(phone) || one_of(phone, {"p", "t", "k", "ch"}); }
bool is_vowel_or_glide(std::string_view phone) {
  return std::string_view("aeiou").find(phone[0]) != std::string_view::npos || one_of(phone, {"l", "r", "w", "y"});
}

/// Whether the spectrum shows where one phone ends and the next begins.
bool is_sharp(std::string_view before, std::string_view after) {
  const bool released = is_vowel_or_glide(before) || is_nasal(before) || is_voiced_stop(before);
  return !(released && is_vowel_or_glide(after));
}

/// Log mel power spectra (T x filters) of a stretch of sound.
Eigen::MatrixXd log_spectra(const Audio& audio) {
  const Frames frames = Frame{.window = kWindow, .rate = Rational(500), .centred = true}(audio);
  const Spectrum spectrum = ShortTimeSpectrum{.window = {}, .kind = SpectrumKind::power}(frames);
  const Eigen::MatrixXd mel = Mel{.filters = 24}(spectrum).track.values;
  return mel.cwiseMax(mel.maxCoeff() - kDynamicRange);
}

/// The time within [low, high], near the model's boundary, where the spectrum changes most.
double sharpest(const Audio& audio, double model, double low, double high) {
  constexpr double kHalf = kReach + kSide / kRate + kWindow / 2;
  const auto first = std::lround(std::max(0.0, model - kHalf) * audio.rate);
  const auto count = std::min(std::lround(2 * kHalf * audio.rate), audio.samples.size() - first);
  if (count <= 0) return model;
  const Eigen::MatrixXd spectra = log_spectra({audio.samples.segment(first, count), audio.rate});
  double best = model, most = 0;
  for (Eigen::Index c = kSide; c + kSide <= spectra.rows(); ++c) {
    const double time = static_cast<double>(first) / audio.rate + static_cast<double>(c) / kRate;
    if (time < std::max(low, model - kReach) || time > std::min(high, model + kReach)) continue;
    const double change =
        (spectra.middleRows(c, kSide).colwise().sum() - spectra.middleRows(c - kSide, kSide).colwise().sum()).norm();
    const double weighted = change * std::exp(-0.5 * std::pow((time - model) / kTrust, 2));
    if (weighted > most) most = weighted, best = time;
  }
  return best;
}

}  // namespace

std::vector<double> phone_starts(const std::vector<FrameSpan>& phones, const Audio& audio) {
  std::vector<double> model;
  for (const auto& phone : phones)
    model.push_back(model.empty() ? 0 : std::min(sphinx_boundary(phone.start), audio.seconds()));
  std::vector<double> starts = model;
  for (std::size_t i = 1; i < phones.size(); ++i) {
    const std::string before = cmu_label(phones[i - 1].label), phone = cmu_label(phones[i].label);
    const double next = i + 1 < model.size() ? model[i + 1] : audio.seconds();
    if (is_sharp(before, phone))
      starts[i] = sharpest(audio, model[i], (model[i - 1] + model[i]) / 2, (model[i] + next) / 2);
    const bool within = i > 1 && before == "sil";
    if (within && is_stop(phone) && starts[i] - starts[i - 1] <= kClosure) starts[i] = starts[i - 1];
  }
  return starts;
}

}  // namespace talkgraph
