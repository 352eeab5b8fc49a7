// Logarithmic axes: from values to places, and the round numbers between.
#pragma once

#include <vector>

namespace whit {

/// From `low` to `high`, both positive.
struct LogAxis {
  double low = 1, high = 10;

  /// Where a value is, 0 at `low` and 1 at `high`; what lies outside, or is no number, is at the nearer end.
  double place(double value) const;

  /// The 1, 2 and 5 times powers of ten on it; the powers alone where those would be more than `most`, and every
  /// second, third ... of them where even these would.
  std::vector<double> ticks(int most) const;
};

/// An axis that shows all of the values that are positive and finite with some room around them; [1, 10] without any.
LogAxis axis_over(const std::vector<double>& values);

}  // namespace whit
