// The first two dimensions of the Sobol sequence, which together are a (0,2)-sequence: of every 2^k points that follow
// each other from a multiple of 2^k on, each box of area 2^-k with sides of powers of two holds one.
#pragma once

#include <cstdint>

#include "core/base/radical_inverse.h"

namespace whit {

/// The second dimension's number with its bits reversed (the first dimension's is `index` itself): bit j is the sum
/// modulo 2 of the bits k of `index` for which the binomial coefficient (k over j) is odd, which are those whose k
/// contains all the bits of j (Lucas). Its own inverse; the lowest byte of the result of a byte is that of its own.
inline uint32_t sobol_second(uint32_t index) {
  index ^= (index >> 1) & 0x55555555u;
  index ^= (index >> 2) & 0x33333333u;
  index ^= (index >> 4) & 0x0f0f0f0fu;
  index ^= (index >> 8) & 0x00ff00ffu;
  return index ^ (index >> 16);
}

/// A point of the sequence under two nested uniform (Owen) scrambles, in [0, 1 - 2^-24].
inline float sobol_x(uint32_t index, uint32_t key) { return owen_base2(index, key); }
inline float sobol_y(uint32_t index, uint32_t key) { return owen_base2(sobol_second(index), key); }

}  // namespace whit
