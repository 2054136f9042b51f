#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace talkgraph::study {

enum class TestKind { turing, perceptual, intelligibility };

/// A clip that people see. Its name tells nothing of what it shows.
struct Clip {
  std::string id;        ///< files clips/ID.webm and clips/ID.mp4
  std::string speaker;   ///< title of the run it comes from
  std::string sequence;  ///< recording of that run
  bool synthetic = false;
  std::string eyes;  ///< "recorded" or "static"; empty where none are seen or asked about
  double seconds = 0;
  std::vector<std::string> choices;  ///< of an intelligibility test: sentences to choose from
  int correct = -1;                  ///< which of them was said

  /// "LIPS style, synthetic, static eyes": clips of one category are scored together.
  std::string category() const;
};

/// Asked about a clip, or of a person; an answer is the number of an option, from 0.
struct Question {
  std::string id, text;
  std::vector<std::string> options;  ///< of an intelligibility test none: each clip has its choices
};

/// Clips shown one at a time.
struct Test {
  std::string id;
  TestKind kind = TestKind::turing;
  std::string title;
  std::vector<std::string> instructions;  ///< paragraphs
  std::vector<Question> questions;
  /// So many of each category are shown to a person: drawn for each anew, or all there are.
  int per_category = 0;
  std::vector<Clip> clips;
};

/// What people are shown and asked, as FOLDER/study.json has it.
struct Study {
  std::string title;
  std::vector<std::string> consent;  ///< paragraphs
  std::vector<std::string> thanks;
  std::vector<Question> profile;  ///< the last option of each: not to say
  std::string split_by;           ///< question of the profile by which answers are compared: "native"
  std::vector<Test> tests;
};

/// Throws std::runtime_error that names the file and what is wrong with it.
Study read_study(const std::filesystem::path& folder);
void write_study(const Study& study, const std::filesystem::path& folder);

}  // namespace talkgraph::study
