#include "nodes/phones/sound.h"

#include <soxr.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

namespace talkgraph {
namespace {

std::vector<double> at_sphinx_rate(const Audio& audio) {
  const auto length = static_cast<std::size_t>(audio.samples.size());
  std::vector<double> samples(audio.samples.data(), audio.samples.data() + length);
  if (audio.rate == kSphinxRate) return samples;
  std::vector<double> resampled(static_cast<std::size_t>(std::ceil(audio.seconds() * kSphinxRate)));
  const soxr_io_spec_t io = soxr_io_spec(SOXR_FLOAT64_I, SOXR_FLOAT64_I);
  const soxr_quality_spec_t quality = soxr_quality_spec(SOXR_HQ, 0);
  std::size_t made = 0;
  const soxr_error_t error = soxr_oneshot(audio.rate, kSphinxRate, 1, samples.data(), length, nullptr, resampled.data(),
                                          resampled.size(), &made, &io, &quality, nullptr);
  if (error) throw std::runtime_error("phones: cannot resample the sound: " + std::string(error));
  resampled.resize(made);
  return resampled;
}

std::string cmu_label(const std::string& label) {
  if (label == "SIL" || label.starts_with('+') || label.starts_with('<') || label.starts_with('[')) return "sil";
  std::string lower = label;
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

}  // namespace

std::vector<std::int16_t> sphinx_samples(const Audio& audio) {
  std::vector<std::int16_t> samples;
  for (const double x : at_sphinx_rate(audio))
    samples.push_back(static_cast<std::int16_t>(std::clamp(std::lround(x * 32767), -32767L, 32767L)));
  return samples;
}

bool is_blank(const Audio& audio) {
  return audio.seconds() < 0.05 || audio.samples.cwiseAbs().maxCoeff() <= 3.0 / 32768;
}

PhoneTrack all_silence(const Audio& audio) { return {{{"sil", 0, audio.seconds()}}}; }

PhoneTrack phone_track(const std::vector<FrameSpan>& phones, double seconds) {
  PhoneTrack track;
  for (const auto& phone : phones) {
    const std::string label = cmu_label(phone.label);
    const double start = std::min(track.phones.empty() ? 0 : sphinx_boundary(phone.start), seconds);
    if (!track.phones.empty()) track.phones.back().end = start;
    if (track.phones.empty() || label != "sil" || track.phones.back().label != "sil")
      track.phones.push_back({label, start, seconds});
    else
      track.phones.back().end = seconds;
  }
  return track;
}

}  // namespace talkgraph
