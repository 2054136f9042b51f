#include "study/messages.h"

#include <fmt/format.h>

#include <algorithm>

#include "web/server.h"

namespace talkgraph::study {
namespace {

using web::Refusal;

constexpr auto expected_profile = "an option of each question of the profile is expected";
constexpr auto expected_answers = "a clip, how often it was played, and an answer to each of its questions is expected";
constexpr int most_plays = 10'000;
constexpr double most_seconds = 1e7;

Json to_json(const Question& question) {
  return {{"id", question.id}, {"text", question.text}, {"options", question.options}};
}

Json to_json(const std::vector<Question>& questions) {
  Json all = Json::array();
  for (const auto& question : questions) all.push_back(to_json(question));
  return all;
}

/// A test from a clip on.
Json test_from(std::size_t first, const std::vector<Showing>& shown) {
  const auto& now = shown[first];
  Json clips = Json::array();
  for (std::size_t i = first; i < shown.size() && shown[i].test == now.test; ++i)
    clips.push_back({{"id", shown[i].clip->id}, {"choices", shown[i].clip->choices}});
  const auto begins = [](const Showing& s) { return s.position == 0; };
  const auto start = shown.begin();
  return {{"number", std::count_if(start, start + static_cast<std::ptrdiff_t>(first) + 1, begins)},
          {"tests", std::count_if(start, shown.end(), begins)},
          {"title", now.test->title},
          {"instructions", now.test->instructions},
          {"questions", to_json(now.test->questions)},
          {"position", now.position},
          {"clips", clips}};
}

int read_option(const Json& json, std::size_t options, const char* expected) {
  if (!json.is_number_unsigned() || json.get<std::uint64_t>() >= options) throw Refusal(400, expected);
  return json.get<int>();
}

const Json& member(const Json& json, const std::string& name, const char* expected) {
  if (!json.is_object() || !json.contains(name)) throw Refusal(400, expected);
  return json[name];
}

int read_plays(const Json& json) {
  const Json& plays = member(json, "plays", expected_answers);
  if (plays == 0) throw Refusal(400, expected_answers);
  return read_option(plays, most_plays + 1, expected_answers);
}

double read_seconds(const Json& json) {
  const Json& seconds = member(json, "seconds", expected_answers);
  if (!seconds.is_number() || seconds < 0 || seconds > most_seconds) throw Refusal(400, expected_answers);
  return seconds.get<double>();
}

}  // namespace

Json consent_of(const Study& study) {
  return {{"stage", "consent"}, {"title", study.title}, {"paragraphs", study.consent}};
}

Json state_of(const Study& study, const Taker& taker) {
  if (!taker.agreed) return consent_of(study);
  Json json = {{"stage", "profile"}, {"title", study.title}, {"questions", to_json(study.profile)}};
  if (!taker.started) return json;
  const auto shown = plan(study, taker.seed);
  const bool done = taker.clips >= shown.size();
  json = {{"stage", done ? "done" : "test"}, {"title", study.title}, {"done", taker.clips}, {"total", shown.size()}};
  if (done)
    json["paragraphs"] = study.thanks;
  else
    json["test"] = test_from(taker.clips, shown);
  return json;
}

std::map<std::string, int> profile_in(const Json& json, const Study& study) {
  if (!json.is_object() || json.size() != study.profile.size()) throw Refusal(400, expected_profile);
  std::map<std::string, int> profile;
  for (const auto& question : study.profile)
    profile[question.id] =
        read_option(member(json, question.id, expected_profile), question.options.size(), expected_profile);
  return profile;
}

std::size_t clip_in(const Json& json, const std::vector<Showing>& shown) {
  const Json& clip = member(json, "clip", expected_answers);
  const auto found = std::find_if(shown.begin(), shown.end(), [&](const Showing& s) { return clip == s.clip->id; });
  if (found == shown.end()) throw Refusal(404, "there is no such clip");
  return static_cast<std::size_t>(found - shown.begin());
}

std::vector<Answer> answers_in(const Json& json, const Showing& shown) {
  const auto& questions = shown.test->questions;
  const Json& given = member(json, "answers", expected_answers);
  if (given.size() != questions.size()) throw Refusal(400, expected_answers);
  std::vector<Answer> answers;
  for (const auto& question : questions) {
    const Json& one = member(given, question.id, expected_answers);
    Answer& answer = answers.emplace_back();
    answer.test = shown.test->id;
    answer.clip = shown.clip->id;
    answer.question = question.id;
    answer.option =
        read_option(member(one, "option", expected_answers), options(question, *shown.clip).size(), expected_answers);
    answer.position = shown.position;
    answer.plays = read_plays(json);
    answer.seconds = read_seconds(one);
  }
  return answers;
}

Json to_json(const Answers& all) {
  Json participants = Json::array(), answers = Json::array();
  for (const auto& p : all.participants)
    participants.push_back(
        {{"id", p.id}, {"profile", p.profile}, {"tests", p.tests}, {"started", p.started}, {"finished", p.finished}});
  for (const auto& a : all.answers)
    answers.push_back({{"participant", a.participant},
                       {"test", a.test},
                       {"clip", a.clip},
                       {"question", a.question},
                       {"option", a.option},
                       {"position", a.position},
                       {"plays", a.plays},
                       {"seconds", a.seconds},
                       {"given", a.given}});
  return {{"participants", participants}, {"answers", answers}};
}

std::string to_csv(const Answers& all) {
  std::string text = "participant,test,clip,question,option,position,plays,seconds,given\n";
  for (const auto& a : all.answers)
    text += fmt::format("{},{},{},{},{},{},{},{},{}\n", a.participant, a.test, a.clip, a.question, a.option, a.position,
                        a.plays, a.seconds, a.given);
  return text;
}

}  // namespace talkgraph::study
