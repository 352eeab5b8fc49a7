// The time that a study has, and the user who may end it.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <utility>

#include "core/accuracy/cost.h"

namespace whit {

class CostClock {
 public:
  explicit CostClock(const CostRequest& request) : request_(request) {}

  double spent() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - request_.started).count();
  }
  /// Seconds for rendering: what is kept for reporting is not among them.
  double left() const { return interrupted_ ? 0.0 : std::max(0.0, request_.seconds - kept_ - spent()); }
  void keep(double seconds) { kept_ = seconds; }
  void doing(std::string what) {
    what_ = std::move(what);
    go_on();
  }
  /// Reports progress; false when the time is spent or the user wants to end. From one thread at a time.
  bool go_on() {
    const double share = std::min(1.0, spent() / request_.seconds);
    if (!interrupted_ && request_.progress && !request_.progress(share, what_)) interrupted_ = true;
    return left() > 0;
  }
  bool interrupted() const { return interrupted_; }

 private:
  const CostRequest& request_;
  std::string what_ = "building";
  double kept_ = 0;
  std::atomic<bool> interrupted_{false};
};

}  // namespace whit
