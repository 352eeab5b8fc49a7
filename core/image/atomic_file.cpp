#include "core/image/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>

namespace whit {
namespace {

namespace fs = std::filesystem;

// "folder/picture.exr" -> "folder/.picture.<pid>.<n>.tmp.exr": hidden, same extension, unique in this process.
std::string temporary_name(const fs::path& target) {
  static std::atomic<unsigned> counter{0};
  const std::string name =
      fmt::format(".{}.{}.{}.tmp{}", target.stem().string(), ::getpid(), counter++, target.extension().string());
  return (target.parent_path() / name).string();
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path) : target_(path) {
  std::error_code ec;
  for (int i = 0; i < 40 && fs::is_symlink(target_, ec); ++i)  // as many as the kernel follows
    target_ = (fs::path(target_).parent_path() / fs::read_symlink(target_, ec)).string();
  if (fs::exists(target_, ec) && !fs::is_regular_file(target_, ec)) {
    failure_ = fs::is_directory(target_, ec) ? "it is a folder" : "it is not a regular file";
    return;
  }
  if (fs::exists(target_, ec) && ::access(target_.c_str(), W_OK) != 0) {
    fail(errno);
    return;
  }
  temporary_ = temporary_name(target_);
  fd_ = ::open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (fd_ < 0) {
    fail(errno);
    temporary_.clear();
  }
}

AtomicFile::~AtomicFile() {
  if (fd_ >= 0) ::close(fd_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::fail(int error_number) {
  if (failure_.empty()) failure_ = std::strerror(error_number);
}

size_t AtomicFile::write_at(const void* data, size_t size, int64_t offset) {
  const char* bytes = static_cast<const char*>(data);
  size_t done = 0;
  while (done < size && fd_ >= 0 && failure_.empty()) {
    const ssize_t n = ::pwrite(fd_, bytes + done, size - done, offset + static_cast<int64_t>(done));
    if (n > 0) done += static_cast<size_t>(n);
    if (n == 0) fail(ENOSPC);
    if (n < 0 && errno != EINTR) fail(errno);
  }
  size_ = std::max(size_, offset + static_cast<int64_t>(done));
  return done;
}

size_t AtomicFile::read_at(void* data, size_t size, int64_t offset) const {
  const ssize_t n = fd_ >= 0 ? ::pread(fd_, data, size, offset) : 0;
  return n > 0 ? static_cast<size_t>(n) : 0;
}

void AtomicFile::keep_permissions() {
  struct stat old = {};
  if (fd_ < 0 || ::stat(target_.c_str(), &old) != 0) return;
  // Only the superuser may give files away; the mode afterwards, which another owner would cost some of its bits.
  if (::fchown(fd_, old.st_uid, old.st_gid) != 0 && errno != EPERM) fail(errno);
  if (::fchmod(fd_, old.st_mode & 07777) != 0) fail(errno);
}

std::string AtomicFile::commit() {
  if (fd_ >= 0) {
    // EINVAL: the file system cannot flush a single file; close() still reports what it knows.
    if (failure_.empty() && ::fsync(fd_) != 0 && errno != EINVAL) fail(errno);
    if (::close(fd_) != 0) fail(errno);
    fd_ = -1;
  }
  if (failure_.empty() && ::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  if (failure_.empty()) temporary_.clear();
  return failure_;
}

}  // namespace whit
