// How long a save of the study's server takes when a hundred people take the study at once, over loopback.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <mutex>

#include "graph/random.h"
#include "study/store.h"
#include "tests/study/running_server.h"
#include "tests/study/simulated.h"
#include "tests/study/small_study.h"

namespace talkgraph::bench {

constexpr int people = 100;

/// Seconds that saves took, in order: from the first byte of a request to the last of its answer, and of these in the
/// server, from the request read to its answer ready.
struct Saves {
  std::vector<double> all, in_server;
};

/// The person rests `rest` seconds on average after each.
Saves saves(const std::filesystem::path& folder, double rest) {
  study::write_small_study(folder);
  Saves saves;
  {
    std::mutex mutex;
    auto options = study::RunningServer::at_any_port();
    options.saved = [&](double seconds) {
      const std::lock_guard lock(mutex);
      saves.in_server.push_back(seconds);
    };
    study::RunningServer server(folder, options);
    std::vector<std::thread> threads;
    for (int i = 0; i < people; ++i)
      threads.emplace_back([&, i] {
        Random random(static_cast<std::uint64_t>(i));
        const auto pause = [&] {
          std::this_thread::sleep_for(std::chrono::duration<double>(2 * rest * random.uniform()));
        };
        pause();
        study::take_study(server->port(), study::RunningServer::path(server->start_url()), i, [&](double seconds) {
          {
            const std::lock_guard lock(mutex);
            saves.all.push_back(seconds);
          }
          pause();
        });
      });
    for (auto& thread : threads) thread.join();
  }
  const auto kept = study::read_answers(folder);
  if (kept.participants.size() != people) throw std::runtime_error("people are missing");
  std::filesystem::remove_all(folder);
  std::sort(saves.all.begin(), saves.all.end());
  std::sort(saves.in_server.begin(), saves.in_server.end());
  return saves;
}

void compare() {
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("talkgraph-bench-study-{}", getpid());
  fmt::print("Saves of {} people at once, milliseconds:\n\n", people);
  fmt::print(
      "| rest between saves | saves | median | 99 of 100 within | in the server | longest | processor time of both "
      "sides, each |\n");
  fmt::print("|---|---|---|---|---|---|---|\n");
  const auto most_of = [](const std::vector<double>& times) { return 1000 * times[times.size() * 99 / 100]; };
  for (const double rest : {2.0, 0.5, 0.0}) {
    const auto before = std::clock();
    const auto [all, in_server] = saves(folder, rest);
    const double processor = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    fmt::print("| {} s | {} | {:.0f} | {:.0f} | {:.0f} | {:.0f} | {:.1f} |\n", rest, all.size(),
               1000 * all[all.size() / 2], most_of(all), most_of(in_server), 1000 * all.back(),
               1000 * processor / static_cast<double>(all.size()));
  }
}

}  // namespace talkgraph::bench

int main() {
  try {
    talkgraph::bench::compare();
  } catch (const std::exception& e) {
    fmt::print(stderr, "bench_study: {}\n", e.what());
    return 1;
  }
}
