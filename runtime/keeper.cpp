#include "runtime/keeper.h"

#include <fmt/format.h>

#include "runtime/why.h"

namespace talkgraph {

namespace fs = std::filesystem;

Keeper::Keeper(const Graph& graph, Cache& cache, fs::path folder, const std::atomic<bool>* cancel,
               std::function<void(std::string_view)> warn)
    : graph_(graph),
      cache_(cache),
      folder_(std::move(folder)),
      forecast_(graph, cache, cancel),
      warn_(std::move(warn)) {
  try {
    keep_snapshot(cache_, graph_, snapshot(graph_, forecast_));
  } catch (const std::exception& e) {
    give_up(e.what());
  }
}

void Keeper::give_up(const std::string& why) {
  if (full_.exchange(true)) return;
  std::error_code error;
  const auto space = fs::space(cache_.folder(), error);
  const bool full = !error && space.available < 16'000'000;
  warn_(fmt::format("from here on no results are kept for the next run: {}{}", why, full ? " (the disk is full)" : ""));
}

bool Keeper::keeps(int n) const {
  const auto& type = *graph_.nodes[static_cast<std::size_t>(n)].type;
  return type.stored || type.sink;
}

Cache::Claim Keeper::claim(int n, const std::string& item) const {
  const Key key = keeps(n) ? forecast_.key(n, item) : Key{};
  return key ? Cache::Claim(cache_, key) : Cache::Claim();
}

bool Keeper::made_meanwhile(int n, const std::string& item) const {
  const Key key = keeps(n) ? forecast_.key(n, item) : Key{};
  return key && cache_.has(key);
}

std::vector<std::string> Keeper::files(int n, const std::string& item) const {
  return cache_.files(forecast_.key(n, item));
}

Cache::Result Keeper::load(int n, const std::string& item) const {
  return cache_.load(forecast_.key(n, item), *graph_.nodes[static_cast<std::size_t>(n)].type, folder_);
}

std::uint64_t Keeper::keep(int n, const std::string& item, const Cache::Result& result, const fs::path& written) {
  const Key key = forecast_.key(n, item);
  if (!key || full_) return 0;
  if (const auto file = forecast_.changed_file(n, item); !file.empty()) {
    if (!changed_.exchange(true))
      warn_(fmt::format(
          "{} changed while the run was at work: what depends on it is not kept for the next run; run again",
          file.string()));
    return 0;
  }
  try {
    return cache_.store(key, forecast_.about(n, item), result, written);
  } catch (const std::exception& e) {
    give_up(e.what());
    return 0;
  }
}

}  // namespace talkgraph
