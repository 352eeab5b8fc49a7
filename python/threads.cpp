#include "python/threads.h"

#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace whit::python {
namespace {

class Thread;

/// Never destroyed: threads that are idle while the process ends look at it.
struct Idle {
  std::mutex mutex;
  std::vector<Thread*> threads;
};
Idle& idle() {
  static Idle& all = *new Idle;
  return all;
}

class Thread {
 public:
  Thread() {
    std::thread([this] {
      for (;;) work();
    }).detach();
  }
  void give(std::function<void()> job) {
    {
      const std::lock_guard lock(mutex_);
      job_ = std::move(job);
    }
    given_.notify_one();
  }

 private:
  void work() {
    std::unique_lock lock(mutex_);
    given_.wait(lock, [this] { return job_ != nullptr; });
    std::exchange(job_, nullptr)();
    lock.unlock();
    const std::lock_guard among(idle().mutex);
    idle().threads.push_back(this);
  }

  std::mutex mutex_;
  std::condition_variable given_;
  std::function<void()> job_;
};

Thread& idle_or_new() {
  const std::lock_guard lock(idle().mutex);
  if (idle().threads.empty()) return *new Thread;
  Thread* const thread = idle().threads.back();
  idle().threads.pop_back();
  return *thread;
}

}  // namespace

void run_in_thread(std::function<void()> job) { idle_or_new().give(std::move(job)); }

}  // namespace whit::python
