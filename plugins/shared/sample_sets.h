// Sets of samples one after another: how samplers go on whose samples are no sequence (Sampler::extends()).
#pragma once

#include <algorithm>

#include "core/base/hash.h"
#include "core/batch/lanes.h"

namespace whit {

/// The set that a sample is in, and its number there.
struct PlaceInSet {
  uint32_t set, index;
};
inline PlaceInSet place_in_set(uint32_t sample, uint32_t count) {
  // Exact: a double holds the numbers, and the quotient is at least 1 / (2 count) away from an integer.
  const double quotient = (static_cast<double>(sample) + 0.5) / static_cast<double>(count);
  const auto set = static_cast<uint32_t>(static_cast<int64_t>(quotient));
  return {set, sample - set * count};
}

/// What is to be mixed into the key of a set, so that sets are independent of each other. 0 for the first.
inline uint32_t set_key(uint32_t set) { return mix32(set); }

/// From the numbers of n samples to those within their sets, which are mixed into the keys. Most renders stay in the
/// first set, and pay for no division.
inline void split_sets(int n, uint32_t count, const uint32_t* sample, uint32_t* key, uint32_t* index) {
  uint32_t largest = 0;
#pragma omp simd reduction(max : largest)
  for (int i = 0; i < n; ++i) {
    index[i] = sample[i];
    largest = std::max(largest, sample[i]);
  }
  if (largest < count) return;
  for_lanes(n, [=](int i) {
    const PlaceInSet place = place_in_set(sample[i], count);
    key[i] ^= set_key(place.set);
    index[i] = place.index;
  });
}

}  // namespace whit
