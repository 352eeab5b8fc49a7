// Memory for texels that goes back to the system when it is not wanted any more.
#pragma once

#include <cstddef>

namespace whit {

/// A piece of memory: pages of its own, so that a texture that is dropped gives back all it took, and at once (in the heap
/// its place would remain, in pieces that fit nothing); or a part of a file that stands for memory.
class TexelBlock {
 public:
  /// Not filled with anything: a page that nobody has written to takes no memory. A few bytes more may be read.
  explicit TexelBlock(size_t bytes);

  /// A part of an open file, to be read, or also to be written to. Throws std::bad_alloc when it cannot be.
  TexelBlock(int file, size_t at, size_t bytes, bool writable = false);

  ~TexelBlock();
  TexelBlock(const TexelBlock&) = delete;
  TexelBlock& operator=(const TexelBlock&) = delete;

  template <class T>
  T* as(size_t at = 0) const {
    return reinterpret_cast<T*>(static_cast<std::byte*>(memory_) + at);
  }
  size_t size() const { return bytes_; }

  /// Of a part of a file: gives the memory back. It comes again when it is read, also while it is.
  void give_back() const;

 private:
  bool in_heap() const { return !of_file_ && bytes_ < kLeastPages; }
  static constexpr size_t kLeastPages = size_t{1} << 16;  // what is smaller comes from the heap after all
  void* memory_ = nullptr;
  size_t bytes_;
  bool of_file_ = false;
};

}  // namespace whit
