// As threads.h says.
#pragma once

#include "tests/tsan/tbb/threads.h"

namespace tbb {

template <class First, class Second>
void parallel_invoke(const First& first, const Second& second) {
  stand_in::for_each_index(2, [&](size_t i) {
    if (i == 0) first();
    else second();
  });
}

}  // namespace tbb
