// As threads.h says.
#pragma once

#include "tests/tsan/tbb/threads.h"

namespace tbb {

class task_arena {
 public:
  explicit task_arena(int threads) : threads_(static_cast<size_t>(threads)) {}
  template <class Body>
  void execute(const Body& body) {
    const size_t before = stand_in::of_arena;
    stand_in::of_arena = threads_;
    stand_in::Failure failure;
    failure.guard(body);
    stand_in::of_arena = before;
    failure.rethrow();
  }

 private:
  size_t threads_;
};

namespace this_task_arena {

inline int max_concurrency() { return static_cast<int>(stand_in::concurrency()); }

/// A thread of the stand-in takes up no other task while it waits.
template <class Body>
void isolate(const Body& body) {
  body();
}

}  // namespace this_task_arena
}  // namespace tbb
