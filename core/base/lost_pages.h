// Pages of mapped files that cannot be read any more, because the file was shortened or its disk failed. The system says
// so by the signal SIGBUS, which ends the program unless somebody takes it: here they become zeros, and whoever reads
// the file is told when he asks.
#pragma once

#include <cstddef>

namespace whit {

/// Watches a mapping of a file for as long as this lives. Where a page of it cannot be read, that page and all behind it
/// are replaced by zeros, and any() is true from then on. The first of these installs a handler of SIGBUS for the whole
/// process, which passes on what is none of ours to the handler that was there before it.
class LostPages {
 public:
  /// How many mappings can be watched at a time.
  static constexpr size_t kMost = 4096;

  /// Watches `bytes` bytes from `begin`, which begins a page. Check is_watched(): there may be too many already.
  LostPages(const void* begin, size_t bytes);
  ~LostPages();
  LostPages(const LostPages&) = delete;
  LostPages& operator=(const LostPages&) = delete;

  bool is_watched() const { return slot_ < kMost; }

  /// Whether there were such pages.
  bool any() const;

 private:
  size_t slot_ = kMost;
};

}  // namespace whit
