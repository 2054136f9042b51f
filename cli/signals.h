#pragma once

#include <atomic>

namespace talkgraph::cli {

/// While it lives, Ctrl-C, a closed terminal and a request to end raise a flag,
/// so that work stops cleanly; a second signal ends the program at once.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  const std::atomic<bool>* flag() const;

 private:
  void (*before_[3])(int);
};

}  // namespace talkgraph::cli
