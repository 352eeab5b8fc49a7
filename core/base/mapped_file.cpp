#include "core/base/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/base/limits.h"

namespace whit {

MappedFile::MappedFile(const std::string& path, size_t copied) : path_(path) {
  // Looked at before it is opened: to open some devices is to do something to them.
  struct stat status = {};
  const bool odd = ::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
  if (odd) {
    error_ = kNotRegular;
    return;
  }
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) {
    error_ = std::strerror(errno);
    return;
  }
  open(file, copied);
  ::close(file);
  if (!error_.empty()) data_ = nullptr;
}

void MappedFile::open(int file, size_t copied) {
  struct stat status = {};
  if (::fstat(file, &status) != 0) {
    error_ = std::strerror(errno);
  } else if (!S_ISREG(status.st_mode)) {
    error_ = S_ISDIR(status.st_mode) ? std::strerror(EISDIR) : kNotRegular;
  } else {
    state_ = state_of(status);
    size_ = static_cast<size_t>(status.st_size);
    // Where there is no room for another mapping, there is for a copy.
    if (size_ <= copied || !map(file)) copy(file);
  }
}

bool MappedFile::map(int file) {
  void* const pages = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file, 0);
  if (pages == MAP_FAILED) return false;
  mapped_.emplace(pages, size_);
  if (!mapped_->is_watched()) {
    mapped_.reset();
    ::munmap(pages, size_);
    return false;
  }
  data_ = static_cast<const char*>(pages);
  ::madvise(pages, size_, MADV_SEQUENTIAL);
  return true;
}

void MappedFile::copy(int file) {
  copy_.resize(size_);
  size_t done = 0;
  while (done < size_) {
    const ssize_t got = ::read(file, copy_.data() + done, size_ - done);
    if (got == 0) break;
    if (got < 0 && errno != EINTR) {
      error_ = std::strerror(errno);
      return;
    }
    done += static_cast<size_t>(std::max<ssize_t>(got, 0));
  }
  struct stat status = {};
  if (done < size_ || ::fstat(file, &status) != 0 || state_of(status) != state_) error_ = kChangedWhileRead;
  data_ = copy_.data();
}

MappedFile::~MappedFile() {
  if (!mapped_) return;
  mapped_.reset();  // Before others can be given these addresses.
  ::munmap(const_cast<char*>(data_), size_);
}

std::string MappedFile::problem() const {
  if (!error_.empty() || !mapped_) return error_;
  const FileState now = file_state(path_);
  const bool same_file = now.device == state_.device && now.inode == state_.inode;
  if (same_file && now != state_) return kChangedWhileRead;
  if (!mapped_->any()) return {};
  // What has another name by now may have been shortened under that.
  return same_file ? "a part of it cannot be read: its disk or the network failed" : kChangedWhileRead;
}

void MappedFile::release(uint64_t begin, uint64_t end) const {
  if (!mapped_) return;
  const auto page = static_cast<uint64_t>(::sysconf(_SC_PAGESIZE));
  const uint64_t first = begin / page * page, last = std::min<uint64_t>(end, size_) / page * page;
  if (first < last) ::madvise(const_cast<char*>(data_) + first, last - first, MADV_DONTNEED);
}

}  // namespace whit
