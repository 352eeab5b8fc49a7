#include "core/base/lost_pages.h"

#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <mutex>

namespace whit {
namespace {

/// A mapping. A fault can only be in one that stays as it is meanwhile, since it is being read: one of which the version
/// is odd or changes while the handler looks is another.
struct Range {
  std::atomic<uint32_t> version{0};
  std::atomic<uintptr_t> begin{0}, end{0};  ///< Both 0: free.
  std::atomic<bool> lost{false};
};

std::array<Range, LostPages::kMost> ranges;
std::mutex ranges_mutex;  ///< Held by who changes them; the handler does not ask for it.
/// How many of them were ever in use: the handler need not look further.
std::atomic<size_t> ranges_used{0};
struct sigaction before_ours;

static_assert(std::atomic<uintptr_t>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

void change(Range& range, uintptr_t begin, uintptr_t end) {
  range.version.fetch_add(1);
  range.begin.store(begin);
  range.end.store(end);
  range.lost.store(false);
  range.version.fetch_add(1);
}

/// Puts zeros in the place of the page of `address` and of what is behind it. False when that is in no range.
bool replace_lost(uintptr_t address) {
  for (size_t i = 0; i < ranges_used.load(); ++i) {
    Range& range = ranges[i];
    const uint32_t version = range.version.load();
    const uintptr_t begin = range.begin.load(), end = range.end.load();
    if (version % 2 != 0 || range.version.load() != version || address < begin || address >= end) continue;
    const auto page = static_cast<uintptr_t>(::sysconf(_SC_PAGESIZE));
    const uintptr_t from = address / page * page, to = (end + page - 1) / page * page;
    range.lost.store(true);
    // By its number: mmap() itself is not promised to be safe in a handler, and sanitizers put their own in its place.
    const long done = ::syscall(SYS_mmap, from, to - from, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0);
    return static_cast<uintptr_t>(done) == from;
  }
  return false;
}

void pass_on(int signal, siginfo_t* info, void* context) {
  if ((before_ours.sa_flags & SA_SIGINFO) != 0) return before_ours.sa_sigaction(signal, info, context);
  if (before_ours.sa_handler != SIG_DFL && before_ours.sa_handler != SIG_IGN) return before_ours.sa_handler(signal);
  // The read that failed is tried again behind the handler, and then ends the program; a signal that somebody sent
  // does so when it is sent again.
  ::sigaction(signal, &before_ours, nullptr);
  if (info->si_code <= 0) ::raise(signal);
}

void handle(int signal, siginfo_t* info, void* context) {
  const int error = errno;
  const bool ours = info->si_code > 0 && replace_lost(reinterpret_cast<uintptr_t>(info->si_addr));
  if (!ours) pass_on(signal, info, context);
  errno = error;
}

void install() {
  struct sigaction ours = {};
  ours.sa_sigaction = handle;
  // Another thread's handler may run at the same time, and so may the one before ours, which wants what it asked for.
  ours.sa_flags = SA_SIGINFO | SA_ONSTACK;
  ::sigemptyset(&ours.sa_mask);
  ::sigaction(SIGBUS, &ours, &before_ours);
}

}  // namespace

LostPages::LostPages(const void* begin, size_t bytes) {
  static std::once_flag installed;
  std::call_once(installed, install);
  const std::lock_guard<std::mutex> lock(ranges_mutex);
  slot_ = 0;
  while (slot_ < kMost && ranges[slot_].begin != 0) ++slot_;
  if (slot_ == kMost) return;
  const auto address = reinterpret_cast<uintptr_t>(begin);
  change(ranges[slot_], address, address + bytes);
  if (ranges_used <= slot_) ranges_used = slot_ + 1;
}

LostPages::~LostPages() {
  if (!is_watched()) return;
  const std::lock_guard<std::mutex> lock(ranges_mutex);
  change(ranges[slot_], 0, 0);
}

bool LostPages::any() const { return is_watched() && ranges[slot_].lost; }

}  // namespace whit
