// Much memory that is 0, without the work of making it so: pages come when they are first used, from the thread that
// uses them, and large ones where there are.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <utility>

namespace whit {

/// An array of n numbers that are 0.
template <class T>
class ZeroPages {
 public:
  ZeroPages() = default;
  explicit ZeroPages(size_t n) : bytes_(n * sizeof(T)) {
    if (n == 0) return;
    void* pages = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages == MAP_FAILED) throw std::bad_alloc();
    data_ = static_cast<T*>(pages);
    // A page of 2 MiB is as soon had as a few of 4 KiB; not for what would leave most of it empty.
    constexpr size_t kMuch = size_t{4} << 20;
    if (bytes_ >= kMuch) madvise(pages, bytes_, MADV_HUGEPAGE);
  }
  ZeroPages(ZeroPages&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}
  ZeroPages& operator=(ZeroPages&& other) noexcept {
    std::swap(data_, other.data_), std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~ZeroPages() {
    if (data_) munmap(data_, bytes_);
  }

  T* data() const { return data_; }
  size_t size() const { return bytes_ / sizeof(T); }

 private:
  T* data_ = nullptr;
  size_t bytes_ = 0;
};

}  // namespace whit
