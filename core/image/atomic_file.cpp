#include "core/image/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <string_view>
#include <utility>

namespace whit {
namespace {

namespace fs = std::filesystem;

/// The folder of a path, so that something can be opened in it.
fs::path folder_of(const fs::path& target) { return target.has_parent_path() ? target.parent_path() : fs::path("."); }

/// What the hidden files of a target begin and end with: ".picture." and ".tmp.exr". Names have an end, 255 bytes in most
/// file systems: of long ones there is as much as leaves room for numbers in between.
std::pair<std::string, std::string> ends_of_temporary(const fs::path& target) {
  constexpr size_t kNumbers = 32;
  const std::string extension = target.extension().string(), stem = target.stem().string();
  std::string last = fmt::format(".tmp{}", extension.substr(0, NAME_MAX / 4));
  std::string first = fmt::format(".{}.", stem.substr(0, NAME_MAX - kNumbers - last.size()));
  return {std::move(first), std::move(last)};
}

/// "folder/picture.exr" -> "folder/.picture.<pid>.<n>.tmp.exr": hidden, same extension, unique in this process.
std::string temporary_name(const fs::path& target) {
  static std::atomic<unsigned> counter{0};
  const auto [first, last] = ends_of_temporary(target);
  return (target.parent_path() / fmt::format("{}{}.{}{}", first, ::getpid(), counter++, last)).string();
}

/// "<pid>.<n>".
bool is_two_numbers(std::string_view text) {
  const size_t dot = text.find('.');
  const auto is_number = [](std::string_view t) {
    return !t.empty() && t.find_first_not_of("0123456789") == std::string_view::npos;
  };
  return dot != std::string_view::npos && is_number(text.substr(0, dot)) && is_number(text.substr(dot + 1));
}

/// Removes a hidden file that nobody holds: its writer, who may be on another machine, keeps it locked. One so young may
/// belong to somebody who has not come to lock it.
void remove_if_left(const std::string& path) {
  constexpr time_t kYoung = 10;
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  struct stat status = {};
  const bool is_old =
      fd >= 0 && ::fstat(fd, &status) == 0 && S_ISREG(status.st_mode) && ::time(nullptr) - status.st_mtime > kYoung;
  if (is_old && ::flock(fd, LOCK_EX | LOCK_NB) == 0) ::unlink(path.c_str());
  if (fd >= 0) ::close(fd);
}

/// The hidden files that killed processes left of a target.
void remove_left_over(const fs::path& target) {
  const auto [first, last] = ends_of_temporary(target);
  std::error_code failed;
  for (fs::directory_iterator at(folder_of(target), failed), end; !failed && at != end; at.increment(failed)) {
    const std::string name = at->path().filename().string();
    if (name.size() <= first.size() + last.size() || !name.starts_with(first) || !name.ends_with(last)) continue;
    const std::string_view numbers(name.data() + first.size(), name.size() - first.size() - last.size());
    if (is_two_numbers(numbers)) remove_if_left(at->path().string());
  }
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
  if (fs::path(target_).filename().string().size() > NAME_MAX) {
    fail(ENAMETOOLONG);
    return;
  }
  fd_ = ::open(folder_of(target_).c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
  if (fd_ < 0) open_temporary();
  // So that nobody takes it for one that was left. Where there are no locks, what is left is not removed.
  if (fd_ >= 0) ::flock(fd_, LOCK_EX | LOCK_NB);
}

/// Where the file system, or the kernel, has no files without a name.
void AtomicFile::open_temporary() {
  temporary_ = temporary_name(target_);
  fd_ = ::open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (fd_ >= 0) return;
  fail(errno);
  temporary_.clear();
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

/// A name cannot be given in the place of another: for a moment the file has a hidden one.
void AtomicFile::give_name() {
  temporary_ = temporary_name(target_);
  const std::string open_file = fmt::format("/proc/self/fd/{}", fd_);
  if (::linkat(AT_FDCWD, open_file.c_str(), AT_FDCWD, temporary_.c_str(), AT_SYMLINK_FOLLOW) == 0) return;
  fail(errno);
  temporary_.clear();
}

std::string AtomicFile::commit() {
  // Keeps the lock until the file has its name: what closing says must be known before.
  const int held = fd_ >= 0 ? ::fcntl(fd_, F_DUPFD_CLOEXEC, 0) : -1;
  if (fd_ >= 0) {
    // EINVAL: the file system cannot flush a single file; close() still reports what it knows.
    if (failure_.empty() && ::fsync(fd_) != 0 && errno != EINVAL) fail(errno);
    if (failure_.empty() && temporary_.empty()) give_name();
    if (::close(fd_) != 0) fail(errno);
    fd_ = -1;
  }
  if (failure_.empty() && ::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  if (failure_.empty()) temporary_.clear(), remove_left_over(target_);
  if (held >= 0) ::close(held);
  return failure_;
}

}  // namespace whit
