#pragma once

#include <string>

namespace talkgraph::test {

/// A file of the source tree. One object alone knows where that lies, so that all others compile to the same in any
/// clone.
std::string source(const std::string& path);

}  // namespace talkgraph::test
