#include "cli/cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace talkgraph::cli {
namespace {

struct Share {
  std::uint64_t entries = 0, bytes = 0;
};

std::string type_of(const Cache::Entry& entry) {
  return entry.about.is_null() ? "damaged" : entry.about["recipe"]["type"].get<std::string>();
}

}  // namespace

std::string size_text(std::uint64_t bytes) {
  auto size = static_cast<double>(bytes);
  const char* unit = "B";
  for (const char* next : {"kB", "MB", "GB", "TB"}) {
    if (size < 1000) break;
    size /= 1000;
    unit = next;
  }
  return fmt::format("{:.3g} {}", size, unit);
}

std::string cache_info(const Cache& cache) {
  std::map<std::string, Share> types;
  Share all;
  for (const auto& entry : cache.entries())
    for (auto* share : {&all, &types[type_of(entry)]}) share->entries += 1, share->bytes += entry.bytes;
  std::string out = fmt::format("{}\n{} results, {} of at most {}\n", cache.folder().string(), all.entries,
                                size_text(all.bytes), size_text(cache.limit()));
  std::vector<std::pair<std::string, Share>> sorted(types.begin(), types.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second.bytes > b.second.bytes; });
  for (const auto& [type, share] : sorted)
    out += fmt::format("  {:<28} {:>6}  {:>8}\n", type, share.entries, size_text(share.bytes));
  return out;
}

std::size_t cache_verify(const Cache& cache) {
  std::size_t damaged = 0;
  const auto entries = cache.entries();
  for (const auto& entry : entries) {
    const auto wrong = cache.verify(entry.key);
    if (wrong.empty()) continue;
    fmt::print("{} {}; {}\n", entry.key.str(), wrong, cache.remove(entry.key) ? "removed" : "it cannot be removed");
    ++damaged;
  }
  fmt::print("{} results, {} damaged\n", entries.size(), damaged);
  return damaged;
}

}  // namespace talkgraph::cli
