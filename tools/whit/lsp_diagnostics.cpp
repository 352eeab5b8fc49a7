#include "tools/whit/lsp_diagnostics.h"

#include <exception>
#include <utility>

namespace whit::lsp {
namespace {

/// How long nobody types before files are read.
constexpr std::chrono::milliseconds kIdle{500};

}  // namespace

DiagnosticsWorker::DiagnosticsWorker(Done done)
    : done_(std::move(done)), quick_([this] { run(false); }), thorough_([this] { run(true); }) {}

DiagnosticsWorker::~DiagnosticsWorker() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
    scenes_.clear();
  }
  changed_.notify_all();
  quick_.join();
  thorough_.join();
}

void DiagnosticsWorker::diagnose(const std::string& main, const Snapshot& snapshot, author::Encoding encoding,
                                 bool at_once) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Scene& scene = scenes_[main];
    scene.snapshot = snapshot, scene.encoding = encoding, scene.generation = ++generation_;
    scene.quick_wanted = scene.thorough_wanted = true;
    scene.thorough_at = at_once ? Clock::now() : Clock::now() + kIdle;
  }
  changed_.notify_all();
}

void DiagnosticsWorker::forget(const std::string& main) {
  const std::lock_guard<std::mutex> lock(mutex_);
  scenes_.erase(main);
}

bool DiagnosticsWorker::is_current(const std::string& main, uint64_t generation) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = scenes_.find(main);
  return found != scenes_.end() && found->second.generation == generation;
}

/// Waits for a scene that is to be diagnosed; "" when there will be none any more. What is quick goes first.
std::string DiagnosticsWorker::next(std::unique_lock<std::mutex>& lock, bool thorough) {
  for (;;) {
    if (stop_) return {};
    Clock::time_point wake = Clock::time_point::max();
    for (auto& [main, scene] : scenes_) {
      if (!(thorough ? scene.thorough_wanted && scene.quick_done == scene.generation : scene.quick_wanted)) continue;
      if (!thorough || scene.thorough_at <= Clock::now()) return main;
      wake = std::min(wake, scene.thorough_at);
    }
    if (wake == Clock::time_point::max()) changed_.wait(lock);
    else changed_.wait_until(lock, wake);
  }
}

void DiagnosticsWorker::run(bool thorough) {
  std::unique_lock<std::mutex> lock(mutex_);
  for (std::string main = next(lock, thorough); !main.empty(); main = next(lock, thorough)) {
    Scene& scene = scenes_[main];
    (thorough ? scene.thorough_wanted : scene.quick_wanted) = false;
    const Snapshot snapshot = scene.snapshot;
    const uint64_t generation = scene.generation;
    author::DiagnoseOptions options{scene.encoding, thorough, [&] { return !is_current(main, generation); }};
    lock.unlock();
    author::Findings findings;
    try {
      findings = author::diagnose(main, snapshot.texts, options);
    } catch (const std::exception& e) {
      // Such as memory that ran out: of this text nothing more is known.
      findings[main].push_back({Severity::Error, {}, {}, e.what(), {}, {}, {}, {}, {}});
    }
    lock.lock();
    const auto found = scenes_.find(main);
    const bool current = found != scenes_.end() && found->second.generation == generation;
    // With the lock, so that nothing old is said behind what is new.
    if (current) done_(main, findings, snapshot);
    if (current && !thorough) found->second.quick_done = generation;
    changed_.notify_all();
  }
}

}  // namespace whit::lsp
