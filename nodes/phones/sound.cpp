#include "nodes/phones/sound.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>

#include "graph/random.h"
#include "nodes/media/audio_file.h"

namespace talkgraph {
namespace {

/// A quiet room, as a share of the loudest sample. The model's silence is not likelier than other phones in
/// digital silence, whose logarithms would also move the means that it subtracts.
constexpr double kRoom = 5e-4;

}  // namespace

std::vector<std::int16_t> sphinx_samples(const Audio& audio) {
  const Audio sound = resampled(audio, kSphinxRate);
  const double peak = sound.samples.size() ? sound.samples.cwiseAbs().maxCoeff() : 0, noise = kRoom * peak;
  const double scale = 32767 / std::max(1.0, peak);  // float files may hold samples beyond full scale
  Random random(1, "phones", "room");
  std::vector<std::int16_t> samples;
  for (const double x : sound.samples)
    samples.push_back(static_cast<std::int16_t>(
        std::clamp(std::lround(scale * (x + random.uniform(-noise, noise))), -32767L, 32767L)));
  return samples;
}

bool is_blank(const Audio& audio) {
  return audio.seconds() < 0.05 || audio.samples.cwiseAbs().maxCoeff() <= 3.0 / 32768;
}

PhoneTrack all_silence(const Audio& audio) {
  if (audio.samples.size() == 0) return {};
  return {{{"sil", 0, audio.seconds()}}};
}

std::string cmu_label(const std::string& label) {
  if (label == "SIL" || label.starts_with('+') || label.starts_with('<') || label.starts_with('[')) return "sil";
  std::string lower = label;
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

PhoneTrack phone_track(const std::vector<FrameSpan>& phones, const std::vector<double>& starts, double seconds) {
  PhoneTrack track;
  for (std::size_t i = 0; i < phones.size(); ++i) {
    const double end = i + 1 < starts.size() ? starts[i + 1] : seconds;
    if (end <= starts[i]) continue;
    const std::string label = cmu_label(phones[i].label);
    if (track.phones.empty() || label != "sil" || track.phones.back().label != "sil")
      track.phones.push_back({label, starts[i], end});
    else
      track.phones.back().end = end;
  }
  return track;
}

}  // namespace talkgraph
