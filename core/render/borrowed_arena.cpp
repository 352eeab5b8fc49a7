#include "core/render/borrowed_arena.h"

#include <map>
#include <mutex>
#include <utility>
#include <vector>

namespace whit {
namespace {

struct Idle {
  std::mutex mutex;
  std::map<int, std::vector<std::unique_ptr<tbb::task_arena>>> arenas;  ///< By their number of threads.
};

/// Never destroyed, since TBB may be gone when the process ends.
Idle& idle() {
  static Idle& all = *new Idle;
  return all;
}

}  // namespace

BorrowedArena::BorrowedArena(int threads) : threads_(threads) {
  const std::lock_guard lock(idle().mutex);
  auto& arenas = idle().arenas[threads];
  if (arenas.empty()) {
    arena_ = std::make_unique<tbb::task_arena>(threads);
    return;
  }
  arena_ = std::move(arenas.back());
  arenas.pop_back();
}

BorrowedArena::~BorrowedArena() {
  const std::lock_guard lock(idle().mutex);
  idle().arenas[threads_].push_back(std::move(arena_));
}

}  // namespace whit
