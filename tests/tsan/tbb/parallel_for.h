// As threads.h says.
#pragma once

#include <algorithm>

#include "tests/tsan/tbb/blocked_range.h"
#include "tests/tsan/tbb/threads.h"

namespace tbb {

struct simple_partitioner {};

template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body) {
  if (!(first < last)) return;
  stand_in::for_each_index(static_cast<size_t>(last - first), [&](size_t i) { body(first + static_cast<Index>(i)); });
}

template <class Value, class Body>
void parallel_for(const blocked_range<Value>& range, const Body& body, const simple_partitioner& = {}) {
  if (range.empty()) return;
  const size_t grain = std::max<size_t>(range.grainsize(), 1), blocks = (range.size() + grain - 1) / grain;
  stand_in::for_each_index(blocks, [&](size_t i) {
    const size_t begin = i * grain, end = std::min(begin + grain, range.size());
    body(blocked_range<Value>(range.begin() + static_cast<Value>(begin), range.begin() + static_cast<Value>(end),
                              grain));
  });
}

}  // namespace tbb
