#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/run.h"
#include "graph/registry.h"

namespace talkgraph::cli {

/// `talkgraph speak`: new speech drives a trained face.
struct SpeakCommand {
  std::string model;
  std::vector<std::string> files;        ///< recordings of speech, or
  std::string text;                      ///< what espeak-ng shall say
  std::vector<std::string> transcripts;  ///< what the recordings say: none, or one each
  std::filesystem::path output;          ///< clip (.mp4, .webm), or a folder for several
  std::filesystem::path visemes;         ///< .tsv or .json, or a folder for several; empty: none
  std::string base;                      ///< clip or still to draw upon; empty: the model's own
  std::vector<std::string> sets;
  int threads = 2;
  std::optional<ProgressStyle> progress;
};

int speak(const SpeakCommand& command, const Registry& registry);

}  // namespace talkgraph::cli
