#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/run.h"
#include "graph/rational.h"
#include "nodes/types/report.h"

namespace talkgraph::cli {

/// What is known of one clip.
struct ClipFindings {
  std::string id, split;
  Scores findings, phones;               ///< of corpus.inspect
  std::vector<std::string> faults = {};  ///< what of it cannot be read, and why
  bool annotated = false;                ///< its landmarks are of some frames, as the manifest says
};

/// All clips together:
///   clips     id, split, findings of each, and "problems", texts
///   annotated ids of clips whose landmarks are of some frames
///   unread    ids of clips that cannot be read, or not all of them
///   splits, sound_seconds, picture_seconds, fps, sound_rate (how many clips have which)
///   lacking   for transcript, words, phones, landmarks: the clips without
///   offset    frames and milliseconds that the mouth is late, the mean correlation there, clips it was measured on;
///             null unless the correlation is higher than chance makes it
///   phones    how often each occurs; missing_phones
Json corpus_report(const std::vector<ClipFindings>& clips);

/// The same in words and tables for a terminal.
std::string report_text(const Json& report);

struct CorpusCommand {
  std::string source;  ///< check: a manifest, or a folder of GRID; new: a folder of clips
  bool json = false;   ///< check: the report as JSON
  std::string output;  ///< new: the manifest; empty: manifest.json in the folder
  bool overwrite = false;
  double validation = 0.1, test = 0.1;
  std::string rate;
};

/// `talkgraph corpus check`: looks a corpus over and writes what it is to standard output. Fails if a clip cannot be
/// read as a whole, or there is none. Throws std::invalid_argument if the source is neither a manifest nor GRID's
/// folder, std::runtime_error with all that is wrong with the manifest.
int check_corpus(const CorpusCommand& command, RunCommand run, const Registry& registry);

/// `talkgraph corpus new`: writes a manifest of a folder. Throws std::invalid_argument if it is there already.
int new_corpus(const CorpusCommand& command);

}  // namespace talkgraph::cli
