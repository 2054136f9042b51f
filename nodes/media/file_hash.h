#pragma once

#include <string>

namespace talkgraph {

/// 128 bits of a file's bytes, as 32 hexadecimal digits. Throws
/// std::runtime_error if it cannot be read.
std::string file_hash(const std::string& path);

}  // namespace talkgraph
