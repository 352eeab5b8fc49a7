// The scratch memory of one worker: allocation is a pointer bump, freeing is a reset. Nothing in the
// rendering loop calls the heap once the arena has grown to the size the scene needs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "core/batch/lanes.h"

namespace whit {

/// A bump allocator of 64-byte aligned arrays. Not thread-safe: one per worker.
class Arena {
 public:
  /// Takes memory from the heap in blocks of so many bytes, or what a larger array needs.
  explicit Arena(size_t block_size = size_t{1} << 20) : block_size_(block_size) {}
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  /// An uninitialised array of n values of a trivial type, padded so that whole vectors may be read past it.
  template <class T>
  T* alloc(int n) {
    static_assert(std::is_trivially_destructible_v<T>);
    return static_cast<T*>(take((static_cast<size_t>(n) * sizeof(T) + 2 * kAlign - 1) & ~(kAlign - 1)));
  }
  float* floats(int n) { return alloc<float>(n); }
  Vec3Lanes vec3(int n) { return {floats(n), floats(n), floats(n)}; }
  RGBLanes rgb(int n) { return {floats(n), floats(n), floats(n)}; }

  /// A position to return to: everything allocated after mark() is freed by release().
  struct Mark {
    size_t block, used;
  };
  Mark mark() const { return {current_, used_}; }
  void release(Mark m) { current_ = m.block, used_ = m.used; }

  /// Bytes held.
  size_t capacity() const;

 private:
  static constexpr size_t kAlign = 64;
  struct Free {
    void operator()(void* p) const { std::free(p); }
  };
  struct Block {
    std::unique_ptr<std::byte, Free> data;
    size_t size = 0;
  };

  void* take(size_t bytes) {
    if (current_ < blocks_.size() && used_ + bytes <= blocks_[current_].size) {
      void* p = blocks_[current_].data.get() + used_;
      used_ += bytes;
      return p;
    }
    return take_from_next_block(bytes);
  }
  void* take_from_next_block(size_t bytes);

  const size_t block_size_;
  std::vector<Block> blocks_;
  size_t current_ = 0, used_ = 0;
};

/// Frees what was allocated during a scope.
class ArenaScope {
 public:
  explicit ArenaScope(Arena& arena) : arena_(arena), mark_(arena.mark()) {}
  ~ArenaScope() { arena_.release(mark_); }
  ArenaScope(const ArenaScope&) = delete;
  ArenaScope& operator=(const ArenaScope&) = delete;

 private:
  Arena& arena_;
  Arena::Mark mark_;
};

}  // namespace whit
