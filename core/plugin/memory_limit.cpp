#include "core/plugin/memory_limit.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <string_view>

namespace whit {
namespace {

constexpr uint64_t kNone = std::numeric_limits<uint64_t>::max();

/// A number in a file of its own; kNone where there is none, as in "max".
uint64_t number_in(const std::string& path) {
  std::ifstream file(path);
  std::string text;
  uint64_t number = 0;
  if (!(file >> text) || std::from_chars(text.data(), text.data() + text.size(), number).ec != std::errc())
    return kNone;
  return number;
}

/// The least limit of a cgroup and of those that it is in. A container may show its own as the root of all, so that the
/// path is of no folder there.
uint64_t least_on_the_way(const std::string& root, std::string path, const char* file) {
  uint64_t least = number_in(fmt::format("{}/{}", root, file));
  while (path.size() > 1) {
    least = std::min(least, number_in(fmt::format("{}{}/{}", root, path, file)));
    path.resize(path.rfind('/'));
  }
  return least;
}

/// Whether a list of controllers, with commas between them, has that of memory.
bool names_memory(std::string_view controllers) {
  while (true) {
    const size_t comma = controllers.find(',');
    if (controllers.substr(0, comma) == "memory") return true;
    if (comma == controllers.npos) return false;
    controllers.remove_prefix(comma + 1);
  }
}

std::atomic<uint64_t>& limit() {
  static std::atomic<uint64_t> bytes{memory_of_machine() / 10 * 9};
  return bytes;
}

/// A line of /proc/self/status, in bytes; 0 where there is none.
uint64_t status_bytes(std::string_view key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind(key, 0) == 0) return std::stoull(line.substr(key.size())) * 1024;
  }
  return 0;
}

}  // namespace

// Lines are "4:memory:/some/path", or "0::/some/path" of version 2.
uint64_t cgroup_memory_limit(const std::string& cgroups, const std::string& root) {
  uint64_t least = kNone;
  std::istringstream lines(cgroups);
  for (std::string line; std::getline(lines, line);) {
    const size_t first = line.find(':'), second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1), path = line.substr(second + 1);
    if (controllers.empty()) least = std::min(least, least_on_the_way(root, path, "memory.max"));
    if (names_memory(controllers))
      least = std::min(least, least_on_the_way(fmt::format("{}/memory", root), path, "memory.limit_in_bytes"));
  }
  return least;
}

uint64_t memory_of_machine() {
  const uint64_t all = static_cast<uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
  std::ifstream file("/proc/self/cgroup");
  const std::string cgroups{std::istreambuf_iterator<char>(file), {}};
  return std::min(all, cgroup_memory_limit(cgroups, "/sys/fs/cgroup"));
}

uint64_t memory_limit() { return limit(); }
void set_memory_limit(uint64_t bytes) { limit() = bytes; }

uint64_t resident_memory() { return status_bytes("VmRSS:"); }

uint64_t peak_memory() {
  // Not getrusage() where this exists: that begins with what the parent had when it started the program.
  if (const uint64_t peak = status_bytes("VmHWM:"); peak > 0) return peak;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}

void need_memory(uint64_t bytes, const std::string& what) {
  constexpr uint64_t kFew = uint64_t{32} << 20;
  if (bytes < kFew) return;
  const uint64_t most = memory_limit(), has = resident_memory();
  if (has < most && bytes <= most - has) return;
  const auto text = [](uint64_t n) { return bytes_text(static_cast<double>(n)); };
  throw OutOfMemory(fmt::format("{} takes {} of memory; of {} at most (--max-memory) {} are taken", what, text(bytes),
                                text(most), text(has)));
}

Diagnostic limit_error(SourcePos where, std::string message, std::string remedy) {
  Diagnostic d{Severity::Error, ErrorClass::File, where, std::move(message), std::move(remedy)};
  d.name = kLimitHit;
  return d;
}

std::string bytes_text(double bytes) {
  constexpr double kMiB = 1024 * 1024, kGiB = 1024 * kMiB;
  if (bytes < kMiB) return fmt::format("{:.0f} KiB", bytes / 1024);
  if (bytes < 10 * kGiB) return fmt::format("{:.0f} MiB", bytes / kMiB);
  return fmt::format("{:.1f} GiB", bytes / kGiB);
}

}  // namespace whit
