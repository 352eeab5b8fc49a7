// As threads.h says.
#pragma once

#include "tests/tsan/tbb/threads.h"

namespace tbb {

class global_control {
 public:
  enum parameter { max_allowed_parallelism };
  global_control(parameter, size_t value) : before_(stand_in::allowed.exchange(value)) {}
  ~global_control() { stand_in::allowed = before_; }
  global_control(const global_control&) = delete;
  global_control& operator=(const global_control&) = delete;

 private:
  size_t before_;
};

}  // namespace tbb
