#include "cli/signals.h"

#include <csignal>
#include <iterator>

namespace talkgraph::cli {
namespace {

constexpr int signals[] = {SIGINT, SIGTERM, SIGHUP};
std::atomic<bool> interrupted{false};

void interrupt(int) {
  interrupted = true;
  for (const int signal : signals) std::signal(signal, SIG_DFL);
}

}  // namespace

InterruptGuard::InterruptGuard() {
  interrupted = false;
  for (std::size_t i = 0; i < std::size(signals); ++i) before_[i] = std::signal(signals[i], interrupt);
}

InterruptGuard::~InterruptGuard() {
  for (std::size_t i = 0; i < std::size(signals); ++i) std::signal(signals[i], before_[i]);
}

const std::atomic<bool>* InterruptGuard::flag() const { return &interrupted; }

}  // namespace talkgraph::cli
