#include "core/accel/replay.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <limits>

#include "core/accel/embree.h"

namespace whit {

void RayRecord::add(RayKind kind, const RayLanes& rays) {
  Rays& to = of(kind);
  int added = 0;
  for (int i = 0; i < rays.n; ++i) {
    const Vec3f o = rays.o[i], d = rays.d[i];
    const float t_max = rays.t_max ? rays.t_max[i] : std::numeric_limits<float>::infinity();
    if (!is_traceable(o, d, t_max)) continue;
    to.ox.push_back(o.x), to.oy.push_back(o.y), to.oz.push_back(o.z);
    to.dx.push_back(d.x), to.dy.push_back(d.y), to.dz.push_back(d.z);
    to.tfar.push_back(t_max);
    to.time.push_back(rays.time ? rays.time[i] : 0.0f);
    ++added;
  }
  to.batches.push_back(added);
  to.unshaded_by.push_back(rays.end ? rays.end->unshaded_by : -1);
}

class Replay {
 public:
  Replay(const Accel& accel, const RayRecord& record, RayKind kind, RayCall call)
      : scenes_(accel.embree_scenes()), rays_(record.of(kind)), query_(call == RayCall::Packet16Coherent) {}

  /// Traces all rays, N at a time.
  template <unsigned N, class Packet>
  void run() {
    size_t first = 0;
    for (size_t b = 0; b < rays_.batches.size(); ++b) {
      const size_t end = first + static_cast<size_t>(rays_.batches[b]);
      query_.set_unshaded_by(rays_.unshaded_by[b]);
      for (; first < end; first = std::min(first + N, end)) trace<N, Packet>(first, std::min<size_t>(N, end - first));
    }
  }

 private:
  template <unsigned N, class Packet>
  void trace(size_t first, size_t count) {
    alignas(64) Packet packet;
    alignas(64) int valid[N];
    RTCRayN* ray = reinterpret_cast<RTCRayN*>(&packet);  // a packet with hits begins with its rays
    const auto load = [&](float& to, const std::vector<float>& from) {
      std::memcpy(&to, from.data() + first, count * sizeof(float));
    };
    load(RTCRayN_org_x(ray, N, 0), rays_.ox), load(RTCRayN_org_y(ray, N, 0), rays_.oy);
    load(RTCRayN_org_z(ray, N, 0), rays_.oz), load(RTCRayN_dir_x(ray, N, 0), rays_.dx);
    load(RTCRayN_dir_y(ray, N, 0), rays_.dy), load(RTCRayN_dir_z(ray, N, 0), rays_.dz);
    load(RTCRayN_tfar(ray, N, 0), rays_.tfar), load(RTCRayN_time(ray, N, 0), rays_.time);
    for (unsigned i = 0; i < N; ++i) {
      RTCRayN_tnear(ray, N, i) = 0;
      RTCRayN_mask(ray, N, i) = 0xffffffffu;
      RTCRayN_flags(ray, N, i) = 0;
      valid[i] = i < count ? -1 : 0;
    }
    // Embree takes packets apart that are wider than the processor's vectors, and looks at these lanes all the same.
    for (size_t i = count; i < N; ++i) switch_off(ray, N, static_cast<unsigned>(i));
    if constexpr (requires { packet.hit; }) {
      RTCHitN* hit = reinterpret_cast<RTCHitN*>(&packet.hit);
      for (unsigned i = 0; i < N; ++i) {
        RTCHitN_geomID(hit, N, i) = RTC_INVALID_GEOMETRY_ID;
        RTCHitN_instID(hit, N, i, 0) = RTC_INVALID_GEOMETRY_ID;
      }
    }
    for (void* scene : scenes_) query_.trace(valid, static_cast<RTCScene>(scene), packet);
  }

  /// Makes a lane a ray that ends before it begins.
  static void switch_off(RTCRayN* ray, unsigned width, unsigned i) {
    RTCRayN_org_x(ray, width, i) = RTCRayN_org_y(ray, width, i) = RTCRayN_org_z(ray, width, i) = 0;
    RTCRayN_dir_x(ray, width, i) = RTCRayN_dir_y(ray, width, i) = 0;
    RTCRayN_dir_z(ray, width, i) = 1;
    RTCRayN_tfar(ray, width, i) = -std::numeric_limits<float>::infinity();
    RTCRayN_time(ray, width, i) = 0;
  }

  std::array<void*, 2> scenes_;
  const RayRecord::Rays& rays_;
  EmbreeQuery query_;
};

bool is_usable(const Accel& accel, RayKind kind, RayCall call) {
  if (call == RayCall::StreamCoherent) return kHasStreams && kind != RayKind::Shadow && !accel.has_instances();
  return call != RayCall::Packet16Coherent || kind != RayKind::Shadow || !accel.has_instances();
}

double replay_seconds(const Accel& accel, const RayRecord& record, RayKind kind, RayCall call) {
  Replay replay(accel, record, kind, call);
  const bool shadow = kind == RayKind::Shadow;
  const auto start = std::chrono::steady_clock::now();
  switch (call) {
    case RayCall::Single: shadow ? replay.run<1, RTCRay>() : replay.run<1, RTCRayHit>(); break;
    case RayCall::StreamCoherent: replay.run<kStream, RayHitStream>(); break;
    case RayCall::Packet8: shadow ? replay.run<8, RTCRay8>() : replay.run<8, RTCRayHit8>(); break;
    default: shadow ? replay.run<16, RTCRay16>() : replay.run<16, RTCRayHit16>(); break;
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace whit
