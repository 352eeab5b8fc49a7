// A stand-in for as much of TBB as whit uses, for the thread sanitizer: TBB's library is not compiled with it, so that the
// sanitizer does not see that a task begins after what made it and ends before what waits for it, and every result of a
// parallel loop would be a data race. Here tasks are plain threads, which it does see. The tsan preset includes these files
// instead of TBB's; nothing else does.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace tbb {
namespace stand_in {

/// How many threads global_control allows, and the arena of this thread; 0: as many as there are cores.
inline std::atomic<size_t> allowed{0};
inline thread_local size_t of_arena = 0;
/// Within a task loops run on its own thread: threads shall not multiply.
inline thread_local bool in_task = false;

inline size_t concurrency() {
  // At least two on any machine, or there would be nothing to find.
  const size_t cores = std::max<size_t>(std::thread::hardware_concurrency(), 2);
  const size_t most = allowed != 0 ? std::min<size_t>(allowed, cores) : cores;
  return of_arena != 0 ? std::min(of_arena, most) : most;
}

/// The first exception of several threads, to be thrown again by who waits for them.
class Failure {
 public:
  template <class Body>
  bool guard(const Body& body) {
    try {
      body();
      return true;
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!first_) first_ = std::current_exception();
      return false;
    }
  }
  void rethrow() const {
    if (first_) std::rethrow_exception(first_);
  }

 private:
  std::mutex mutex_;
  std::exception_ptr first_;
};

/// Calls work() on so many threads, this one among them, and waits for all.
template <class Work>
void on_threads(size_t count, const Work& work) {
  Failure failure;
  const auto guarded = [&] { failure.guard(work); };
  std::vector<std::thread> others;
  for (size_t i = 1; i < count && !in_task; ++i) {
    others.emplace_back([&] {
      in_task = true;
      guarded();
    });
  }
  const bool before = in_task;
  in_task = true;
  guarded();
  in_task = before;
  for (std::thread& other : others) other.join();
  failure.rethrow();
}

/// Calls body(i) for all i below n, in any order.
template <class Body>
void for_each_index(size_t n, const Body& body) {
  std::atomic<size_t> next{0};
  on_threads(std::min(concurrency(), n), [&] {
    for (size_t i = next++; i < n; i = next++) body(i);
  });
}

}  // namespace stand_in
}  // namespace tbb
