#include "bench/rows.h"

#include <algorithm>

#include "bench/child.h"

namespace talkgraph::bench {

std::function<double()> own(std::function<void()> work) {
  return [work = std::move(work)] {
    const double before = cpu_time();
    work();
    return cpu_time() - before;
  };
}

void measure(std::vector<Row>& rows) {
  for (int round = 0; round < rounds; ++round)
    for (auto& row : rows) row.seen.push_back(row.measure());
  for (auto& row : rows) std::sort(row.seen.begin(), row.seen.end());
}

}  // namespace talkgraph::bench
