#include "bench/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <chrono>
#include <cstring>
#include <stdexcept>

namespace talkgraph::bench {
namespace {

double seconds(const rusage& usage) {
  const auto sum = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return sum(usage.ru_utime) + sum(usage.ru_stime);
}

}  // namespace

double cpu_time() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return seconds(usage);
}

Usage child_usage(const std::vector<std::string>& command) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<char*> arguments;
  for (const auto& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t pid = 0;
  const int error = posix_spawnp(&pid, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error) throw std::runtime_error(fmt::format("{} cannot be started: {}", command[0], std::strerror(error)));
  int status = 0;
  rusage usage{};
  wait4(pid, &status, 0, &usage);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw std::runtime_error(command[0] + " failed");
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return {seconds(usage), wall, 1024.0 * static_cast<double>(usage.ru_maxrss)};
}

double child_cpu_time(const std::vector<std::string>& command) { return child_usage(command).cpu; }

}  // namespace talkgraph::bench
