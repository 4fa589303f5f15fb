#include "interrupt.h"

#include <atomic>
#include <csignal>

namespace stereovox {
namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set in a signal handler");

void handle_interrupt(int signal) {
  interrupted = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void report_failed_writes() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void catch_interrupt() { std::signal(SIGINT, handle_interrupt); }

bool was_interrupted() { return interrupted; }

}  // namespace stereovox
