#pragma once

#include <filesystem>
#include <string>

#include "graph/context.h"
#include "nodes/types/report.h"

namespace talkgraph {

/// A file that a node writes below the run folder: under a temporary name until
/// it is whole. Throws std::runtime_error if its folder cannot be made.
class OutputFile {
 public:
  /// FOLDER/STEM + ending, where STEM is prefix + item + suffix, `otherwise` for a node
  /// that runs once. Slashes in the item become underscores.
  OutputFile(const Context& context, const std::string& folder, const std::string& prefix, const std::string& suffix,
             const std::string& ending, const std::string& otherwise);
  /// Removes what was not finished.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Where to write.
  std::string part() const { return part_.string(); }
  /// Gives the file its name.
  Artifact finish();

 private:
  std::string stem_;
  std::string path_;  ///< relative to the run folder
  std::filesystem::path file_;
  std::filesystem::path part_;
};

}  // namespace talkgraph
