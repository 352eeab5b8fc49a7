// Long work in a thread of its own, while the one that asked for it looks up now and then: for signals, which Python gives
// to the thread that runs it, and to tell how far the work is.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <type_traits>

#include "python/threads.h"

namespace whit::python {

/// What passes between the two threads.
class Attention {
 public:
  /// From the work, of any of its threads: how far it is, in [0,1]. False when it should end.
  bool go_on(double share) {
    share_ = share;
    return !ended_;
  }
  bool ended() const { return ended_; }
  double share() const { return share_; }
  void end() { ended_ = true; }

 private:
  std::atomic<double> share_{0};
  std::atomic<bool> ended_{false};
};

/// Looks up: gets how far the work is. False ends it early, which then returns what it has; an exception ends it too, and
/// goes to whoever asked.
using Look = std::function<bool(double)>;

/// The result of work(attention), or the exception that it ended with.
template <class Work>
auto attended(Work&& work, const Look& look) {
  constexpr std::chrono::milliseconds kEvery{50};
  Attention attention;
  using Result = std::invoke_result_t<Work&, Attention&>;
  // Shared, since the thread may leave it after the result is there.
  const auto task = std::make_shared<std::packaged_task<Result()>>([&] { return work(attention); });
  std::future<Result> result = task->get_future();
  run_in_thread([task] { (*task)(); });
  try {
    while (result.wait_for(kEvery) != std::future_status::ready) {
      if (!look(attention.share())) attention.end();
    }
  } catch (...) {
    attention.end();
    result.wait();
    throw;
  }
  return result.get();
}

}  // namespace whit::python
