// Rays, and what they hit: the batches that light transport is written over.
#pragma once

#include <cstdint>
#include <tuple>

#include "core/batch/lanes.h"

namespace whit {

/// The direction of the differential rays of a ray that has none: its footprints are exactly 0. (Differential rays that
/// equal the ray itself would not do: roundings make footprints of 1e-7 of them, and bump maps divide by those.)
inline constexpr Vec3f kNoDifferential{0, 0, 0};

/// The rays of a neighbouring sample in x and in y.
struct RayDifferentials {
  Vec3Lanes rx_o, rx_d, ry_o, ry_d;
  static constexpr auto fields() {
    using D = RayDifferentials;
    return std::tuple(&D::rx_o, &D::rx_d, &D::ry_o, &D::ry_d);
  }
  explicit operator bool() const { return static_cast<bool>(rx_o); }
};

/// n rays of one depth in render space, and what each carries. A null array is one that nobody asked for.
struct Rays {
  int n = 0;
  int depth = 0;  ///< Bounces so far, 0 for camera rays.
  Vec3Lanes o, d;
  RGBLanes throughput;         ///< What reaches the camera of the radiance that comes along the ray.
  int32_t* slot = nullptr;     ///< Index of the camera sample in the worker's chunk. Ascending.
  uint32_t* stream = nullptr;  ///< Branch of the ray tree, for the sampler.
  float* time = nullptr;       ///< In [0,1] over the transform times.
  float* pdf = nullptr;        ///< With which d was sampled, per solid angle; infinite for a camera or a mirror.
  Vec3Lanes from;              ///< The surface point it left, which o is a little above: where d was sampled.
  float* eta2 = nullptr;       ///< By how much refraction has scaled the radiance: pbrt's etaScale.
  int32_t* via = nullptr;      ///< How the sample left its first surface (core/plugin/transport.h), for AOVs.
  RayDifferentials differentials;

  static constexpr auto fields() {
    return std::tuple(&Rays::o, &Rays::d, &Rays::throughput, &Rays::slot, &Rays::stream, &Rays::time, &Rays::pdf,
                      &Rays::from, &Rays::eta2, &Rays::via, &Rays::differentials);
  }
};

/// The nearest hits of as many rays.
struct Hits {
  float* t = nullptr;                ///< Distance.
  int32_t* shape = nullptr;          ///< Index given to Accel::add_*(), -1 for a miss.
  uint32_t* prim = nullptr;          ///< Triangle or curve segment within the shape.
  int32_t* instance = nullptr;       ///< Index of the instance, -1 for world geometry.
  float *u = nullptr, *v = nullptr;  ///< Barycentric weights of vertices 1 and 2; along and across a curve, in [0,1].

  static constexpr auto fields() {
    return std::tuple(&Hits::t, &Hits::shape, &Hits::prim, &Hits::instance, &Hits::u, &Hits::v);
  }
};

}  // namespace whit
