#include "core/image/scratch_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <new>
#include <string>

namespace whit {
namespace {

constexpr size_t kPage = 4096;

size_t round_up(size_t n, size_t to) { return (n + to - 1) / to * to; }

int open_nameless() {
  const char* const chosen = std::getenv("TMPDIR");
  const std::string folder = chosen && *chosen ? chosen : "/var/tmp";
  const int file = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0) return file;
  // Not all file systems have files without a name.
  std::string name = folder + "/whit-XXXXXX";
  const int named = mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) unlink(name.c_str());
  return named;
}

bool write_all(int file, std::span<const std::byte> bytes, size_t at) {
  while (!bytes.empty()) {
    const ssize_t n = pwrite(file, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (n <= 0) return false;
    bytes = bytes.subspan(static_cast<size_t>(n));
    at += static_cast<size_t>(n);
  }
  return true;
}

}  // namespace

ScratchFile::~ScratchFile() {
  if (file_ >= 0) close(file_);
}

bool ScratchFile::reserve(size_t bytes, size_t& at) {
  const std::lock_guard lock(mutex_);
  if (file_ < 0 && !failed_) file_ = open_nameless();
  failed_ = failed_ || file_ < 0;
  at = end_;
  // A page that lies behind the end of the file cannot be read on into.
  const size_t end = end_ + round_up(bytes + kAlign, kPage);
  failed_ = failed_ || ftruncate(file_, static_cast<off_t>(end)) != 0;
  if (!failed_) end_ = end;
  return !failed_;
}

std::shared_ptr<const TexelBlock> ScratchFile::write(const std::vector<std::span<const std::byte>>& pieces) {
  size_t bytes = 0, begin = 0;
  for (const auto& piece : pieces) bytes += room_for(piece.size());
  if (!reserve(bytes, begin)) return nullptr;
  size_t at = begin;
  for (const auto& piece : pieces) {
    if (!write_all(file_, piece, at)) {
      const std::lock_guard lock(mutex_);
      failed_ = true;
      return nullptr;
    }
    at += room_for(piece.size());
  }
  try {
    return std::make_shared<TexelBlock>(file_, begin, bytes);
  } catch (const std::bad_alloc&) { return nullptr; }
}

std::shared_ptr<const TexelBlock> ScratchFile::room(size_t bytes) {
  size_t begin = 0;
  if (!reserve(bytes, begin)) return nullptr;
  // Writing to a page that the disk has no block for would end the program. That of others still may have room.
  if (posix_fallocate(file_, static_cast<off_t>(begin), static_cast<off_t>(bytes)) != 0) return nullptr;
  try {
    return std::make_shared<TexelBlock>(file_, begin, bytes, true);
  } catch (const std::bad_alloc&) { return nullptr; }
}

}  // namespace whit
