#include "nodes/voice/voice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nodes/voice/espeak.h"
#include "nodes/voice/words.h"

namespace talkgraph {
namespace {

void check(const Voice& v) {
  const auto within = [](const char* what, double value, double low, double high) {
    if (!(value >= low && value <= high))
      throw std::invalid_argument(fmt::format("voice: {} must be from {} to {}, got {}", what, low, high, value));
  };
  within("rate", v.rate, 80, 450);
  within("pitch", v.pitch, 0, 100);
  within("volume", v.volume, 0, 200);
}

/// espeak-ng marks a phoneme after the closure that leads to it; the closure,
/// which is digital near-silence, belongs to the consonant.
std::int64_t with_closure(const Eigen::VectorXd& samples, std::int64_t start, std::int64_t earliest) {
  constexpr double silent = 0.004;
  while (start > earliest && std::abs(samples[start - 1]) <= silent) --start;
  return start;
}

bool has_closure(const std::string& phone) {
  static const std::vector<std::string> stops{"p", "b", "t", "d", "k", "g", "ch", "jh"};
  return std::find(stops.begin(), stops.end(), phone) != stops.end();
}

/// One phone more, beginning at a sample; phones cut to nothing vanish.
struct Start {
  std::string phone;
  std::int64_t sample;
};

/// Share of a phoneme of two phones that the first takes: a vowel before r or
/// another vowel is the longer part, the vowel of a syllabic consonant the shorter.
double first_share(const std::string& second) { return second == "l" || second == "n" || second == "m" ? 0.35 : 0.6; }

std::vector<Start> phone_starts(const espeak::Spoken& spoken) {
  std::vector<Start> starts{{"sil", 0}};
  const auto total = static_cast<std::int64_t>(spoken.samples.size());
  for (std::size_t i = 0; i < spoken.phonemes.size(); ++i) {
    const auto& phoneme = spoken.phonemes[i];
    const bool pause = phoneme.name.empty() || phoneme.name[0] == '_';
    const auto phones = pause ? std::vector<std::string>{"sil"} : cmu_phones(phoneme.name);
    if (phones.empty()) continue;
    const auto& before = starts.back();
    auto begin = std::clamp<std::int64_t>(phoneme.sample, before.sample, total);
    const auto end =
        std::clamp<std::int64_t>(i + 1 < spoken.phonemes.size() ? spoken.phonemes[i + 1].sample : total, begin, total);
    // "ih r" + "r" of "here and" is one r.
    if (before.phone == phones[0] && (pause || (phones[0] == "r" && !phoneme.starts_word))) continue;
    if (has_closure(phones[0]) && before.phone != "sil")
      begin = with_closure(spoken.samples, begin, (before.sample + begin) / 2);
    starts.push_back({phones[0], begin});
    if (phones.size() == 2)
      starts.push_back({phones[1], begin + std::llround(first_share(phones[1]) * static_cast<double>(end - begin))});
  }
  return starts;
}

PhoneTrack to_track(const std::vector<Start>& starts, const Audio& audio) {
  PhoneTrack track;
  const auto total = static_cast<std::int64_t>(audio.samples.size());
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const auto end = i + 1 < starts.size() ? starts[i + 1].sample : total;
    if (end <= starts[i].sample) continue;
    const double from = static_cast<double>(starts[i].sample) / audio.rate, to = static_cast<double>(end) / audio.rate;
    auto& phones = track.phones;
    if (!phones.empty() && phones.back().label == "sil" && starts[i].phone == "sil")
      phones.back().end = to;
    else
      phones.push_back({starts[i].phone, from, to});
  }
  return track;
}

}  // namespace

Utterance speak(const std::string& text, const Voice& voice) {
  check(voice);
  auto spoken = espeak::synthesise(text, voice);
  const auto starts = phone_starts(spoken);
  Utterance utterance;
  utterance.audio = {std::move(spoken.samples), spoken.rate};
  utterance.phones = to_track(starts, utterance.audio);
  utterance.words = find_words(text, utterance.phones);
  if (utterance.words.words.empty())
    throw std::invalid_argument("voice: nothing to say in \"" + text + "\"; give English words");
  return utterance;
}

std::vector<std::string> pronounce(const std::string& word) {
  std::vector<std::string> phones;
  for (const auto& phoneme : espeak::phonemes(word))
    for (auto& phone : cmu_phones(phoneme))
      if (phone != "r" || phones.empty() || phones.back() != "r") phones.push_back(std::move(phone));
  return phones;
}

}  // namespace talkgraph
