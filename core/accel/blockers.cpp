#include "core/accel/blockers.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/accel/embree_geometry.h"

namespace whit {
namespace {

/// Triangles that share a box, as they follow each other in the mesh: neighbours, in most. Meshes of no more than a few
/// have a box for each: floors and walls, which stand next to their own shadow rays but never in their way.
constexpr size_t kRun = 64, kFew = 32;
/// A shaft that meets so many nodes is not worth more looking.
constexpr int kMostNodes = 64;

}  // namespace

/// Rays as the hull of two boxes: at each share s of the way the box (1 - s) from + s to.
struct Blockers::Shaft {
  Box from, to;
  const RayLanes& rays;
  int first, count;
  const float* t_far;
  int unshaded_by;
};

void Blockers::add_mesh(const MeshView& mesh) { meshes_.push_back(mesh); }

void Blockers::add_exact(std::span<const ExactTriangle> triangles) {
  for (const ExactTriangle& t : triangles) {
    add_box(bounds_of(t));
    items_.back().exact = &t;
  }
}

void Blockers::add_box(const Box3d& box, int unshaded_by_itself) {
  RTCBounds b;
  set_bounds(box, b);
  Item& item = items_.emplace_back();
  item.box = {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
  item.unshaded_by_itself = unshaded_by_itself;
}

namespace {

/// Grows a box [low, high] by what is in [more_low, more_high].
template <class Box>
void grow(Box& box, const std::array<float, 3>& low, const std::array<float, 3>& high) {
  for (size_t k = 0; k < 3; ++k)
    box.low[k] = std::min(box.low[k], low[k]), box.high[k] = std::max(box.high[k], high[k]);
}

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::array<float, 3> kNothingLow{kInfinity, kInfinity, kInfinity};
constexpr std::array<float, 3> kNothingHigh{-kInfinity, -kInfinity, -kInfinity};

}  // namespace

void Blockers::build() {
  for (const MeshView& mesh : meshes_) {
    const bool single = mesh.triangle_count <= kFew;
    const size_t run = single ? 1 : kRun, runs = (mesh.triangle_count + run - 1) / run, before = items_.size();
    items_.resize(before + runs);
    tbb::parallel_for(size_t{0}, runs, [&](size_t r) {
      Item& item = items_[before + r];
      item.box = {kNothingLow, kNothingHigh};
      item.mesh = single ? &mesh : nullptr, item.triangle = static_cast<uint32_t>(r * run);
      for (size_t i = 3 * r * run; i < 3 * std::min((r + 1) * run, mesh.triangle_count); ++i) {
        const float* const p = mesh.positions + 3 * static_cast<size_t>(mesh.indices[i]);
        grow(item.box, {p[0], p[1], p[2]}, {p[0], p[1], p[2]});
      }
    });
  }
  const auto n = static_cast<int>(items_.size());
  all_ = box_of(0, n);
  if (n > 0) build_node(0, n);
}

/// Around items [first, last).
Blockers::Box Blockers::box_of(int first, int last) const {
  Box box{kNothingLow, kNothingHigh};
  for (int i = first; i < last; ++i)
    grow(box, items_[static_cast<size_t>(i)].box.low, items_[static_cast<size_t>(i)].box.high);
  return box;
}

/// Sorts items [first, last) into two halves along the axis on which their middles are farthest apart; where the second
/// begins.
int Blockers::halve(int first, int last) {
  const auto middle = [](const Item& item, size_t axis) { return item.box.low[axis] + item.box.high[axis]; };
  Box middles{kNothingLow, kNothingHigh};
  for (int i = first; i < last; ++i) {
    const Item& item = items_[static_cast<size_t>(i)];
    const Three m{middle(item, 0), middle(item, 1), middle(item, 2)};
    grow(middles, m, m);
  }
  size_t axis = 0;
  for (size_t a = 1; a < 3; ++a)
    if (middles.high[a] - middles.low[a] > middles.high[axis] - middles.low[axis]) axis = a;
  const int half = first + (last - first) / 2;
  std::nth_element(items_.begin() + first, items_.begin() + half, items_.begin() + last,
                   [&](const Item& a, const Item& b) { return middle(a, axis) < middle(b, axis); });
  return half;
}

/// A node over items [first, last), which it sorts: halved three times. Returns its number.
int Blockers::build_node(int first, int last) {
  std::vector<int> cut{first, last};
  while (cut.size() <= kWidth && last - first >= static_cast<int>(cut.size())) {
    std::vector<int> finer{first};
    for (size_t k = 1; k < cut.size(); ++k) {
      if (cut[k] - cut[k - 1] > 1) finer.push_back(halve(cut[k - 1], cut[k]));
      finer.push_back(cut[k]);
    }
    cut = std::move(finer);
  }
  const auto number = nodes_.size();
  nodes_.emplace_back().count = static_cast<int32_t>(cut.size()) - 1;
  for (size_t k = 0; k + 1 < cut.size(); ++k) {
    const int from = cut[k], to = cut[k + 1];
    const int child = to - from == 1 ? ~from : build_node(from, to);
    const Box box = box_of(from, to);
    Node& node = nodes_[number];
    for (size_t a = 0; a < 3; ++a) node.low[a][k] = box.low[a], node.high[a][k] = box.high[a];
    node.child[k] = child;
  }
  return static_cast<int>(number);
}

/// A bit for each child whose box the shaft meets. The box at s meets another where it begins before that ends and ends
/// behind where that begins, along each axis: six conditions a + s (b - a) <= 0 on s.
unsigned Blockers::meets(const Shaft& shaft, const Node& node) {
  alignas(32) float least[kWidth], most[kWidth];
  std::fill_n(least, kWidth, 0.0f), std::fill_n(most, kWidth, 1.0f);
  const auto condition = [](float a, float b, float& from, float& to) {
    constexpr float kWiden = 1e-5f;
    const float zero = a / (a - b);
    const float above = b > 0 ? 2.0f : zero * (1 - kWiden), below = a > 0 ? -1.0f : zero * (1 + kWiden) + kWiden;
    from = std::max(from, a > 0 ? above : 0.0f);
    to = std::min(to, b > 0 ? below : 1.0f);
  };
  for (size_t k = 0; k < 3; ++k) {
    const float* const low = node.low[k];
    const float* const high = node.high[k];
    const float from_low = shaft.from.low[k], to_low = shaft.to.low[k];
    const float from_high = shaft.from.high[k], to_high = shaft.to.high[k];
    for_lanes(kWidth, [&](int i) {
      condition(from_low - high[i], to_low - high[i], least[i], most[i]);
      condition(low[i] - from_high, low[i] - to_high, least[i], most[i]);
    });
  }
  unsigned met = 0;
  for (int i = 0; i < node.count; ++i) met |= static_cast<unsigned>(least[i] <= most[i]) << i;
  return met;
}

/// Whether rays that come near an item pass it: one that does not count, or a triangle that all rays are on one side of.
bool Blockers::is_passed(const Item& item, const Shaft& shaft) {
  if (item.unshaded_by_itself == shaft.unshaded_by) return true;
  if (item.exact) return are_beside(shaft, item.exact->n, item.exact->n * item.exact->height, item.exact->error);
  if (!item.mesh) return false;
  const EndTriangle t = end_triangle(*item.mesh, item.triangle, nullptr);
  return are_beside(shaft, (t.b - t.a).cross(t.c - t.a), t.a, 0);
}

/// Whether all rays are on one side of a plane through a, by more than `error`. In double precision: rays leave a surface
/// by its error bound, a few roundings of floats.
bool Blockers::are_beside(const Shaft& shaft, const Vec3d& n, const Vec3d& a, double error) {
  int in_front = 0, behind = 0;
  for (int i = 0; i < shaft.count; ++i) {
    const int lane = shaft.first + i;
    const Vec3d o(shaft.rays.o[lane]), d(shaft.rays.d[lane]);
    const double start = n.dot(o - a), end = start + n.dot(d) * static_cast<double>(shaft.t_far[i]);
    in_front += (start > error) & (end > error), behind += (start < -error) & (end < -error);
  }
  return in_front == shaft.count || behind == shaft.count;
}

/// The boxes of a shaft: around its rays' origins, and around their ends or where they have left all there is behind.
/// False for rays that are not finite.
bool Blockers::set_ends(Shaft& shaft) const {
  const RayLanes& rays = shaft.rays;
  const int n = shaft.count;
  const float* const origin[3] = {rays.o.x + shaft.first, rays.o.y + shaft.first, rays.o.z + shaft.first};
  const float* const along[3] = {rays.d.x + shaft.first, rays.d.y + shaft.first, rays.d.z + shaft.first};
  float far = 0;  // squared: from the origins to the corners of all there is
  for (size_t k = 0; k < 3; ++k) {
    float low = kInfinity, high = -kInfinity;
    const float* const o = origin[k];
#pragma omp simd reduction(min : low) reduction(max : high)
    for (int i = 0; i < n; ++i) low = o[i] < low ? o[i] : low, high = o[i] > high ? o[i] : high;
    shaft.from.low[k] = low, shaft.from.high[k] = high;
    const float across = std::max(all_.high[k] - low, high - all_.low[k]);
    far += across * across;
  }
  const float reach = 1.01f * std::sqrt(far);
  for (size_t k = 0; k < 3; ++k) {
    float low = kInfinity, high = -kInfinity, most = 0;
    const float *const o = origin[k], *const d = along[k], *const t_far = shaft.t_far;
#pragma omp simd reduction(min : low) reduction(max : high, most)
    for (int i = 0; i < n; ++i) {
      const float t = t_far[i] < reach ? t_far[i] : reach, end = o[i] + d[i] * t;
      low = end < low ? end : low, high = end > high ? end : high, most = t > most ? t : most;
    }
    // Of the sum, and of the product.
    const float rounding = 4e-7f * (std::max(std::abs(low), std::abs(high)) + most);
    shaft.to.low[k] = low - rounding, shaft.to.high[k] = high + rounding;
    if (!(low <= high) || !(shaft.from.low[k] <= shaft.from.high[k])) return false;
  }
  return std::isfinite(reach);
}

bool Blockers::are_clear(const RayLanes& rays, int first, int count, const float* t_far, int unshaded_by) const {
  if (nodes_.empty()) return items_.empty();
  Shaft shaft{{kNothingLow, kNothingHigh}, {kNothingLow, kNothingHigh}, rays, first, count, t_far, unshaded_by};
  if (!set_ends(shaft)) return false;
  std::array<int32_t, 8 * kMostNodes> waiting;
  size_t n = 1;
  waiting[0] = 0;
  for (int visited = 0; n > 0; ++visited) {
    if (visited == kMostNodes) return false;
    const Node& node = nodes_[static_cast<size_t>(waiting[--n])];
    for (unsigned met = meets(shaft, node); met != 0; met &= met - 1) {
      const int32_t child = node.child[std::countr_zero(met)];
      if (child >= 0) waiting[n++] = child;
      else if (!is_passed(items_[static_cast<size_t>(~child)], shaft)) return false;
    }
  }
  return true;
}

}  // namespace whit
