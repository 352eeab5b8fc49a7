#include "core/batch/arena.h"

#include <algorithm>
#include <new>

namespace whit {

void* Arena::take_from_next_block(size_t bytes) {
  size_t next = blocks_.empty() ? 0 : current_ + 1;
  while (next < blocks_.size() && blocks_[next].size < bytes) ++next;
  if (next >= blocks_.size()) {
    const size_t size = std::max(block_size_, (bytes + kAlign - 1) & ~(kAlign - 1));
    Block block{std::unique_ptr<std::byte, Free>(static_cast<std::byte*>(std::aligned_alloc(kAlign, size))), size};
    if (!block.data) throw std::bad_alloc();
    blocks_.push_back(std::move(block));
    next = blocks_.size() - 1;
  }
  current_ = next;
  used_ = bytes;
  return blocks_[current_].data.get();
}

size_t Arena::capacity() const {
  size_t total = 0;
  for (const Block& b : blocks_) total += b.size;
  return total;
}

}  // namespace whit
