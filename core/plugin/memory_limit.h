// How much memory there is, how much of it the process may have, and what is said where that is not enough.
#pragma once

#include <cstdint>
#include <new>
#include <string>
#include <utility>

#include "core/base/diagnostics.h"

namespace whit {

/// Bytes that the system lets the process have before it ends it: all of the machine, or fewer where a cgroup (version 1
/// or 2), or one that it is in, has fewer. What others have taken meanwhile does not count.
uint64_t memory_of_machine();

/// The least of the limits of a process's cgroups, with those that they are in. `cgroups` is the text of
/// /proc/PID/cgroup, `root` the folder that cgroups are mounted at. UINT64_MAX when there is none.
uint64_t cgroup_memory_limit(const std::string& cgroups, const std::string& root);

/// The most bytes that the process is to have: 90 % of memory_of_machine() unless set. Thread-safe.
uint64_t memory_limit();
void set_memory_limit(uint64_t bytes);

/// Bytes of the process in memory, now and at most so far (VmRSS and VmHWM of /proc/self/status).
uint64_t resident_memory();
uint64_t peak_memory();

/// Memory that there is not, with what wants how much of it. An std::bad_alloc with words.
class OutOfMemory : public std::bad_alloc {
 public:
  explicit OutOfMemory(std::string what) : what_(std::move(what)) {}
  const char* what() const noexcept override { return what_.c_str(); }

 private:
  std::string what_;
};

/// Throws OutOfMemory where `bytes` more than the process has would be more than memory_limit(): to be called before they
/// are taken. `what` is the subject of the message: "decoding all of it". Costs nothing where they are few.
void need_memory(uint64_t bytes, const std::string& what);

/// What a diagnostic is called (Diagnostic::name) that says that a limit was hit: programs that end with it say so by
/// their exit code, and not that a file or the scene is wrong.
inline constexpr const char* kLimitHit = "limit";

/// An error of that name at a place.
Diagnostic limit_error(SourcePos where, std::string message, std::string remedy = {});

/// "320 MiB", as messages have sizes.
std::string bytes_text(double bytes);

}  // namespace whit
