// The decoded files of a scene's image textures: which levels of which are in memory, and which go when it is short.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "core/base/file_state.h"
#include "core/image/mipmap.h"
#include "core/image/picture_rows.h"
#include "core/image/scratch_file.h"
#include "core/image/texture_store.h"

namespace whit {

/// A file as some textures want it, those that differ only in their filter.
class TextureSource {
 public:
  TextureSource(TextureSpec spec, SourcePos where, const FileState& file)
      : spec_(std::move(spec)), where_(where), file_(file) {}

  /// n lookups, the finest of which needed that level.
  void note(int n, int level) {
    lookups_.fetch_add(n, std::memory_order_relaxed);
    int old = finest_.load(std::memory_order_relaxed);
    while (level < old && !finest_.compare_exchange_weak(old, level)) {}
  }

 private:
  friend class TextureMemory;
  static constexpr int kNone = std::numeric_limits<int>::max();

  const TextureSpec spec_;
  const SourcePos where_;  // of the first that asked for it
  const FileState file_;   // what the file has to stay, so that no picture shows two of its states

  std::mutex mutex_;  // held while decoding, so that it happens once; guards what follows, up to failed_
  std::unique_ptr<PictureRows> rows_;  // from a first look at the file until it is decoded
  MipMapOptions options_;
  std::shared_ptr<const MipMap> outline_, pyramid_;  // without any level; what there is
  std::string error_;
  bool failed_ = false, out_of_memory_ = false;
  size_t counted_ = 0;  // of a pyramid in the file, while it is in memory: so many bytes are accounted for

  std::atomic<bool> in_memory_{false};  // the pyramid has levels, and they are accounted for
  std::atomic<int> first_{kNone};       // the finest that it has
  std::atomic<int> finest_{kNone};      // the finest that lookups have needed
  std::atomic<int64_t> last_use_{-1};   // the memory's clock at the latest lookup
  std::atomic<int64_t> decodes_{0};
  alignas(64) std::atomic<int64_t> lookups_{0};
};

/// Thread-safe.
class TextureMemory {
 public:
  explicit TextureMemory(size_t limit);

  /// `file`: what it was when it was first named.
  TextureSource& add(const TextureSpec& spec, SourcePos where, const FileState& file);
  void set_limit(size_t bytes) { limit_ = bytes; }

  /// Any level, also none at all: lookups tell which one they need.
  static constexpr int kAnyLevel = TextureSource::kNone;

  /// The source's pyramid with the levels from `level` on, decoded if need be. Others who want it meanwhile wait; nobody
  /// else does, but for those who decode when memory is short. Null when the file cannot be decoded.
  std::shared_ptr<const MipMap> resident(TextureSource& source, int level);

  /// Reads all files and keeps nothing.
  void read_all();

  bool failed() const { return failed_.load(std::memory_order_relaxed); }
  TextureStatistics statistics() const;
  Diagnostics errors() const;

 private:
  struct Account;
  class Workspace;

  std::vector<TextureSource*> all() const;
  void open(TextureSource& source);
  void decode(TextureSource& source, int level);
  std::shared_ptr<const TexelBlock> room_in_file(const TextureSource& source, const PictureRows& rows, int first);
  std::shared_ptr<const MipMap> account(std::unique_ptr<const MipMap> map);
  void bring_back(TextureSource& source);
  bool make_room(size_t wanted, const TextureSource& wanting);
  void trim(TextureSource& source);
  void evict(TextureSource& source);
  void replace(TextureSource& source, std::shared_ptr<const MipMap> pyramid, bool in_memory);

  static constexpr int kSpareLevels = 1;  // decoded beyond what is asked for: the next ray may be a little nearer

  mutable std::mutex mutex_;  // guards the list, not the sources
  std::vector<std::unique_ptr<TextureSource>> sources_;
  std::shared_ptr<Account> account_;
  ScratchFile scratch_;
  std::atomic<size_t> limit_;
  std::atomic<bool> failed_{false};
  std::atomic<int64_t> trims_{0}, evictions_{0}, returns_{0}, decoded_bytes_{0}, decode_nanoseconds_{0};
  std::atomic<int64_t> clock_{0};  // counts changes of the texture in use
  std::mutex workspace_mutex_;     // guards workspaces_: how many threads are decoding
  std::condition_variable workspace_done_;
  int workspaces_ = 0;
};

}  // namespace whit
