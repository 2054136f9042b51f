#include "study/design.h"

#include <fmt/format.h>

#include <algorithm>

#include "graph/draft.h"

namespace talkgraph {

template <>
inline constexpr EnumNames<study::TestKind, 3> enum_names<study::TestKind>{
    {{study::TestKind::turing, "turing"},
     {study::TestKind::perceptual, "perceptual"},
     {study::TestKind::intelligibility, "intelligibility"}}};

namespace study {
namespace {

using Kind = LocatedJson::Kind;

bool is_name(const std::string& text) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
  return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), plain);
}

class Reader {
 public:
  explicit Reader(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  Design read(const LocatedJson& json) {
    Design out;
    if (!detail::expect_object(json, "a study", diagnostics_)) return out;
    detail::check_keys(json,
                       {"$schema", "description", "title", "consent", "profile", "split_by", "tests", "thanks", "seed",
                        "speakers", "draw", "take"},
                       "study", diagnostics_);
    need(json, "title", out.title, "study");
    need(json, "consent", out.consent, "study");
    need(json, "thanks", out.thanks, "study");
    need(json, "draw", out.draw, "study");
    if (const auto* m = json.find("draw"); m && !std::filesystem::is_regular_file(out.draw.path))
      diagnostics_.error(m->value.place, fmt::format("study: \"draw\": {} is not there", out.draw.path));
    may(json, "split_by", out.split_by, "study");
    may(json, "speakers", out.speakers, "study");
    may(json, "seed", out.seed, "study", {0, 9e15, false});
    if (const auto* m = json.find("profile")) out.profile = questions(m->value, "\"profile\"", true);
    if (const auto* m = member(json, "take", "study")) out.ports = ports(*m);
    if (const auto* m = member(json, "tests", "study")) out.tests = tests(*m);
    check_split(out, json);
    out.json = json;
    return out;
  }

 private:
  const LocatedJson* member(const LocatedJson& json, const char* key, const std::string& subject) {
    if (const auto* m = json.find(key)) return &m->value;
    diagnostics_.error(json.place,
                       fmt::format("{}: \"{}\" is missing; a study that extends pipelines/studies/study.json "
                                   "has all that it does not change",
                                   subject, key));
    return nullptr;
  }

  template <class T>
  void may(const LocatedJson& json, const char* key, T& value, const std::string& subject, const Range& range = {}) {
    if (const auto* m = json.find(key))
      detail::read_parameter(m->value, value, range, fmt::format("{}: \"{}\"", subject, key), diagnostics_);
  }
  template <class T>
  void need(const LocatedJson& json, const char* key, T& value, const std::string& subject, const Range& range = {}) {
    if (member(json, key, subject)) may(json, key, value, subject, range);
  }

  Ports ports(const LocatedJson& json) {
    Ports out;
    if (!detail::expect_object(json, "\"take\"", diagnostics_)) return out;
    detail::check_keys(json, {"face", "recorded", "synthesised", "mean", "mouths", "audio", "recordings", "sentences"},
                       "\"take\"", diagnostics_);
    need(json, "face", out.face, "\"take\"");
    need(json, "recorded", out.recorded, "\"take\"");
    need(json, "synthesised", out.synthesised, "\"take\"");
    need(json, "mean", out.mean, "\"take\"");
    need(json, "mouths", out.mouths, "\"take\"");
    need(json, "audio", out.audio, "\"take\"");
    need(json, "recordings", out.recordings, "\"take\"");
    may(json, "sentences", out.sentences, "\"take\"");
    return out;
  }

  void check_id(const LocatedJson::Member& m) {
    if (!is_name(m.key))
      diagnostics_.error(m.key_place,
                         fmt::format("\"{}\" cannot be a name: take up to 64 letters, digits, _ and -", m.key));
  }

  std::vector<Question> questions(const LocatedJson& json, const std::string& subject, bool with_options) {
    std::vector<Question> out;
    if (!detail::expect_object(json, subject, diagnostics_)) return out;
    for (const auto& m : json.members) {
      const std::string whole = fmt::format("{}: \"{}\"", subject, m.key);
      auto& question = out.emplace_back();
      question.id = m.key;
      check_id(m);
      if (!detail::expect_object(m.value, whole, diagnostics_)) continue;
      detail::check_keys(m.value, {"text", "options"}, whole, diagnostics_);
      need(m.value, "text", question.text, whole);
      const auto* options = m.value.find("options");
      if (options && !with_options)
        diagnostics_.error(options->key_place, whole + " has no options of its own: its choices are sentences");
      if (!with_options) continue;
      need(m.value, "options", question.options, whole);
      if (options && question.options.size() < 2)
        diagnostics_.error(options->value.place, whole + " needs at least two options");
    }
    return out;
  }

  std::vector<TestDesign> tests(const LocatedJson& json) {
    std::vector<TestDesign> out;
    if (!detail::expect_object(json, "\"tests\"", diagnostics_)) return out;
    for (const auto& m : json.members) {
      check_id(m);
      if (detail::expect_object(m.value, fmt::format("test \"{}\"", m.key), diagnostics_))
        out.push_back(test(m.key, m.value));
    }
    if (json.members.empty()) diagnostics_.error(json.place, "a study needs at least one test");
    return out;
  }

  TestDesign test(const std::string& id, const LocatedJson& json) {
    const std::string subject = fmt::format("test \"{}\"", id);
    TestDesign out;
    out.id = id;
    need(json, "kind", out.kind, subject);
    std::vector<std::string> keys = {"kind", "title", "instructions", "questions", "clips", "pool"};
    if (out.kind == TestKind::perceptual) keys.push_back("eyes");
    if (out.kind == TestKind::intelligibility) keys.push_back("choices");
    detail::check_keys(json, keys, subject, diagnostics_);
    need(json, "title", out.title, subject);
    may(json, "instructions", out.instructions, subject);
    need(json, "clips", out.clips, subject, {1, 10'000, false});
    out.pool = out.clips;
    may(json, "pool", out.pool, subject, {1, 100'000, false});
    if (out.pool < out.clips)
      diagnostics_.error(json.find("pool")->value.place,
                         fmt::format("{}: {} clips cannot be drawn from {}", subject, out.clips, out.pool));
    may(json, "choices", out.choices, subject, {2, 20, false});
    if (const auto* m = json.find("eyes")) out.eyes = eyes(m->value, subject);
    if (const auto* m = member(json, "questions", subject)) {
      out.questions = questions(*m, subject + ": \"questions\"", out.kind != TestKind::intelligibility);
      check_count(out, *m, subject);
    }
    return out;
  }

  /// A report knows which answer is right: of whether a clip is real the first, of what was said the sentence.
  void check_count(const TestDesign& test, const LocatedJson& json, const std::string& subject) {
    if (test.questions.empty()) diagnostics_.error(json.place, subject + " asks nothing");
    if (test.kind != TestKind::perceptual && test.questions.size() > 1)
      diagnostics_.error(json.place, subject + " asks one question");
    if (test.kind == TestKind::turing && !test.questions.empty() && test.questions[0].options.size() > 2)
      diagnostics_.error(json.place, subject + ": the options are two, that of a real clip first");
  }

  std::vector<std::string> eyes(const LocatedJson& json, const std::string& subject) {
    std::vector<std::string> out;
    detail::read_parameter(json, out, {}, subject + ": \"eyes\"", diagnostics_);
    for (std::size_t i = 0; i < out.size(); ++i)
      if ((out[i] != "recorded" && out[i] != "static") || std::count(out.begin(), out.end(), out[i]) > 1)
        diagnostics_.error(json.items.at(i).place, subject + ": \"eyes\" holds \"recorded\", \"static\", or both");
    return out;
  }

  void check_split(const Design& design, const LocatedJson& json) {
    std::vector<std::string> known;
    for (const auto& q : design.profile) known.push_back(q.id);
    if (design.split_by.empty() || std::find(known.begin(), known.end(), design.split_by) != known.end()) return;
    diagnostics_.error(
        json.find("split_by")->value.place,
        fmt::format("the profile has no question \"{}\"{}", design.split_by, did_you_mean(design.split_by, known)));
  }

  Diagnostics& diagnostics_;
};

}  // namespace

std::vector<std::pair<std::string, std::string>> Ports::all() const {
  return {{"face", face},     {"recorded", recorded}, {"synthesised", synthesised}, {"mean", mean},
          {"mouths", mouths}, {"audio", audio},       {"recordings", recordings},   {"sentences", sentences}};
}

Place Design::at(std::initializer_list<std::string_view> path) const {
  const LocatedJson* here = &json;
  for (const auto key : path) {
    const auto* m = here->find(key);
    if (!m) break;
    here = &m->value;
  }
  return here->place;
}

std::optional<Design> load_design(const std::filesystem::path& file, Diagnostics& diagnostics) {
  const auto json = detail::parse_file(file, diagnostics);
  if (!json) return {};
  Design design = Reader(diagnostics).read(*json);
  if (!diagnostics.ok()) return {};
  return design;
}

}  // namespace study
}  // namespace talkgraph
