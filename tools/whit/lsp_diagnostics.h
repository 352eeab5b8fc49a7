// Diagnostics in the background: what is wrong with a scene as it is typed, and when nobody types, all that `whit check`
// finds.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "core/author/diagnose.h"

namespace whit::lsp {

/// The texts of a moment.
struct Snapshot {
  std::vector<author::OpenText> texts;
  std::map<std::string, int64_t> versions;  ///< By path.
};

/// Diagnoses scenes, the latest text of each, on two threads: reading what a render would read can take long, and what is
/// typed meanwhile shall not wait for it.
class DiagnosticsWorker {
 public:
  using Done = std::function<void(const std::string& main, const author::Findings&, const Snapshot&)>;
  explicit DiagnosticsWorker(Done done);
  ~DiagnosticsWorker();
  DiagnosticsWorker(const DiagnosticsWorker&) = delete;
  DiagnosticsWorker& operator=(const DiagnosticsWorker&) = delete;

  /// A scene has changed. All that `whit check` finds is looked for after a while without another change, or at once.
  void diagnose(const std::string& main, const Snapshot& snapshot, author::Encoding encoding, bool at_once);
  /// Nobody wants to know of a scene any more.
  void forget(const std::string& main);

 private:
  using Clock = std::chrono::steady_clock;
  struct Scene {
    Snapshot snapshot;
    author::Encoding encoding = author::Encoding::Utf16;
    uint64_t generation = 0, quick_done = 0;  ///< The latter of which the quick answer has been given.
    bool quick_wanted = false, thorough_wanted = false;
    Clock::time_point thorough_at;
  };
  void run(bool thorough);
  std::string next(std::unique_lock<std::mutex>& lock, bool thorough);
  bool is_current(const std::string& main, uint64_t generation);

  Done done_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, Scene> scenes_;
  uint64_t generation_ = 0;
  bool stop_ = false;
  std::thread quick_, thorough_;
};

}  // namespace whit::lsp
