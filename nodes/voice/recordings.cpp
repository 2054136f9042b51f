#include "nodes/voice/recordings.h"

#include <fmt/format.h>

#include <memory>
#include <stdexcept>

#include "nodes/voice/speak.h"

namespace talkgraph {
namespace {

Recording record(std::string id, const std::string& text, const Voice& voice) {
  auto spoken = std::make_shared<const Utterance>(speak(text, voice));
  Recording r;
  r.id = std::move(id);
  r.split = "test";
  r.audio = [spoken] { return spoken->audio; };
  r.transcript = Transcript{text};
  r.words = spoken->words;
  r.phones = spoken->phones;
  return r;
}

}  // namespace

Stream<Recording> SpokenRecordings::operator()() const {
  if (texts.empty()) throw std::invalid_argument("voice.recordings: give at least one text");
  return Stream<Recording>(
      [texts = texts, voice = voice, i = std::size_t{0}]() mutable -> std::optional<Item<Recording>> {
        if (i == texts.size()) return {};
        const auto id = fmt::format("text-{}", i + 1);
        return Item<Recording>{id, record(id, texts[i++], voice)};
      },
      texts.size());
}

void describe(Description<SpokenRecordings>& d) {
  d.type("voice.recordings").version(1).summary("recordings of texts spoken by espeak-ng");
  d.output("recording", "one item a text, with its transcript");
  d.param("texts", &SpokenRecordings::texts).required().doc("English texts, one recording each");
  d.param("voice", &SpokenRecordings::voice).doc("how they sound");
}

}  // namespace talkgraph
