// What a step takes: seconds by the clock, and of processor time.
#pragma once

#include <chrono>
#include <ctime>

namespace whit {

/// Seconds, in microseconds or finer.
struct Elapsed {
  double wall = 0;
  double cpu = 0;  ///< Of all threads of the process, whatever they worked on meanwhile.

  Elapsed& operator+=(const Elapsed& o) {
    wall += o.wall, cpu += o.cpu;
    return *this;
  }
  friend Elapsed operator+(Elapsed a, const Elapsed& b) { return a += b; }
  friend Elapsed operator-(const Elapsed& a, const Elapsed& b) { return {a.wall - b.wall, a.cpu - b.cpu}; }
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

/// Times what is done one after another: each part begins where the one before it ended, so that nothing is left out.
class Laps {
 public:
  /// Ends a part.
  Elapsed lap() {
    const Elapsed now = watch_.elapsed(), part = now - last_;
    last_ = now;
    return part;
  }

 private:
  Stopwatch watch_;
  Elapsed last_;
};

}  // namespace whit
