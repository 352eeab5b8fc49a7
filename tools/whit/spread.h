// Several measurements of one thing.
#pragma once

#include <algorithm>
#include <vector>

namespace whit {

struct Spread {
  double low = 0, median = 0, high = 0;
};

/// The least, the middle and the greatest of the values; there must be one.
inline Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {values.front(), values[values.size() / 2], values.back()};
}

}  // namespace whit
