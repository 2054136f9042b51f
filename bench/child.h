#pragma once

#include <string>
#include <vector>

namespace talkgraph::bench {

/// User and system time of this process with all its threads, seconds.
double cpu_time();

/// What a process took.
struct Usage {
  double cpu = 0;     ///< user and system time, seconds
  double wall = 0;    ///< seconds
  double memory = 0;  ///< most at any time, bytes
};

/// Runs a program with its standard output thrown away. Throws std::runtime_error if it cannot be started or does not
/// end with success.
Usage child_usage(const std::vector<std::string>& command);
double child_cpu_time(const std::vector<std::string>& command);

}  // namespace talkgraph::bench
