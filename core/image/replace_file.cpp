#include "core/image/replace_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace whit {
namespace {

/// A file descriptor, and the first thing that went wrong with it.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) { note(fd >= 0); }
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return fd_; }
  int error() const { return error_; }
  bool good() const { return error_ == 0; }
  void note(bool success) {
    if (!success && error_ == 0) error_ = errno;
  }

  /// Makes this text all that the file holds.
  void write(const std::string& text) {
    for (size_t done = 0; good() && done < text.size();) {
      const ssize_t wrote = ::pwrite(fd_, text.data() + done, text.size() - done, static_cast<off_t>(done));
      if (wrote > 0) done += static_cast<size_t>(wrote);
      if (wrote < 0 && errno != EINTR) note(false);
    }
    if (good()) note(::ftruncate(fd_, static_cast<off_t>(text.size())) == 0);
    if (good()) note(::fsync(fd_) == 0 || errno == EINVAL);  // EINVAL: this file system cannot.
  }

 private:
  int fd_;
  int error_ = 0;
};

/// Writes over the bytes of a file: where a new file could not have all that belongs to the old one.
std::string overwrite(const std::string& path, const std::string& before, const std::string& text) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  // The room first, so that a full disk stops this before anything is lost.
  if (file.good() && text.size() > before.size()) {
    const int failed = ::posix_fallocate(file.get(), 0, static_cast<off_t>(text.size()));
    if (failed != 0) {
      file.note(::ftruncate(file.get(), static_cast<off_t>(before.size())) == 0);
      return std::strerror(failed);
    }
  }
  if (file.good()) file.write(text);
  if (file.good()) return {};
  const std::string problem = std::strerror(file.error());
  if (file.get() >= 0) Descriptor(::open(path.c_str(), O_WRONLY | O_CLOEXEC)).write(before);
  return problem;
}

/// What a new file would not have: other names, or a list of who may use it.
bool has_more(const std::string& path, const struct stat& status) {
  return status.st_nlink > 1 || ::getxattr(path.c_str(), "system.posix_acl_access", nullptr, 0) > 0;
}

/// Puts a new file in the place of an old one, by renaming. False when the new one cannot be made, or not be given to
/// the old one's owner.
bool put_in_place(const std::string& path, const struct stat& status, const std::string& text, std::string& problem) {
  std::string temporary = path + ".XXXXXX";
  Descriptor file(::mkostemp(temporary.data(), O_CLOEXEC));
  if (!file.good()) return false;
  struct stat made = {};
  const bool mine =
      ::fstat(file.get(), &made) == 0 && ((made.st_uid == status.st_uid && made.st_gid == status.st_gid) ||
                                          ::fchown(file.get(), status.st_uid, status.st_gid) == 0);
  if (mine) {
    file.write(text);
    if (file.good()) file.note(::fchmod(file.get(), status.st_mode & 07777) == 0);
    if (file.good()) file.note(::rename(temporary.c_str(), path.c_str()) == 0);
    if (!file.good()) problem = std::strerror(file.error());
  }
  if (!mine || !file.good()) ::unlink(temporary.c_str());
  return mine;
}

}  // namespace

std::string replace_file(const std::string& path, const std::string& text) {
  std::error_code failed;
  const std::string target = std::filesystem::canonical(path, failed).string();
  if (failed) return failed.message();
  struct stat status = {};
  if (::stat(target.c_str(), &status) != 0) return std::strerror(errno);
  if (!S_ISREG(status.st_mode)) return "it is not a regular file";
  std::ifstream old(target, std::ios::binary);
  const std::string before{std::istreambuf_iterator<char>(old), {}};
  if (!old) return "it cannot be read";
  if (before == text) return {};
  if ((status.st_mode & 0222) == 0 || ::access(target.c_str(), W_OK) != 0) return "it is write-protected";
  std::string problem;
  if (!has_more(target, status) && put_in_place(target, status, text, problem)) return problem;
  return overwrite(target, before, text);
}

bool holds_text(const std::string& path, std::string_view text) {
  std::ifstream in(path, std::ios::binary);
  return in.is_open() && std::string{std::istreambuf_iterator<char>(in), {}} == text;
}

}  // namespace whit
