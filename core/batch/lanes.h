// Structure-of-arrays views and the loop over them: the vocabulary in which every stage is written.
//
// A lane is one ray, point or sample of a batch. A view holds plain pointers into an Arena; lane i of every
// array belongs together. Loops are written with for_lanes(), which promises the compiler that lanes do not
// depend on each other. Because contraction is off and the functions of core/base/fastmath.h use only basic
// arithmetic, a lane's result has the same bits wherever in a batch it stands.
#pragma once

#include <cstdint>

#include "core/base/vec.h"

namespace whit {

/// Runs body(i) for i in [0, n) as vectorisable, independent iterations. Flattened: a body that is not inlined to
/// its last call does not vectorise, and the compiler finds most bodies too big to inline by itself.
template <class Body>
[[gnu::flatten]] inline void for_lanes(int n, const Body& body) {
#pragma omp simd
  for (int i = 0; i < n; ++i) body(i);
}

/// Three float arrays: points, directions or normals (space stated where it is declared).
struct Vec3Lanes {
  float *x = nullptr, *y = nullptr, *z = nullptr;
  Vec3f operator[](int i) const { return {x[i], y[i], z[i]}; }
  void set(int i, const Vec3f& v) const { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
  Vec3Lanes from(int first) const { return {x + first, y + first, z + first}; }
  explicit operator bool() const { return x != nullptr; }
};

/// Three float arrays of linear colour.
struct RGBLanes {
  float *r = nullptr, *g = nullptr, *b = nullptr;
  RGB operator[](int i) const { return {r[i], g[i], b[i]}; }
  void set(int i, const RGB& c) const { r[i] = c.x, g[i] = c.y, b[i] = c.z; }
  RGBLanes from(int first) const { return {r + first, g + first, b + first}; }
  explicit operator bool() const { return r != nullptr; }
};

/// a times b, lane by lane, in place of a.
inline RGBLanes times(int n, const RGBLanes& a, const RGBLanes& b) {
  for_lanes(n, [&](int i) { a.r[i] *= b.r[i], a.g[i] *= b.g[i], a.b[i] *= b.b[i]; });
  return a;
}

}  // namespace whit
