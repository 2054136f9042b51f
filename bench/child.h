#pragma once

#include <string>
#include <vector>

namespace talkgraph::bench {

/// User and system time of this process with all its threads, seconds.
double cpu_time();

/// Runs a program with its standard output thrown away and gives its user and system time, seconds. Throws
/// std::runtime_error if it cannot be started or does not end with success.
double child_cpu_time(const std::vector<std::string>& command);

}  // namespace talkgraph::bench
