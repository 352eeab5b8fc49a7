// Rays from arrays into the packets that Embree traces.
#pragma once

#include <cstring>
#include <limits>

#include "core/accel/accel.h"
#include "core/accel/embree.h"

namespace whit {

/// Embree's packets of N rays.
template <int N>
struct Packets;
template <>
struct Packets<4> {
  using Ray = RTCRay4;
  using RayHit = RTCRayHit4;
};
template <>
struct Packets<8> {
  using Ray = RTCRay8;
  using RayHit = RTCRayHit8;
};
template <>
struct Packets<16> {
  using Ray = RTCRay16;
  using RayHit = RTCRayHit16;
};

/// Copies the first `count` of up to N values. A whole packet is a matter of one instruction, without a call.
template <int N, class T>
void copy_lanes(T* to, const T* from, int count) {
  if (count == N) std::memcpy(to, from, sizeof(T) * N);
  else std::memcpy(to, from, sizeof(T) * static_cast<size_t>(count));
}

/// Fills one packet from lanes [first, first + count). Lanes beyond count and rays that are not usable are switched off
/// by `valid`, and are such that nothing happens to them should Embree look at them all the same.
template <int N, class Packet>
void load_packet(const RayLanes& rays, int first, int count, Packet& ray, int* valid) {
  const auto copy = [&](float* to, const float* from) { copy_lanes<N>(to, from + first, count); };
  copy(ray.org_x, rays.o.x), copy(ray.org_y, rays.o.y), copy(ray.org_z, rays.o.z);
  copy(ray.dir_x, rays.d.x), copy(ray.dir_y, rays.d.y), copy(ray.dir_z, rays.d.z);
  for (int i = 0; i < N; ++i) {
    ray.tnear[i] = 0;
    ray.time[i] = 0;
    ray.tfar[i] = std::numeric_limits<float>::infinity();
    ray.mask[i] = 0xffffffffu;
    ray.id[i] = static_cast<unsigned>(first + i);
    ray.flags[i] = 0;
  }
  if (rays.t_max) copy(ray.tfar, rays.t_max);
  if (rays.time) copy(ray.time, rays.time);
  for (int i = 0; i < N; ++i) {
    const Vec3f o(ray.org_x[i], ray.org_y[i], ray.org_z[i]), d(ray.dir_x[i], ray.dir_y[i], ray.dir_z[i]);
    const bool use = (i < count) & is_traceable(o, d, ray.tfar[i]);
    valid[i] = use ? -1 : 0;
    ray.org_x[i] = use ? ray.org_x[i] : 0.0f;
    ray.org_y[i] = use ? ray.org_y[i] : 0.0f;
    ray.org_z[i] = use ? ray.org_z[i] : 0.0f;
    ray.dir_x[i] = use ? ray.dir_x[i] : 0.0f;
    ray.dir_y[i] = use ? ray.dir_y[i] : 0.0f;
    ray.dir_z[i] = use ? ray.dir_z[i] : 1.0f;
    ray.tfar[i] = use ? ray.tfar[i] : -std::numeric_limits<float>::infinity();
  }
}

}  // namespace whit
