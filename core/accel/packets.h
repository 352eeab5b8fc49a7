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
template <>
struct Packets<kStream> {
  using Ray = RayStream;
  using RayHit = RayHitStream;
};

/// Copies the first `count` of up to N values. A whole packet is a matter of one instruction, without a call.
template <int N, class T>
void copy_lanes(T* to, const T* from, int count) {
  if (count == N) std::memcpy(to, from, sizeof(T) * N);
  else std::memcpy(to, from, sizeof(T) * static_cast<size_t>(count));
}

/// Which lanes go into a packet: those from `first` on, or those of a list.
struct LanesFrom {
  int first;
  int operator[](int i) const { return first + i; }
};
struct LanesOf {
  const int32_t* list;
  int operator[](int i) const { return list[i]; }
};

/// Where rays end: values of the lanes from `first` on; null: nowhere.
struct LaneEnds {
  const float* t = nullptr;
  int first = 0;
};

/// Copies `count` of up to N values from lanes of an array.
template <int N, class T>
void take_lanes(T* to, const T* from, LanesFrom lanes, int count) {
  copy_lanes<N>(to, from + lanes.first, count);
}
template <int N, class T>
void take_lanes(T* to, const T* from, LanesOf lanes, int count) {
  for (int i = 0; i < count; ++i) to[i] = from[lanes[i]];
}

template <int N>
void take_ends(float* to, const LaneEnds& ends, LanesFrom lanes, int count) {
  copy_lanes<N>(to, ends.t + (lanes.first - ends.first), count);
}
template <int N>
void take_ends(float* to, const LaneEnds& ends, LanesOf lanes, int count) {
  for (int i = 0; i < count; ++i) to[i] = ends.t[lanes[i] - ends.first];
}

/// Makes all hits of a packet misses.
template <int N, class Hit>
void no_hits(Hit& hit) {
  for (int i = 0; i < N; ++i) {
    hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
}

/// Fills one packet from `count` lanes, with their ends. Lanes beyond count and rays that are not usable are switched off
/// by `valid`, and are such that nothing happens to them should Embree look at them all the same.
template <int N, class Lanes, class Packet>
void load_packet(const RayLanes& rays, Lanes lanes, int count, const LaneEnds& ends, Packet& ray, int* valid) {
  const auto copy = [&](float* to, const float* from) { take_lanes<N>(to, from, lanes, count); };
  copy(ray.org_x, rays.o.x), copy(ray.org_y, rays.o.y), copy(ray.org_z, rays.o.z);
  copy(ray.dir_x, rays.d.x), copy(ray.dir_y, rays.d.y), copy(ray.dir_z, rays.d.z);
  for (int i = 0; i < N; ++i) {
    ray.tnear[i] = 0;
    ray.time[i] = 0;
    ray.tfar[i] = std::numeric_limits<float>::infinity();
    ray.mask[i] = 0xffffffffu;
    ray.flags[i] = 0;
  }
  for (int i = 0; i < count; ++i) ray.id[i] = static_cast<unsigned>(lanes[i]);
  if (ends.t) take_ends<N>(ray.tfar, ends, lanes, count);
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
