// Stable sorting of lanes by small integer keys.
#pragma once

#include <cstdint>

#include "core/batch/arena.h"

namespace whit {

/// Writes to order[0..n) the lanes that keys are given for, sorted by key, equal keys in their old order.
/// `lanes` holds the n lanes on entry; keys[lane] is the key of a lane, >= 0. Least-significant-digit radix
/// sort with 8-bit digits: time linear in n and the bytes of the largest key; nothing is moved when all keys
/// are equal.
void sort_lanes(const int32_t* keys, int n, int32_t* lanes, Arena& arena);

}  // namespace whit
