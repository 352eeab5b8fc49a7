#include "core/plugin/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace whit {

MappedFile::MappedFile(const std::string& path) {
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat info {};
  if (fd < 0 || fstat(fd, &info) != 0) {
    error_ = std::strerror(errno);
  } else if (S_ISDIR(info.st_mode)) {
    error_ = std::strerror(EISDIR);
  } else if (!S_ISREG(info.st_mode)) {
    error_ = "it is not a regular file";
  } else if (info.st_size > 0) {
    size_ = static_cast<size_t>(info.st_size);
    void* data = mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, fd, 0);
    if (data == MAP_FAILED) error_ = std::strerror(errno);
    else data_ = static_cast<const char*>(data);
  }
  if (fd >= 0) close(fd);
  if (data_) madvise(const_cast<char*>(data_), size_, MADV_SEQUENTIAL);
}

MappedFile::~MappedFile() {
  if (data_) munmap(const_cast<char*>(data_), size_);
}

}  // namespace whit
