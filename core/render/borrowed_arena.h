// Arenas of TBB's that are used again: one that threads have worked in leaves 7 KiB behind when it goes (oneTBB 2021.8), which
// previews and programs that render for days would notice.
#pragma once

#include <tbb/task_arena.h>

#include <memory>

namespace whit {

/// An arena of so many threads, for nobody else while this lives.
class BorrowedArena {
 public:
  explicit BorrowedArena(int threads);
  ~BorrowedArena();
  BorrowedArena(const BorrowedArena&) = delete;
  BorrowedArena& operator=(const BorrowedArena&) = delete;

  template <class Body>
  void execute(const Body& body) {
    arena_->execute(body);
  }

 private:
  const int threads_;
  std::unique_ptr<tbb::task_arena> arena_;
};

}  // namespace whit
