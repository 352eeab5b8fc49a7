// What tells that a file has become another one.
#pragma once

#include <sys/stat.h>

#include <cstdint>
#include <string>

namespace whit {

/// Equal as long as a file has not been written to or replaced; of all that is not there, too.
struct FileState {
  int64_t size = -1;  ///< In bytes; -1 where there is no file.
  int64_t seconds = 0, nanoseconds = 0;
  uint64_t device = 0, inode = 0;
  bool operator==(const FileState&) const = default;
  bool exists() const { return size >= 0; }
  int64_t nanoseconds_since_1970() const { return seconds * 1'000'000'000 + nanoseconds; }
};

inline FileState state_of(const struct stat& status) {
  return {status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec, status.st_dev, status.st_ino};
}

inline FileState file_state(const std::string& path) {
  struct stat status = {};
  return ::stat(path.c_str(), &status) == 0 ? state_of(status) : FileState{};
}

}  // namespace whit
