// A file's bytes, mapped into memory, and whether they have stayed what they were.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/file_state.h"
#include "core/base/lost_pages.h"

namespace whit {

/// The bytes of a regular file for as long as this lives. A small file is copied, a larger one is mapped read-only: what
/// others do to it meanwhile can then be seen in its bytes. Whoever uses bytes asks problem() afterwards, and makes
/// nothing of them where there is one. Shortening the file is no more than that: bytes that are gone read as 0.
///
/// Opening anything but a regular file says so, and does not wait for somebody to write to a pipe.
class MappedFile {
 public:
  /// Up to this size files are copied, which takes no longer than mapping them.
  static constexpr size_t kCopied = size_t{1} << 16;

  /// `copied`: up to which size the file is copied.
  explicit MappedFile(const std::string& path, size_t copied = kCopied);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  /// "", or why it cannot be read: "No such file or directory".
  const std::string& error() const { return error_; }

  /// error(), or what has happened to the bytes since: "it changed while it was read". Of what was copied nothing can.
  /// Thread-safe. A file that was replaced, by renaming another one, has not changed: the old one is still there.
  std::string problem() const;

  std::string_view bytes() const { return {data_, data_ ? size_ : 0}; }

  const std::string& path() const { return path_; }

  /// What the file was when it was opened.
  const FileState& state() const { return state_; }

  /// Gives the memory of bytes [begin, end) back to the system, which reads them again should anyone look.
  void release(uint64_t begin, uint64_t end) const;

 private:
  void open(int file, size_t copied);
  void copy(int file);
  bool map(int file);

  std::string path_;
  FileState state_;
  const char* data_ = nullptr;
  size_t size_ = 0;
  std::string copy_;
  std::optional<LostPages> mapped_;  ///< Where it is mapped and not copied.
  std::string error_;
};

/// What is said of a file that is no longer what it was when reading it began.
inline constexpr const char* kChangedWhileRead = "it changed while it was read";

}  // namespace whit
