// Randomised radical inverses and permutations of small sets: the arithmetic of low-discrepancy samplers.
#pragma once

#include <bit>
#include <cstdint>

#include "core/base/hash.h"

namespace whit {

/// The largest float below 1, the upper end of every sample.
inline constexpr float kBelowOne = 0x1.fffffep-1f;

/// The 32 bits in reverse order.
inline uint32_t reverse_bits(uint32_t x) {
  x = (x << 16) | (x >> 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
  x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
  return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

/// A bijection chosen by `key` in which a bit of the result depends on that bit and on less significant ones alone,
/// which is what multiplications by even numbers give. Sources: Laine and Karras, Stratified Sampling for Stochastic
/// Transparency, 2011; the constants are Vegdahl's (Building a Better LK Hash, 2021).
inline uint32_t hash_upwards(uint32_t x, uint32_t key) {
  x ^= x * 0x3d20adeau;
  x += key;
  x *= (key >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// The base 2 radical inverse of `index` under a nested uniform (Owen) scramble chosen by `key`, in [0, 1 - 2^-24].
/// A bit of the scrambled number depends on the key and on the more significant bits alone; on the reversed number these
/// are the less significant ones, and the reversed number is the index itself. Source: Burley, Practical Hash-based Owen
/// Scrambling, JCGT 9(4), 2020.
inline float owen_base2(uint32_t index, uint32_t key) { return unit_float(reverse_bits(hash_upwards(index, key))); }

/// The same as a permutation of sample numbers: every 2^m that follow each other from a multiple of 2^m on go to such
/// numbers again.
inline uint32_t shuffle_nested(uint32_t index, uint32_t key) {
  return reverse_bits(hash_upwards(reverse_bits(index), key));
}

/// x / 3 for x < 2^22, in fewer instructions than the compiler's for all x where vectors multiply integers slowly. Exact:
/// (x + 1/2) / 3 is at least 1/6 away from an integer, and its rounding error is below x * 2^-23.
inline uint32_t third_of(uint32_t x) {
  return static_cast<uint32_t>(
      static_cast<int32_t>((static_cast<float>(static_cast<int32_t>(x)) + 0.5f) * (1.0f / 3.0f)));
}

/// One step of the nested scramble in base 3: takes the lowest digit off `index`, appends its image under one of the
/// six permutations (chosen by `key`) to `value`, and moves `key` on along the branch of that digit. index < 2^22.
inline void owen_base3_digit(uint32_t& index, uint32_t& key, uint32_t& value) {
  const uint32_t quotient = third_of(index);
  const uint32_t digit = index - 3 * quotient;
  const uint32_t shift = ((key >> 16) * 3) >> 16;          // 0, 1 or 2
  const uint32_t image = digit * (1 + (key & 1)) + shift;  // at most 6
  value = 3 * value + image - 3 * (image / 3);
  index = quotient;
  key = hash_combine(key, digit);
}

/// The lowest `digits` base 3 digits of x in reverse order: the radical inverse times 3^digits.
inline uint32_t reverse_base3(uint32_t x, int digits) {
  uint32_t out = 0;
  for (int d = 0; d < digits; ++d) {
    out = 3 * out + x % 3;
    x /= 3;
  }
  return out;
}

/// The number of base 3 digits that tell `count` >= 1 indices apart, at least 1.
inline int base3_digits(uint32_t count) {
  int digits = 1;
  for (uint64_t reach = 3; reach < count; reach *= 3) ++digits;
  return digits;
}

/// A bijection of the numbers below 2^bits (1 <= bits <= 32), chosen by `key`: four rounds of addition,
/// multiplication by an odd number and folding the upper half onto the lower, each a bijection.
inline uint32_t permute_bits(uint32_t x, int bits, uint32_t key) {
  const uint32_t mask = 0xffffffffu >> (32 - bits);
  const int fold = (bits + 1) / 2;
  constexpr uint32_t kOdd[4] = {0x9e3779b1u, 0x85ebca77u, 0xc2b2ae3du, 0x27d4eb2fu};
  for (int round = 0; round < 4; ++round) {
    const uint32_t k = (key * kOdd[round]) ^ (key >> 15);
    x = ((x + (k >> 7)) * ((k >> 16) | 1u)) & mask;
    x ^= x >> fold;
  }
  return x;
}

/// The bits that hold the numbers below `count` >= 1, at least 1.
inline int bits_below(uint32_t count) { return count <= 2 ? 1 : std::bit_width(count - 1); }

/// Replaces each of n numbers below `count` by its image under the permutation of these numbers that key_of(i) chooses:
/// a permutation of the next power of two, applied until the image is small enough (a number not below `count` might
/// never come to rest). No lane waits for another's result, so none depends on the batch.
template <class KeyOf>
inline void permute_lanes(int n, uint32_t count, const KeyOf& key_of, uint32_t* index) {
  if (count == 1) return;
  const int bits = bits_below(count);
#pragma omp simd
  for (int i = 0; i < n; ++i) index[i] = permute_bits(index[i], bits, key_of(i));
  if (std::has_single_bit(count)) return;
  for (uint32_t open = 1; open != 0;) {
    open = 0;
#pragma omp simd reduction(| : open)
    for (int i = 0; i < n; ++i) {
      const uint32_t next = permute_bits(index[i], bits, key_of(i));
      index[i] = index[i] < count ? index[i] : next;
      open |= index[i] < count ? 0u : 1u;
    }
  }
}

}  // namespace whit
