#include "core/watch/watched_files.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>

#include "core/base/file_state.h"
#include "parser/include.h"
#include "parser/lexer.h"

namespace whit {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

}  // namespace

std::vector<std::string> missing_includes(const Sources& sources, const Diagnostics& said, const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  std::vector<std::string> files;
  for (const Diagnostic& d : said.all()) {
    if (d.error_class != ErrorClass::File || !d.where.known()) continue;
    const std::string_view text = sources.text(d.where.file);
    if (d.where.offset >= text.size()) continue;
    Diagnostics ignored;
    Reporter reporter(ignored);
    Lexer lexer(text.substr(d.where.offset), d.where.file, reporter);
    if (lexer.peek().kind != TokenKind::String) lexer.next();
    if (lexer.peek().kind == TokenKind::String) files.push_back(join_path(folder, lexer.unquote(lexer.next())));
  }
  return files;
}

struct FileWatch::Impl {
  explicit Impl(const Options& asked) : options(asked) {
    wake_fd = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (options.inotify) notify_fd = ::inotify_init1(IN_CLOEXEC | IN_NONBLOCK);
  }
  ~Impl() {
    if (wake_fd >= 0) ::close(wake_fd);
    if (notify_fd >= 0) ::close(notify_fd);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  /// The folder of a file, and of what it is a link to. Nobody has to be told of a folder twice: the number is the same.
  void add_folders(const std::string& path) {
    std::error_code ignored;
    for (const fs::path& file : {fs::path(path), fs::weakly_canonical(path, ignored)}) {
      const std::string folder = file.has_parent_path() ? file.parent_path().string() : ".";
      if (notify_fd < 0 || !folders.insert(folder).second) continue;
      if (::inotify_add_watch(notify_fd, folder.c_str(),
                              IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_CREATE | IN_DELETE) < 0)
        folders.erase(folder);  // Looks will find what happens there; once it is there, so will this.
    }
  }

  /// True when something may have happened within the time; false after it, or when woken.
  bool wait_for_event(int milliseconds) {
    std::array<pollfd, 2> fds{pollfd{wake_fd, POLLIN, 0}, pollfd{notify_fd, POLLIN, 0}};
    const int n = ::poll(fds.data(), notify_fd >= 0 ? 2 : 1, milliseconds);
    if (n <= 0) return false;
    if ((fds[0].revents & POLLIN) != 0) {
      uint64_t count = 0;
      woken = ::read(wake_fd, &count, sizeof count) > 0 || woken;
    }
    if (notify_fd < 0 || (fds[1].revents & POLLIN) == 0) return false;
    alignas(inotify_event) std::array<char, 1 << 14> events;
    while (::read(notify_fd, events.data(), events.size()) > 0) {}
    return true;
  }

  /// Which files are not what they were. From now on they are.
  std::vector<std::string> changed() {
    const std::lock_guard lock(mutex);
    std::vector<std::string> names;
    for (auto& [path, mark] : marks) {
      const FileState now = file_state(path);
      if (now == mark) continue;
      mark = now;
      names.push_back(path);
    }
    return names;
  }

  const Options options;
  int wake_fd = -1, notify_fd = -1;
  bool woken = false;
  std::mutex mutex;
  std::map<std::string, FileState> marks;  ///< By path.
  std::set<std::string> folders;           ///< That inotify watches.
};

FileWatch::FileWatch() : FileWatch(Options{}) {}
FileWatch::FileWatch(const Options& options) : impl_(std::make_unique<Impl>(options)) {}
FileWatch::~FileWatch() = default;

namespace {

long long read_clock(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

/// Newer kernels give some files finer times than that of the last tick.
long long exact_now() { return read_clock(CLOCK_REALTIME); }

}  // namespace

// As coarse as the marks of most files, which take the time of the last tick.
long long FileWatch::now_mark() { return read_clock(CLOCK_REALTIME_COARSE); }

void FileWatch::watch(const std::vector<std::string>& files, long long since) {
  const std::lock_guard lock(impl_->mutex);
  std::map<std::string, FileState> marks;
  for (const std::string& path : files) {
    impl_->add_folders(path);
    const auto known = impl_->marks.find(path);
    if (known != impl_->marks.end()) {
      marks.insert(*known);
      continue;
    }
    const FileState now = file_state(path);
    const bool fresh =
        now.exists() && now.nanoseconds_since_1970() > since && now.nanoseconds_since_1970() <= exact_now();
    marks.emplace(path, fresh ? FileState{} : now);
  }
  impl_->marks = std::move(marks);
}

std::vector<std::string> FileWatch::wait(int milliseconds) {
  const auto end = Clock::now() + std::chrono::milliseconds(milliseconds);
  const int look = impl_->notify_fd >= 0 ? impl_->options.look_ms : impl_->options.poll_ms;
  for (;;) {
    std::vector<std::string> names = impl_->changed();
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    if (!names.empty()) return names;
    if (left <= 0 || impl_->woken) break;
    if (!impl_->wait_for_event(static_cast<int>(std::min<long long>(left, look)))) continue;
    // Until it is quiet, but not for ever: something else may be written there all the time.
    const auto longest = Clock::now() + std::chrono::milliseconds(10 * impl_->options.quiet_ms);
    while (impl_->wait_for_event(impl_->options.quiet_ms) && Clock::now() < longest) {}
  }
  impl_->woken = false;
  return {};
}

void FileWatch::wake() {
  const uint64_t one = 1;
  [[maybe_unused]] const ssize_t n = ::write(impl_->wake_fd, &one, sizeof one);
}

}  // namespace whit
