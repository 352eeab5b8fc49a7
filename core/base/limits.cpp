#include "core/base/limits.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <limits>

#include "core/base/mapped_file.h"

namespace whit {

std::string more_bytes_than(const Limit& limit) {
  std::string text = "it has more than ";
  return text.append(std::to_string(limit.most)).append(" bytes, the limit ").append(limit.name);
}

std::string why_unreadable(const std::string& path) {
  // A pipe would be opened all the same, and whoever writes to it would see that it has a reader.
  struct stat status = {};
  if (::stat(path.c_str(), &status) != 0) return std::strerror(errno);
  if (S_ISDIR(status.st_mode)) return std::strerror(EISDIR);
  if (!S_ISREG(status.st_mode)) return kNotRegular;
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return std::strerror(errno);
  ::close(file);
  return {};
}

std::optional<std::string> read_file(const std::string& path, const Limit& limit, std::string& problem) {
  // Mapped, its size is known before anything of it takes memory.
  const MappedFile file(path);
  problem = file.error();
  if (problem.empty() && file.bytes().size() > limit.most) problem = more_bytes_than(limit);
  if (!problem.empty()) return std::nullopt;
  std::string text(file.bytes());
  problem = file.problem();
  if (!problem.empty()) return std::nullopt;
  return text;
}

}  // namespace whit
