// A file that appears complete or not at all (for pictures: write.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace whit {

/// Writes to a file without a name in the folder of `path`, or, where the file system has no such files, to a hidden one;
/// commit() gives it the name, anything else leaves nothing behind. A process that is killed may leave a hidden file: the
/// next one that writes to that name removes it. The first failure is kept and makes commit() fail, so callers need not
/// check every write.
class AtomicFile {
 public:
  /// Creates the file. A symbolic link is followed: its target is replaced, not the link.
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Writes `size` bytes at byte `offset`; returns how many were written.
  size_t write_at(const void* data, size_t size, int64_t offset);

  /// Reads back bytes already written; returns how many.
  size_t read_at(void* data, size_t size, int64_t offset) const;

  /// The bytes written so far (the furthest end).
  int64_t size() const { return size_; }

  /// Gives the new file the mode of the one that it will replace, where there is one, and its owner where that is allowed.
  void keep_permissions();

  /// Flushes to the disk, closes and renames. Returns "" or the reason (errno's text).
  std::string commit();

  /// The first failure so far, "" when there was none.
  const std::string& failure() const { return failure_; }

 private:
  void open_temporary();
  void give_name();
  void fail(int error_number);

  std::string target_;
  std::string temporary_;  ///< "" where the file has no name.
  std::string failure_;
  int64_t size_ = 0;
  int fd_ = -1;
};

}  // namespace whit
