#include "tests/source_folder.h"

namespace talkgraph::test {

std::string source(const std::string& path) { return TALKGRAPH_SOURCE_DIR + path; }

}  // namespace talkgraph::test
