#pragma once

#include <cstdint>
#include <string>

#include "runtime/cache.h"

namespace talkgraph::cli {

/// 1500 -> "1.5 kB".
std::string size_text(std::uint64_t bytes);

/// `talkgraph cache info`: where it is, how full, and of what node types.
std::string cache_info(const Cache& cache);

/// `talkgraph cache verify`: reads every entry and removes the damaged ones, which are named on stdout. Gives how many
/// there were.
std::size_t cache_verify(const Cache& cache);

}  // namespace talkgraph::cli
