// A file that holds texels that memory has no room for: reading them again takes a hundredth of decoding them again.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "core/image/texel_block.h"

namespace whit {

/// Without a name, in $TMPDIR or /var/tmp; it comes to be when it is first written to and is gone when the process is.
/// Thread-safe.
class ScratchFile {
 public:
  /// The room that a piece takes: the next one begins behind it.
  static constexpr size_t room_for(size_t bytes) { return (bytes + kAlign - 1) / kAlign * kAlign; }

  ScratchFile() = default;
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// The pieces one after another, written and mapped; null when there is no folder or no room for them.
  std::shared_ptr<const TexelBlock> write(const std::vector<std::span<const std::byte>>& pieces);

  /// So many bytes to be written to, mapped, which the file has room for: pages go to the disk when memory is short. Null as
  /// above.
  std::shared_ptr<const TexelBlock> room(size_t bytes);

 private:
  static constexpr size_t kAlign = 64;
  bool reserve(size_t bytes, size_t& at);

  std::mutex mutex_;
  int file_ = -1;
  bool failed_ = false;
  size_t end_ = 0;
};

}  // namespace whit
