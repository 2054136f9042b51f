#include "tests/study/small_study.h"

#include <fmt/format.h>

#include "graph/output_file.h"

namespace talkgraph::study {
namespace {

Clip clip(const std::string& test, int number, bool synthetic, const std::string& eyes) {
  return {fmt::format("{}{}", test, number), "Ann", fmt::format("secret{}", number), synthetic, eyes, 0.8, {}, -1};
}

Test turing() {
  Test test{"turing",
            TestKind::turing,
            "Real or synthetic?",
            {"You will see the lower half of a face."},
            {{"real", "What did you see?", {"real", "synthetic"}}},
            2,
            {}};
  for (int i = 0; i < 6; ++i) test.clips.push_back(clip("t", i, i % 2, ""));
  return test;
}

Test perceptual() {
  const std::vector<std::string> scale{"bad", "poor", "fair", "good", "excellent"};
  Test test{"perceptual", TestKind::perceptual, "How good is it?", {"You will see a face that speaks."}, {}, 2, {}};
  for (const char* what : {"articulation", "naturalness", "agreeableness"})
    test.questions.push_back({what, fmt::format("The {} is", what), scale});
  for (int i = 0; i < 12; ++i) test.clips.push_back(clip("p", i, i % 2, i % 4 < 2 ? "recorded" : "static"));
  return test;
}

Test intelligibility() {
  Test test{"intelligibility",
            TestKind::intelligibility,
            "What is said?",
            {"There is no sound."},
            {{"sentence", "Which sentence was said?", {}}},
            2,
            {}};
  for (int i = 0; i < 6; ++i) {
    test.clips.push_back(clip("i", i, i % 2, ""));
    test.clips.back().choices = {"bin blue at f two now", "lay red by c nine please", "set green in x four soon",
                                 "place white with k one again"};
    test.clips.back().correct = i % 4;
  }
  return test;
}

}  // namespace

Study small_study() {
  Study study;
  study.title = "Talking faces";
  study.consent = {"You will watch short clips and answer questions about them.", "You may stop at any time."};
  study.thanks = {"Thank you: that was all."};
  study.profile = {{"age", "How old are you?", {"20 or less", "21 to 40", "above 40", "prefer not to say"}},
                   {"native", "Is English your first language?", {"yes", "no", "prefer not to say"}}};
  study.split_by = "native";
  study.tests = {turing(), perceptual(), intelligibility()};
  return study;
}

void write_small_study(const std::filesystem::path& folder) {
  const auto study = small_study();
  write_study(study, folder);
  for (const auto& test : study.tests)
    for (const auto& clip : test.clips)
      for (const char* ending : {"webm", "mp4"})
        write_file(folder / "clips" / fmt::format("{}.{}", clip.id, ending),
                   fmt::format("bytes of {}.{}", clip.id, ending));
}

}  // namespace talkgraph::study
