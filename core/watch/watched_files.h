// Says when files change on the disk: by inotify at once, by a look at them now and then where that says nothing.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "parser/source.h"

namespace whit {

/// What a scene includes and could not be opened, by what was said of it. `path` is the main file.
std::vector<std::string> missing_includes(const Sources& sources, const Diagnostics& said, const std::string& path);

/// Watches files; watch() and wake() may be called while another thread is in wait().
class FileWatch {
 public:
  struct Options {
    int quiet_ms = 20;   ///< Nothing has happened for so long when a change is told: editors do several things at once.
    int look_ms = 2000;  ///< Between looks, with inotify;
    int poll_ms = 300;   ///< and without.
    bool inotify = true;
  };

  FileWatch();
  explicit FileWatch(const Options& options);
  ~FileWatch();
  FileWatch(const FileWatch&) = delete;
  FileWatch& operator=(const FileWatch&) = delete;

  /// From now on these, which need not be there. `since` is when somebody began to read them (now_mark()): those that have
  /// changed since, and were not watched, count as changed.
  void watch(const std::vector<std::string>& files, long long since);
  static long long now_mark();

  /// Waits until some of them have changed, or for that long; then which have. Ends at once after wake().
  std::vector<std::string> wait(int milliseconds);
  void wake();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace whit
