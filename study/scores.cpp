#include "study/scores.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <tuple>

#include "study/session.h"

namespace talkgraph::study {
namespace {

template <class T>
const T* named(const std::vector<T>& things, const std::string& id) {
  const auto it = std::find_if(things.begin(), things.end(), [&](const T& thing) { return thing.id == id; });
  return it == things.end() ? nullptr : &*it;
}

double value_of(const Test& test, const Clip& clip, int option) {
  if (test.kind == TestKind::perceptual) return option + 1;
  return option == (test.kind == TestKind::turing ? 0 : clip.correct) ? 1 : 0;
}

std::runtime_error refusal(const Answer& answer, const std::string& cause) {
  return std::runtime_error(fmt::format("the answer of participant {} to \"{}\" of test \"{}\", clip \"{}\": {}",
                                        answer.participant, answer.question, answer.test, answer.clip, cause));
}

}  // namespace

double Measure::most() const { return is_share() ? 1 : static_cast<double>(question->options.size()); }

double Measure::chance() const {
  if (test->kind == TestKind::perceptual) return NAN;
  double sum = 0;
  for (const auto& clip : test->clips) sum += 1 / static_cast<double>(options(*question, clip).size());
  return sum / static_cast<double>(test->clips.size());
}

std::string plain_name(std::string id) {
  std::replace_if(
      id.begin(), id.end(), [](char c) { return c == '_' || c == '-'; }, ' ');
  return id;
}

Score score_of(const Study& study, const Answer& answer) {
  const Test* test = named(study.tests, answer.test);
  if (!test) throw refusal(answer, "there is no such test");
  const Question* question = named(test->questions, answer.question);
  if (!question) throw refusal(answer, "the test does not ask that");
  const Clip* clip = named(test->clips, answer.clip);
  if (!clip) throw refusal(answer, "the test has no such clip");
  const auto choices = options(*question, *clip).size();
  if (answer.option < 0 || answer.option >= static_cast<int>(choices))
    throw refusal(answer, fmt::format("option {}, where there are {}", answer.option, choices));
  return {test,          question,     clip,           answer.participant,
          answer.option, answer.plays, answer.seconds, value_of(*test, *clip, answer.option)};
}

std::vector<Measure> measures_of(const Study& study, const Answers& answers) {
  std::vector<Measure> measures;
  for (const auto& test : study.tests)
    for (const auto& question : test.questions) measures.push_back({&test, &question, {}});
  std::set<std::int64_t> people;
  for (const auto& participant : answers.participants) people.insert(participant.id);
  std::set<std::tuple<std::int64_t, const Clip*, const Question*>> seen;
  for (const auto& answer : answers.answers) {
    const Score score = score_of(study, answer);
    if (!people.contains(answer.participant)) throw refusal(answer, "there is no such participant");
    if (!seen.insert({answer.participant, score.clip, score.question}).second) throw refusal(answer, "given twice");
    std::find_if(measures.begin(), measures.end(), [&](const Measure& m) {
      return m.question == score.question;
    })->scores.push_back(score);
  }
  return measures;
}

Means means_of(const std::vector<Score>& scores) {
  std::map<std::int64_t, std::pair<double, double>> sums;
  for (const auto& score : scores) {
    auto& [sum, n] = sums[score.participant];
    sum += score.value, ++n;
  }
  Means means;
  for (const auto& [participant, of] : sums) means[participant] = of.first / of.second;
  return means;
}

std::vector<double> values_of(const Means& means) {
  std::vector<double> values;
  for (const auto& [participant, mean] : means) values.push_back(mean);
  return values;
}

std::size_t clips_shown(const Test& test) {
  std::map<std::string, std::size_t> categories;
  for (const auto& clip : test.clips) ++categories[clip.category()];
  std::size_t shown = 0;
  for (const auto& [category, clips] : categories)
    shown += std::min(clips, static_cast<std::size_t>(test.per_category));
  return shown;
}

int profile_option(const Question& question, const Participant& participant) {
  const auto it = participant.profile.find(question.id);
  const int not_to_say = static_cast<int>(question.options.size()) - 1;
  return it == participant.profile.end() || it->second < 0 || it->second >= not_to_say ? -1 : it->second;
}

}  // namespace talkgraph::study
