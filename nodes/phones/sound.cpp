#include "nodes/phones/sound.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>

#include "nodes/media/audio_file.h"

namespace talkgraph {
namespace {

std::string cmu_label(const std::string& label) {
  if (label == "SIL" || label.starts_with('+') || label.starts_with('<') || label.starts_with('[')) return "sil";
  std::string lower = label;
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

}  // namespace

std::vector<std::int16_t> sphinx_samples(const Audio& audio) {
  std::vector<std::int16_t> samples;
  for (const double x : resampled(audio, kSphinxRate).samples)
    samples.push_back(static_cast<std::int16_t>(std::clamp(std::lround(x * 32767), -32767L, 32767L)));
  return samples;
}

bool is_blank(const Audio& audio) {
  return audio.seconds() < 0.05 || audio.samples.cwiseAbs().maxCoeff() <= 3.0 / 32768;
}

PhoneTrack all_silence(const Audio& audio) {
  if (audio.samples.size() == 0) return {};
  return {{{"sil", 0, audio.seconds()}}};
}

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
