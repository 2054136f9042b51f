#include "tests/study/few_answers.h"

namespace talkgraph::study::test {
namespace {

std::vector<Clip> clips(const std::string& prefix, bool eyes, const std::vector<std::string>& choices) {
  std::vector<Clip> all;
  for (const bool synthetic : {false, true})
    for (const int number : {1, 2}) {
      Clip clip;
      clip.id = prefix + (synthetic ? "s" : "r") + std::to_string(number);
      clip.speaker = "Ann";
      clip.sequence = "sentence" + std::to_string(number);
      clip.synthetic = synthetic;
      if (eyes) clip.eyes = number == 1 ? "recorded" : "static";
      clip.choices = choices;
      clip.correct = choices.empty() ? -1 : 0;
      all.push_back(clip);
    }
  return all;
}

}  // namespace

Study small() {
  Study study;
  study.title = "Ann's <face>";
  study.profile = {{"native", "Is English your first language?", {"yes", "no", "not to say"}}};
  study.split_by = "native";
  study.tests = {
      {"turing",
       TestKind::turing,
       "Real?",
       {},
       {{"real", "Is it real?", {"real", "synthetic"}}},
       2,
       clips("t", false, {})},
      {"opinion",
       TestKind::perceptual,
       "Good?",
       {},
       {{"how_natural", "", {"1", "2", "3", "4", "5"}}},
       2,
       clips("o", true, {})},
      {"reading", TestKind::intelligibility, "Read", {}, {{"sentence", "", {}}}, 2, clips("i", false, {"yes", "no"})}};
  return study;
}

Answer answered(std::int64_t participant, const std::string& test, const std::string& clip, int option, int plays) {
  const std::string question = test == "turing" ? "real" : test == "opinion" ? "how_natural" : "sentence";
  return {participant, test, clip, question, option, 0, plays, 10.0 * plays, 2000};
}

Participant person(std::int64_t id, int native, std::int64_t finished) {
  return {id, {{"native", native}}, {}, 1000, finished};
}

Answers opinions() {
  Answers all{{person(1, 0, 1600), person(2, 0), person(3, 1, 1900)}, {}};
  const std::vector<std::vector<int>> given = {{5, 1}, {4, 2}, {4, 3}};
  for (std::int64_t p = 1; p <= 3; ++p)
    for (const char* number : {"1", "2"})
      for (const int synthetic : {0, 1})
        all.answers.push_back(
            answered(p, "opinion", std::string("o") + (synthetic ? "s" : "r") + number,
                     given[static_cast<std::size_t>(p - 1)][static_cast<std::size_t>(synthetic)] - 1));
  return all;
}

}  // namespace talkgraph::study::test
