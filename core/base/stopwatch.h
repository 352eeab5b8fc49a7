// What a step takes: seconds by the clock, and of processor time.
#pragma once

#include <chrono>
#include <ctime>

namespace whit {

/// Seconds, in microseconds or finer.
struct Elapsed {
  double wall = 0;
  double cpu = 0;  ///< Of all threads of the process, whatever they worked on meanwhile.
};

/// Starts both clocks when it is made.
class Stopwatch {
 public:
  Elapsed elapsed() const {
    return {std::chrono::duration<double>(Clock::now() - start_).count(),
            static_cast<double>(std::clock() - cpu_start_) / CLOCKS_PER_SEC};
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
  std::clock_t cpu_start_ = std::clock();
};

}  // namespace whit
