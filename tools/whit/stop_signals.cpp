#include "tools/whit/stop_signals.h"

#include <atomic>
#include <cstring>

namespace whit {
namespace {

std::atomic<int> which{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may use it");

/// Whoever asks twice means it: both keys at once, or a service manager after its patience.
void note(int signal) {
  which = signal;
  for (const int s : {SIGINT, SIGTERM, SIGHUP}) ::signal(s, SIG_DFL);
}

}  // namespace

StopSignals::StopSignals() {
  which = 0;
  struct sigaction action = {};
  action.sa_handler = note;
  action.sa_flags = SA_RESTART;
  for (size_t i = 0; i < kSignals.size(); ++i) {
    ::sigaction(kSignals[i], nullptr, &before_[i]);
    // nohup and shells without job control have their reasons.
    if (before_[i].sa_handler != SIG_IGN) ::sigaction(kSignals[i], &action, nullptr);
  }
}

StopSignals::~StopSignals() {
  for (size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &before_[i], nullptr);
}

bool StopSignals::come() { return which != 0; }

std::string StopSignals::name() {
  const char* const abbreviation = sigabbrev_np(which);
  return come() && abbreviation ? std::string("SIG").append(abbreviation) : "";
}

}  // namespace whit
