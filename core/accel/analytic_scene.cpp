#include "core/accel/analytic_scene.h"

#include <algorithm>

#include "core/accel/reach.h"

namespace whit {

void AnalyticScene::add_box(const RTCBounds& bounds, int unshaded_by_itself) {
  boxes_.push_back({bounds, unshaded_by_itself});
  if (boxes_.size() <= kFew) return;
  RTCBounds all = boxes_.front().bounds;
  for (const Reach& box : boxes_) {
    const RTCBounds& b = box.bounds;
    all = {std::min(all.lower_x, b.lower_x), std::min(all.lower_y, b.lower_y), std::min(all.lower_z, b.lower_z), 0,
           std::max(all.upper_x, b.upper_x), std::max(all.upper_y, b.upper_y), std::max(all.upper_z, b.upper_z), 0};
  }
  boxes_.assign(1, {all, kShadesItself});
}

/// A NaN counts as reaching, and boxes are as wide as Embree's robust traversal makes them.
int AnalyticScene::reaching(const RayLanes& rays, int first, int count, const float* t_far, int unshaded_by,
                            int32_t* lanes) const {
  if (empty()) return 0;
  alignas(64) float inverse[3][kBlock];
  alignas(64) int32_t reached[kBlock];
  const Vec3Lanes o = rays.o.from(first), d = rays.d.from(first), one_over{inverse[0], inverse[1], inverse[2]};
  for_lanes(count, [&](int i) { one_over.set(i, {1 / d.x[i], 1 / d.y[i], 1 / d.z[i]}), reached[i] = 0; });
  alignas(64) float endless[kBlock];
  if (!t_far) {
    std::fill_n(endless, count, std::numeric_limits<float>::infinity());
    t_far = endless;
  }
  for (const Reach& reach : boxes_) {
    if (reach.unshaded_by_itself == unshaded_by) continue;
    const RTCBounds box = reach.bounds;
    for_lanes(count, [&](int i) { reached[i] |= reaches(box, o[i], one_over[i], 0, t_far[i]) ? 1 : 0; });
  }
  int n = 0;
  for (int i = 0; i < count; ++i) {
    lanes[n] = first + i;
    n += reached[i];
  }
  return n;
}

template <int N>
void AnalyticScene::intersect(const RayLanes& rays, const int32_t* lanes, int n, const Hits& hits, EmbreeQuery& query,
                              int first_shape) const {
  alignas(64) typename Packets<N>::RayHit packet;
  alignas(64) int valid[N];
  for (int k = 0; k < n; k += N) {
    const int count = std::min(N, n - k);
    load_packet<N>(rays, LanesOf{lanes + k}, count, {hits.t, 0}, packet.ray, valid);
    no_hits<N>(packet.hit);
    query.trace(valid, scene_, packet);
    for (int i = 0; i < count; ++i) {
      if (packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      const int to = lanes[k + i];
      hits.t[to] = packet.ray.tfar[i], hits.u[to] = packet.hit.u[i], hits.v[to] = packet.hit.v[i];
      hits.prim[to] = packet.hit.primID[i], hits.instance[to] = -1;
      hits.shape[to] = static_cast<int32_t>(packet.hit.geomID[i]) + first_shape;
    }
  }
}

template <int N>
void AnalyticScene::occluded(const RayLanes& rays, const int32_t* lanes, int n, const LaneEnds& ends,
                             EmbreeQuery& query, uint8_t* blocked) const {
  alignas(64) typename Packets<N>::Ray packet;
  alignas(64) int valid[N];
  for (int k = 0; k < n; k += N) {
    const int count = std::min(N, n - k);
    load_packet<N>(rays, LanesOf{lanes + k}, count, ends, packet, valid);
    query.trace(valid, scene_, packet);
    for (int i = 0; i < count; ++i) blocked[lanes[k + i]] |= (valid[i] != 0) & (packet.tfar[i] < 0);
  }
}

template void AnalyticScene::intersect<4>(const RayLanes&, const int32_t*, int, const Hits&, EmbreeQuery&, int) const;
template void AnalyticScene::intersect<8>(const RayLanes&, const int32_t*, int, const Hits&, EmbreeQuery&, int) const;
template void AnalyticScene::intersect<16>(const RayLanes&, const int32_t*, int, const Hits&, EmbreeQuery&, int) const;
template void AnalyticScene::occluded<4>(const RayLanes&, const int32_t*, int, const LaneEnds&, EmbreeQuery&,
                                         uint8_t*) const;
template void AnalyticScene::occluded<8>(const RayLanes&, const int32_t*, int, const LaneEnds&, EmbreeQuery&,
                                         uint8_t*) const;
template void AnalyticScene::occluded<16>(const RayLanes&, const int32_t*, int, const LaneEnds&, EmbreeQuery&,
                                          uint8_t*) const;

}  // namespace whit
