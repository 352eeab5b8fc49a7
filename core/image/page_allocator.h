// Memory for texels: pages of their own, so that a texture that is dropped gives back all it took, to the system and
// at once. In the heap its place would remain, in pieces that fit nothing.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <utility>

namespace whit {

/// An allocator for std::vector. What is smaller than a few pages comes from the heap after all.
template <class T>
struct PageAllocator {
  using value_type = T;
  static constexpr size_t kLeast = size_t{1} << 16;

  PageAllocator() = default;
  template <class U>
  PageAllocator(const PageAllocator<U>&) {}

  T* allocate(size_t n) {
    if (n * sizeof(T) < kLeast) return static_cast<T*>(::operator new(n * sizeof(T)));
    void* pages = mmap(nullptr, n * sizeof(T), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages == MAP_FAILED) throw std::bad_alloc();
    return static_cast<T*>(pages);
  }
  void deallocate(T* p, size_t n) {
    if (n * sizeof(T) < kLeast) ::operator delete(p);
    else munmap(p, n * sizeof(T));
  }

  /// Numbers of a vector that grows begin as they are, since all are written before they are read: a page that nobody has
  /// written to takes no memory.
  template <class U>
  void construct(U*) {}
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
  }

  bool operator==(const PageAllocator&) const { return true; }
};

}  // namespace whit
