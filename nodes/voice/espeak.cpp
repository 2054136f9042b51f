#include "nodes/voice/espeak.h"

#include <stdexcept>

#ifdef TALKGRAPH_ESPEAK

#include <espeak-ng/speak_lib.h>

#include <cmath>
#include <cstring>
#include <mutex>
#include <utility>

namespace talkgraph::espeak {
namespace {

/// The library keeps one state a process, and calls back without user data
/// for some events.
struct Library {
  std::mutex mutex;
  int rate = 0;
  std::vector<short> samples;
  std::vector<Phoneme> phonemes;
  bool word_begins = false;
};

Library& library() {
  static Library one;
  return one;
}

int receive(short* samples, int count, espeak_EVENT* events) {
  auto& lib = library();
  if (samples) lib.samples.insert(lib.samples.end(), samples, samples + count);
  for (; events->type != espeakEVENT_LIST_TERMINATED; ++events) {
    if (events->type == espeakEVENT_WORD) lib.word_begins = true;
    if (events->type != espeakEVENT_PHONEME) continue;
    const auto& name = events->id.string;
    lib.phonemes.push_back(
        {std::string(name, strnlen(name, sizeof name)), events->sample, std::exchange(lib.word_begins, false)});
  }
  return 0;
}

void start(Library& lib) {
  if (lib.rate > 0) return;
  const int rate = espeak_Initialize(AUDIO_OUTPUT_SYNCHRONOUS, 0, nullptr,
                                     espeakINITIALIZE_PHONEME_EVENTS | espeakINITIALIZE_DONT_EXIT);
  if (rate <= 0) throw std::runtime_error("espeak-ng: cannot start; install the package espeak-ng-data");
  lib.rate = rate;
  espeak_SetSynthCallback(receive);
}

void choose_voice(const std::string& name) {
  if (espeak_SetVoiceByName(name.c_str()) != EE_OK)
    throw std::invalid_argument("espeak-ng: no voice \"" + name + "\"; \"espeak-ng --voices=en\" lists them");
}

/// The end of a text is timed by what stands behind it in the library's list
/// of phonemes: left-overs of whatever was spoken before. This overwrites them.
void forget() {
  static const std::string filler = [] {
    std::string text;
    for (int i = 0; i < 60; ++i) text += "mama ";
    return text;
  }();
  const void* rest = filler.c_str();
  while (rest) espeak_TextToPhonemes(&rest, espeakCHARS_UTF8, 0);
}

std::string without_stress(std::string name) {
  std::erase_if(name, [](char c) { return std::strchr("',%=|;", c) != nullptr; });
  return name;
}

}  // namespace

Spoken synthesise(const std::string& text, const Voice& voice) {
  auto& lib = library();
  const std::lock_guard lock(lib.mutex);
  start(lib);
  choose_voice(voice.name);
  espeak_SetParameter(espeakRATE, static_cast<int>(std::lround(voice.rate)), 0);
  espeak_SetParameter(espeakPITCH, static_cast<int>(std::lround(voice.pitch)), 0);
  espeak_SetParameter(espeakVOLUME, static_cast<int>(std::lround(voice.volume)), 0);
  forget();
  lib.samples.clear();
  lib.phonemes.clear();
  lib.word_begins = false;
  if (espeak_Synth(text.c_str(), text.size() + 1, 0, POS_CHARACTER, 0, espeakCHARS_UTF8, nullptr, nullptr) != EE_OK)
    throw std::runtime_error("espeak-ng: cannot speak \"" + text + "\"");
  Spoken spoken;
  spoken.rate = lib.rate;
  spoken.samples.resize(static_cast<Eigen::Index>(lib.samples.size()));
  for (std::size_t i = 0; i < lib.samples.size(); ++i)
    spoken.samples[static_cast<Eigen::Index>(i)] = lib.samples[i] / 32768.0;
  spoken.phonemes = std::move(lib.phonemes);
  return spoken;
}

std::vector<std::string> phonemes(const std::string& text) {
  auto& lib = library();
  const std::lock_guard lock(lib.mutex);
  start(lib);
  choose_voice("en-us");
  constexpr char separator = '\t';
  std::vector<std::string> names;
  const void* rest = text.c_str();
  while (rest) {
    const char* clause = espeak_TextToPhonemes(&rest, espeakCHARS_UTF8, separator << 8);
    if (!clause) break;
    std::string name;
    for (const char* c = clause;; ++c) {
      if (*c != separator && *c != ' ' && *c != '\0') {
        name += *c;
        continue;
      }
      name = without_stress(name);
      if (!name.empty() && name[0] != '_' && name[0] != '(') names.push_back(name);
      name.clear();
      if (*c == '\0') break;
    }
  }
  return names;
}

}  // namespace talkgraph::espeak

#else

namespace talkgraph::espeak {
namespace {

[[noreturn]] void refuse() {
  throw std::runtime_error(
      "espeak-ng: this talkgraph was built without it; configure with -DTALKGRAPH_ESPEAK=ON, or bring recordings");
}

}  // namespace

Spoken synthesise(const std::string&, const Voice&) { refuse(); }
std::vector<std::string> phonemes(const std::string&) { refuse(); }

}  // namespace talkgraph::espeak

#endif
