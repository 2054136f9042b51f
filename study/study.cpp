#include "study/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <set>
#include <stdexcept>

#include "graph/json.h"
#include "graph/output_file.h"

namespace talkgraph::study {
namespace {

constexpr std::array kind_names{"turing", "perceptual", "intelligibility"};

TestKind kind_of(const std::string& name) {
  const auto found = std::find(kind_names.begin(), kind_names.end(), name);
  if (found == kind_names.end()) throw std::runtime_error(fmt::format("\"{}\" is no kind of test", name));
  return static_cast<TestKind>(found - kind_names.begin());
}

Json to_json(const Clip& c) {
  return {{"id", c.id},     {"speaker", c.speaker}, {"sequence", c.sequence}, {"synthetic", c.synthetic},
          {"eyes", c.eyes}, {"seconds", c.seconds}, {"choices", c.choices},   {"correct", c.correct}};
}

Json to_json(const Question& q) { return {{"id", q.id}, {"text", q.text}, {"options", q.options}}; }

Json to_json(const Test& t);

template <class T>
Json list_of(const std::vector<T>& things) {
  Json list = Json::array();
  for (const auto& thing : things) list.push_back(to_json(thing));
  return list;
}

Json to_json(const Test& t) {
  return {{"id", t.id},
          {"kind", kind_names[static_cast<std::size_t>(t.kind)]},
          {"title", t.title},
          {"instructions", t.instructions},
          {"questions", list_of(t.questions)},
          {"per_category", t.per_category},
          {"clips", list_of(t.clips)}};
}

void from(const Json& json, Clip& c) {
  c.id = json.at("id");
  c.speaker = json.at("speaker");
  c.sequence = json.at("sequence");
  c.synthetic = json.at("synthetic");
  c.eyes = json.at("eyes");
  c.seconds = json.at("seconds");
  c.choices = json.at("choices");
  c.correct = json.at("correct");
}

void from(const Json& json, Question& q) {
  q.id = json.at("id");
  q.text = json.at("text");
  q.options = json.at("options");
}

void from(const Json& json, Test& t);

template <class T>
std::vector<T> list_from(const Json& json) {
  std::vector<T> things(json.size());
  for (std::size_t i = 0; i < things.size(); ++i) from(json.at(i), things[i]);
  return things;
}

void from(const Json& json, Test& t) {
  t.id = json.at("id");
  t.kind = kind_of(json.at("kind"));
  t.title = json.at("title");
  t.instructions = json.at("instructions");
  t.questions = list_from<Question>(json.at("questions"));
  t.per_category = json.at("per_category");
  t.clips = list_from<Clip>(json.at("clips"));
}

Study from(const Json& json) {
  Study study;
  study.title = json.at("title");
  study.consent = json.at("consent");
  study.thanks = json.at("thanks");
  study.profile = list_from<Question>(json.at("profile"));
  study.split_by = json.at("split_by");
  study.tests = list_from<Test>(json.at("tests"));
  return study;
}

/// Names become parts of paths and of addresses.
void check_name(const std::string& name, std::set<std::string>& taken) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
  if (name.empty() || name.size() > 64 || !std::all_of(name.begin(), name.end(), plain))
    throw std::runtime_error(fmt::format("\"{}\" is no name of letters and digits", name));
  if (!taken.insert(name).second) throw std::runtime_error(fmt::format("\"{}\" is there twice", name));
}

void check_questions(const std::vector<Question>& questions, std::size_t options) {
  std::set<std::string> names;
  for (const auto& q : questions) {
    check_name(q.id, names);
    if (q.options.size() < options)
      throw std::runtime_error(fmt::format("question \"{}\" has {} options", q.id, q.options.size()));
  }
}

void check(const Study& study) {
  check_questions(study.profile, 2);
  std::set<std::string> tests, clips;
  for (const auto& test : study.tests) {
    const bool choices = test.kind == TestKind::intelligibility;
    check_name(test.id, tests);
    check_questions(test.questions, choices ? 0 : 2);
    if (test.questions.empty() || test.clips.empty() || test.per_category < 1)
      throw std::runtime_error(fmt::format("test \"{}\" asks or shows nothing", test.id));
    for (const auto& clip : test.clips) {
      check_name(clip.id, clips);
      if (choices && (clip.correct < 0 || clip.correct >= static_cast<int>(clip.choices.size())))
        throw std::runtime_error(fmt::format("clip \"{}\" has no right choice", clip.id));
    }
  }
  if (study.tests.empty()) throw std::runtime_error("there are no tests");
  const auto named = [&](const Question& q) { return q.id == study.split_by; };
  if (!study.split_by.empty() && std::none_of(study.profile.begin(), study.profile.end(), named))
    throw std::runtime_error(fmt::format("the profile has no question \"{}\"", study.split_by));
}

}  // namespace

std::string Clip::category() const {
  return fmt::format("{}, {}{}", speaker, synthetic ? "synthetic" : "real", eyes.empty() ? "" : ", " + eyes + " eyes");
}

Study read_study(const std::filesystem::path& folder) {
  const auto file = folder / "study.json";
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(fmt::format("{}: cannot be read; `talkgraph study make` makes it", file.string()));
  try {
    auto study = from(Json::parse(in));
    check(study);
    return study;
  } catch (const std::exception& e) {
    throw std::runtime_error(fmt::format("{}: is no study: {}", file.string(), e.what()));
  }
}

void write_study(const Study& study, const std::filesystem::path& folder) {
  check(study);
  const Json json = {{"title", study.title},       {"consent", study.consent},
                     {"thanks", study.thanks},     {"profile", list_of(study.profile)},
                     {"split_by", study.split_by}, {"tests", list_of(study.tests)}};
  write_file(folder / "study.json", json.dump(2) + "\n");
}

}  // namespace talkgraph::study
