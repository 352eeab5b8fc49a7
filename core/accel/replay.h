// The ray-cast floor: the rays of a render, kept, and traced again by bare Embree with nothing around it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/accel/accel.h"

namespace whit {

/// Rays by what they are for: camera rays, mirrored and refracted ones, shadow rays.
enum class RayKind : uint8_t { Camera, Secondary, Shadow };

/// The rays of a render on one thread, in the order and in the batches in which they were traced.
class RayRecord {
 public:
  /// Appends a batch; rays that hit nothing because they are not finite are left out, as Embree never sees them.
  void add(RayKind kind, const RayLanes& rays);
  int64_t count(RayKind kind) const { return static_cast<int64_t>(of(kind).tfar.size()); }

 private:
  friend class Replay;
  struct Rays {
    std::vector<float> ox, oy, oz, dx, dy, dz, tfar, time;
    std::vector<int32_t> batches;      ///< Their sizes: packets do not reach over a batch's end.
    std::vector<int32_t> unshaded_by;  ///< By batch: the light that its shadow rays end on, see RayEnd.
  };
  Rays& of(RayKind kind) { return rays_[static_cast<size_t>(kind)]; }
  const Rays& of(RayKind kind) const { return rays_[static_cast<size_t>(kind)]; }
  std::array<Rays, 3> rays_;
};

/// How Embree is called: ray by ray, in packets with or without the hint that neighbours are alike, or in streams of 64
/// with it.
enum class RayCall : uint8_t { Single, Packet8, Packet16, Packet16Coherent, StreamCoherent };
constexpr std::array<RayCall, 5> kRayCalls{RayCall::Single, RayCall::Packet8, RayCall::Packet16,
                                           RayCall::Packet16Coherent, RayCall::StreamCoherent};

/// Whether rays of a kind can be traced in that way: coherent packets of shadow rays cannot where there are instances, and
/// streams are for nearest hits without.
bool is_usable(const Accel& accel, RayKind kind, RayCall call);

/// Seconds that Embree takes for a record's rays of one kind, called in one way, on one thread: loading packets from
/// memory and tracing them, no more.
double replay_seconds(const Accel& accel, const RayRecord& record, RayKind kind, RayCall call);

}  // namespace whit
