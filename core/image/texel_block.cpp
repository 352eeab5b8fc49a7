#include "core/image/texel_block.h"

#include <sys/mman.h>

#include <new>

namespace whit {
namespace {

constexpr size_t kReadOn = 8;

void* mapped(size_t bytes, int protection, int flags, int file, size_t at) {
  void* const pages = mmap(nullptr, bytes + kReadOn, protection, flags, file, static_cast<off_t>(at));
  if (pages == MAP_FAILED) throw std::bad_alloc();
  return pages;
}

}  // namespace

TexelBlock::TexelBlock(size_t bytes) : bytes_(bytes) {
  memory_ = in_heap() ? ::operator new(bytes + kReadOn)
                      : mapped(bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
}

TexelBlock::TexelBlock(int file, size_t at, size_t bytes, bool writable)
    : memory_(mapped(bytes, writable ? PROT_READ | PROT_WRITE : PROT_READ, MAP_SHARED, file, at)),
      bytes_(bytes),
      of_file_(true) {}

TexelBlock::~TexelBlock() {
  if (in_heap()) ::operator delete(memory_);
  else munmap(memory_, bytes_ + kReadOn);
}

void TexelBlock::give_back() const { madvise(memory_, bytes_ + kReadOn, MADV_DONTNEED); }

}  // namespace whit
