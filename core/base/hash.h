// Integer hashes for samplers: cheap, vectorisable, the same on every machine.
#pragma once

#include <cstdint>

namespace whit {

/// A bijection of 32-bit words in which every input bit changes every output bit with probability near 1/2.
/// Two multiplications and three shifts; the constants are the ones found by search in the "hash prospector" project
/// (Wellons, Prospecting for Hash Functions, 2018, and its issue 19). mix32(0) is 0.
inline uint32_t mix32(uint32_t x) {
  x ^= x >> 16;
  x *= 0x21f0aaadu;
  x ^= x >> 15;
  x *= 0xd35a2d97u;
  x ^= x >> 15;
  return x;
}

/// Takes a further word into a hash. Order matters; a word of 0 changes the hash too.
inline uint32_t hash_combine(uint32_t hash, uint32_t word) { return mix32(hash ^ (word * 0x9e3779b9u + 0x85ebca6bu)); }

/// The key of a pixel (which may lie left of or above the picture) under a base that tells purposes apart.
inline uint32_t pixel_key(uint32_t base, int32_t px, int32_t py) {
  return hash_combine(hash_combine(base, static_cast<uint32_t>(px)), static_cast<uint32_t>(py));
}

/// The upper 24 bits as a number in [0, 1 - 2^-24], evenly spaced: no rounding, so it never reaches 1.
inline float unit_float(uint32_t x) { return static_cast<float>(static_cast<int32_t>(x >> 8)) * 0x1p-24f; }

}  // namespace whit
