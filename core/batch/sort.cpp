#include "core/batch/sort.h"

#include <cstring>
#include <utility>

namespace whit {

void sort_lanes(const int32_t* keys, int n, int32_t* lanes, Arena& arena) {
  uint32_t any = 0, all = ~0u;
  for (int i = 0; i < n; ++i) {
    any |= static_cast<uint32_t>(keys[lanes[i]]);
    all &= static_cast<uint32_t>(keys[lanes[i]]);
  }
  if (any == all || n < 2) return;
  ArenaScope scope(arena);
  int32_t* from = lanes;
  int32_t* to = arena.alloc<int32_t>(n);
  for (unsigned shift = 0; shift < 32; shift += 8) {
    // A digit in which no two keys differ sorts nothing.
    if ((((any ^ all) >> shift) & 0xffu) == 0) continue;
    int32_t start[257] = {0};
    for (int i = 0; i < n; ++i) ++start[((static_cast<uint32_t>(keys[from[i]]) >> shift) & 0xffu) + 1];
    for (int b = 0; b < 256; ++b) start[b + 1] += start[b];
    for (int i = 0; i < n; ++i) to[start[(static_cast<uint32_t>(keys[from[i]]) >> shift) & 0xffu]++] = from[i];
    std::swap(from, to);
  }
  if (from != lanes) std::memcpy(lanes, from, sizeof(int32_t) * static_cast<size_t>(n));
}

}  // namespace whit
