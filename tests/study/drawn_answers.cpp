#include "tests/study/drawn_answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/session.h"

namespace talkgraph::study::test {
namespace {

/// `n` clips of every category.
void add_clips(Test& test, int n, const std::vector<std::string>& eyes) {
  for (const char* speaker : {"LIPS", "DEMNOW"})
    for (const auto& of : eyes)
      for (int i = 0; i < n; ++i)
        for (const bool synthetic : {false, true}) {
          const auto number = test.clips.size();
          Clip clip{fmt::format("{}{}", test.id[0], number),
                    speaker,
                    fmt::format("{}{}", speaker, i),
                    synthetic,
                    of,
                    3,
                    {},
                    -1};
          if (test.kind == TestKind::intelligibility) {
            clip.choices = {"bin blue", "lay red", "set white", "place green"};
            clip.correct = static_cast<int>(number % 4);
          }
          test.clips.push_back(std::move(clip));
        }
}

/// One that is as likely as another; rarely the last, not to say.
int drawn_option(const Question& question, Random& random) {
  const auto last = question.options.size() - 1;
  return static_cast<int>(random.uniform() < 0.04 ? last : random.below(last));
}

int answer_to(const Test& test, const Question& question, const Clip& clip, double mean, double deviation,
              Random& random) {
  switch (test.kind) {
    case TestKind::turing:
      return random.uniform() < mean ? 0 : 1;
    case TestKind::perceptual:
      return std::clamp(static_cast<int>(std::lround(mean + deviation * random.normal())), 1,
                        static_cast<int>(question.options.size())) -
             1;
    default:
      if (random.uniform() < mean) return clip.correct;
      return static_cast<int>((static_cast<std::size_t>(clip.correct) + 1 + random.below(clip.choices.size() - 1)) %
                              clip.choices.size());
  }
}

}  // namespace

Study full_study() {
  Study study;
  study.title = "How real is a talking face?";
  study.consent = {"You may stop at any time."};
  study.thanks = {"Thank you."};
  study.profile = {{"age",
                    "How old are you?",
                    {"20 or less", "21 to 30", "31 to 40", "41 to 50", "51 to 60", "above 60", "prefer not to say"}},
                   {"sex", "What is your sex?", {"male", "female", "prefer not to say"}},
                   {"computer_hours",
                    "How many hours a day do you use computers?",
                    {"less than 1", "1 to 5", "6 to 10", "11 to 15", "more than 15", "prefer not to say"}},
                   {"native", "Are you a native English speaker?", {"yes", "no", "prefer not to say"}}};
  study.split_by = "native";
  const std::vector<std::string> scale = {"1, poor", "2", "3", "4", "5, excellent"};
  Test turing{
      "turing", TestKind::turing, "Real or synthetic?", {}, {{"real", "What did you see?", {"real", "synthetic"}}}, 4,
      {}};
  Test perceptual{"perceptual", TestKind::perceptual, "How good is it?", {}, {}, 3, {}};
  perceptual.questions = {{"articulation", "How well does the mouth fit the sound?", scale},
                          {"naturalness", "How natural is the face?", scale},
                          {"agreeableness", "How much would you like to talk with this face?", scale}};
  Test reading{"intelligibility",
               TestKind::intelligibility,
               "What is said?",
               {},
               {{"sentence", "Which sentence was said?", {}}},
               3,
               {}};
  add_clips(turing, 15, {""});
  add_clips(perceptual, 3, {"recorded", "static"});
  add_clips(reading, 15, {""});
  study.tests = {turing, perceptual, reading};
  return study;
}

double published_mean(const Test& test, const Question& question, const Clip& clip, bool native) {
  const bool lips = clip.speaker == "LIPS", synthetic = clip.synthetic, still = clip.eyes == "static";
  if (test.kind == TestKind::turing) return synthetic ? (lips ? 0.38 : 0.45) : (lips ? 0.70 : 0.73);
  if (test.kind == TestKind::intelligibility)
    return native ? (lips ? (synthetic ? 0.828 : 0.878) : (synthetic ? 0.656 : 0.756))
                  : (lips ? (synthetic ? 0.549 : 0.685) : (synthetic ? 0.546 : 0.641));
  if (question.id == "articulation")
    return lips ? (still ? (synthetic ? 3.78 : 3.99) : (synthetic ? 3.70 : 4.13))
                : (still ? (synthetic ? 3.92 : 4.15) : (synthetic ? 3.73 : 4.08));
  if (question.id == "naturalness")
    return lips ? (still ? (synthetic ? 3.19 : 3.10) : (synthetic ? 3.10 : 3.63))
                : (still ? (synthetic ? 3.50 : 3.60) : (synthetic ? 3.56 : 3.87));
  return lips ? (still ? (synthetic ? 3.12 : 3.11) : (synthetic ? 3.10 : 3.55))
              : (still ? (synthetic ? 3.44 : 3.54) : (synthetic ? 3.50 : 3.76));
}

Answers simulate(const Study& study, const Behaviour& behaviour, int people, Random& random) {
  Answers all;
  std::int64_t clock = 1'350'000'000;
  for (int id = 1; id <= people; ++id) {
    Participant person{id, {}, {}, clock += 3600 * 20, 0};
    const bool native = random.uniform() < behaviour.native;
    for (const auto& question : study.profile)
      person.profile[question.id] = question.id == "native" ? !native : drawn_option(question, random);
    const double leaning = behaviour.leaning * random.normal();
    std::int64_t now = person.started;
    bool goes_on = true;
    for (const auto& [test, clip, position] : plan(study, random.bits())) {
      if (position == 0) person.tests.push_back(test->id);
      if (!(goes_on = random.uniform() >= behaviour.give_up)) break;
      int plays = 1;
      while (plays < 9 && random.uniform() < behaviour.replay) ++plays;
      const double seconds = plays * clip->seconds + 2 + 4 * random.uniform();
      now += std::lround(seconds);
      for (const auto& question : test->questions) {
        const double mean = behaviour.mean(*test, question, *clip, native);
        const double of_person = test->kind == TestKind::perceptual ? mean + leaning : mean;
        const int option = answer_to(*test, question, *clip, of_person, behaviour.noise, random);
        all.answers.push_back({id, test->id, clip->id, question.id, option, position, plays, seconds, now});
      }
    }
    if (goes_on) person.finished = now;
    all.participants.push_back(std::move(person));
  }
  return all;
}

}  // namespace talkgraph::study::test
