#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "graph/json.h"
#include "graph/parameter.h"
#include "study/study.h"

namespace talkgraph::study {

/// What a test shows: clips of as many categories as there are runs × real and synthetic × eyes.
struct TestDesign {
  std::string id;
  TestKind kind = TestKind::turing;
  std::string title;
  std::vector<std::string> instructions;
  std::vector<Question> questions;
  int clips = 0;                  ///< that a person sees, equally many of each category
  int pool = 0;                   ///< that they are drawn from, at most
  std::vector<std::string> eyes;  ///< "recorded", "static": of a perceptual test
  int choices = 4;                ///< sentences to choose from, of an intelligibility test
};

/// Ports of a run's graph, "NODE.PORT": an output, or an input, which means what is wired to it.
struct Ports {
  std::string face;         ///< AppearanceModel
  std::string recorded;     ///< Stream<Track>: normalised visual parameters of the recordings held out
  std::string synthesised;  ///< Stream<Track>: those imitated
  std::string mean;         ///< Stream<Track>: what normalising took off the recorded ones
  std::string mouths;       ///< Mouths
  std::string audio;        ///< Stream<Audio>
  std::string recordings;   ///< Stream<Recording>: those held out
  std::string sentences;  ///< Stream<Recording>: whose transcripts join those of the former as false choices, or empty

  /// Each with its name.
  std::vector<std::pair<std::string, std::string>> all() const;
};

/// A study to be made: STUDY.json (docs/study.md).
struct Design {
  std::string title;
  std::vector<std::string> consent, thanks;
  std::vector<Question> profile;
  std::string split_by;
  std::uint64_t seed = 1;
  std::vector<std::string> speakers;  ///< names of the runs, or empty: as their reports are called
  FilePath draw;                      ///< graph that draws a clip
  Ports ports;
  std::vector<TestDesign> tests;
  LocatedJson json;  ///< all of it as it was read

  /// Where a member stands, or as much of the way there as there is.
  Place at(std::initializer_list<std::string_view> path) const;
};

/// Reads STUDY.json. All that is wrong goes to `diagnostics`; nothing is returned then.
std::optional<Design> load_design(const std::filesystem::path& file, Diagnostics& diagnostics);

/// The JSON Schema of such files, for editors.
Json design_schema();

}  // namespace talkgraph::study
