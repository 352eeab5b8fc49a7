#include "core/accel/accel.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <optional>

#include "core/accel/analytic_scene.h"
#include "core/accel/blockers.h"
#include "core/accel/built_mesh.h"
#include "core/accel/device.h"
#include "core/accel/embree.h"
#include "core/accel/embree_geometry.h"
#include "core/accel/near_emitter.h"
#include "core/accel/packets.h"
#include "core/accel/replay.h"
#include "core/accel/second_look.h"
#include "core/accel/shadow_rays.h"
#include "core/base/box.h"

namespace whit {

struct Accel::Impl {
  std::shared_ptr<AccelDevice> shared_device;
  RTCDevice device = nullptr;  ///< The same.
  bool robust = true;
  int width = 4;  ///< Of the largest packets that Embree traces whole on this processor; it takes larger ones apart.
  RayRecord* record = nullptr;
  struct Group {
    RTCScene scene = nullptr;
    int first_shape = 0;  ///< Shape index of geometry 0: a group's shapes are numbered without gaps.
    int shape_count = 0;
    int some_geometry = -1;              ///< A number of a geometry that is in the scene.
    std::shared_ptr<BuiltMesh> built{};  ///< Whose scene it is, where it came built.
  };
  std::vector<Group> groups;
  std::optional<AnalyticScene> analytic;  ///< Of the world; see there.
  std::vector<int32_t> instance_group;
  std::vector<Box3d> swept;                                 ///< Of each instance that moves: where it ever is.
  std::vector<std::pair<int, std::vector<Affine>>> placed;  ///< Groups and keys of instances, until build().
  Blockers blockers;                                        ///< Of the world; not of use where there are curves.
  bool knows_blockers = true;
  std::vector<std::unique_ptr<GeometryUser>> users;
  bool has_meshes = false, second_look = false;
  double small_scene = 0;
  double worth = 0;  ///< Of the whole scene, in triangles; see AccelOptions.

  template <int N>
  void intersect(const RayLanes& rays, const Hits& hits, EmbreeQuery& query, bool also_analytic, int first,
                 int last) const;
  template <int N>
  void intersect(const RayLanes& rays, const Hits& hits, bool coherent) const;
  void intersect_packets(const RayLanes& rays, const Hits& hits, bool coherent) const;
  template <int N>
  void trace_block(const RayLanes& rays, int first, int count, const float* t_far, int unshaded, EmbreeQuery& query,
                   uint8_t* blocked) const;
  template <int N>
  int occluded(const RayLanes& rays, uint8_t* blocked) const;
  void sweep_instances();

  Group& group(int g) { return groups[static_cast<size_t>(g)]; }
  void commit() const {
    for (size_t g = 1; g < groups.size(); ++g) {
      if (!groups[g].built) rtcCommitScene(groups[g].scene);
    }
    rtcCommitScene(groups[kWorld].scene);
    rtcCommitScene(analytic->scene());
  }
  GeometryUser* new_user(const AnalyticShape* shape, const AlphaTest* alpha, const CurveView& curves = {}) {
    users.push_back(std::make_unique<GeometryUser>());
    users.back()->analytic = shape, users.back()->alpha = alpha, users.back()->curves = curves;
    return users.back().get();
  }
  /// Attaches with the geometry number that makes shape = first_shape + number.
  void attach(int g, RTCGeometry geometry, int shape) {
    Group& to = group(g);
    to.some_geometry = attach(g, to.scene, geometry, shape);
  }
  /// The same to a scene beside the group's; returns the number.
  int attach(int g, RTCScene scene, RTCGeometry geometry, int shape) {
    Group& to = group(g);
    if (to.shape_count == 0) to.first_shape = shape;
    const int number = shape - to.first_shape;
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(number));
    rtcReleaseGeometry(geometry);
    to.shape_count = std::max(to.shape_count, number + 1);
    return number;
  }
};

// In triangles: where the coherence hint wins and loses was measured with scenes of both kinds. Curves and instances
// are never few.
constexpr double kWorthOfAnalytic = 200, kWorthOfLarge = 1e9;

Accel::Accel(const AccelOptions& options) : impl_(std::make_unique<Impl>()) {
  impl_->robust = options.robust, impl_->small_scene = options.small_scene;
  impl_->second_look = options.second_look;
  impl_->shared_device = options.device ? options.device : make_accel_device(options.embree);
  impl_->device = impl_->shared_device->get();
  if (impl_->shared_device->can(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED)) impl_->width = 8;
  if (impl_->shared_device->can(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) impl_->width = 16;
  add_group();
  impl_->analytic.emplace(impl_->shared_device->new_scene(options.robust));
}

Accel::~Accel() {
  for (auto& g : impl_->groups) {
    if (!g.built) rtcReleaseScene(g.scene);
  }
  impl_->analytic.reset();
}

int Accel::add_group() {
  impl_->groups.push_back({impl_->shared_device->new_scene(impl_->robust)});
  return static_cast<int>(impl_->groups.size()) - 1;
}

int Accel::add_built(std::shared_ptr<BuiltMesh> mesh, int shape) {
  impl_->worth += static_cast<double>(mesh->triangle_count());
  impl_->has_meshes = true;
  impl_->groups.push_back({mesh->scene(), shape, 1, 0, mesh});
  return static_cast<int>(impl_->groups.size()) - 1;
}

void Accel::add_mesh(int group, const MeshView& mesh, int shape, const AlphaTest* alpha) {
  RTCGeometry g = impl_->shared_device->new_mesh(mesh, *impl_->new_user(nullptr, alpha));
  if (alpha) set_alpha_filter(g);
  impl_->attach(group, g, shape);
  if (group == kWorld) impl_->blockers.add_mesh(mesh);
  impl_->worth += static_cast<double>(mesh.triangle_count);
  impl_->has_meshes = true;
}

void Accel::add_curves(int group, const CurveView& curves, int shape, const AlphaTest* alpha) {
  RTCGeometry g = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(curves.piece_count()));
  rtcSetGeometryUserData(g, impl_->new_user(nullptr, alpha, curves));
  set_curve_callbacks(g);
  impl_->attach(group, g, shape);
  if (group == kWorld) impl_->knows_blockers = false;
  impl_->worth += kWorthOfLarge;
}

void Accel::add_exact(int group, std::span<const ExactTriangle> triangles, int shape, const AlphaTest* alpha) {
  RTCGeometry g = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(triangles.size()));
  GeometryUser* const user = impl_->new_user(nullptr, alpha);
  user->triangles = triangles.data();
  rtcSetGeometryUserData(g, user);
  set_exact_callbacks(g);
  impl_->attach(group, g, shape);
  if (group == kWorld) impl_->blockers.add_exact(triangles);
  impl_->worth += kWorthOfAnalytic * static_cast<double>(triangles.size());
}

void Accel::add_analytic(int group, const AnalyticShape& geometry, int shape, const AlphaTest* alpha) {
  RTCGeometry g = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(g, 1);
  GeometryUser* const user = impl_->new_user(&geometry, alpha);
  user->bounds = bounds_of(geometry);
  if (geometry.cannot_shade_itself()) user->unshaded_by_itself = shape;
  rtcSetGeometryUserData(g, user);
  set_analytic_callbacks(g);
  if (group == kWorld) {
    impl_->attach(group, impl_->analytic->scene(), g, shape);
    impl_->analytic->add_box(user->bounds, user->unshaded_by_itself);
    impl_->blockers.add_box(transform_box(geometry.object_to_scene(), geometry.object_bounds()),
                            user->unshaded_by_itself);
  } else {
    impl_->attach(group, g, shape);
  }
  impl_->worth += kWorthOfAnalytic;
}

int Accel::add_instance(int group, const std::vector<Affine>& keys) {
  RTCGeometry g = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(g, impl_->group(group).scene);
  rtcSetGeometryTimeStepCount(g, static_cast<unsigned>(keys.size()));
  for (size_t k = 0; k < keys.size(); ++k) {
    rtcSetGeometryTransform(g, static_cast<unsigned>(k), RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, keys[k].m);
  }
  rtcCommitGeometry(g);
  // Instances are numbered after the world's own shapes, which are all there when the first instance comes.
  const int index = static_cast<int>(impl_->instance_group.size());
  Impl::Group& world = impl_->group(kWorld);
  world.some_geometry = world.shape_count + index;
  rtcAttachGeometryByID(world.scene, g, static_cast<unsigned>(world.some_geometry));
  rtcReleaseGeometry(g);
  impl_->instance_group.push_back(group);
  // Among thousands next to nothing is in the clear.
  constexpr int kMany = 1000;
  if (index >= kMany) impl_->knows_blockers = false;
  if (index < kMany || keys.size() > 1) impl_->placed.emplace_back(group, keys);
  impl_->worth += kWorthOfLarge;
  return index;
}

/// Between two keys a point moves on a straight line, so the boxes at the keys hold all there is.
void Accel::Impl::sweep_instances() {
  for (const auto& [number, keys] : placed) {
    RTCBounds b;
    rtcGetSceneBounds(group(number).scene, &b);
    const auto wide = [](float v) { return static_cast<double>(v); };
    const Box3d box({wide(b.lower_x), wide(b.lower_y), wide(b.lower_z)},
                    {wide(b.upper_x), wide(b.upper_y), wide(b.upper_z)});
    if (box.isEmpty()) continue;
    Box3d all;
    for (const Affine& key : keys) {
      Mat4d m;
      for (int i = 0; i < 12; ++i) m[i / 3][i % 3] = wide(key.m[i]);
      all.extendBy(transform_box(m, box));
    }
    // Embree traces instances in their own space, by floats of the transform.
    const Vec3d rounding(1e-5 * (all.size().length() + all.center().length()));
    blockers.add_box(Box3d(all.min - rounding, all.max + rounding));
    if (keys.size() > 1) swept.push_back(all);
  }
  placed.clear();
}

/// Throws std::bad_alloc where there is not enough memory, as watch_ends() does.
std::string Accel::build() {
  impl_->commit();
  impl_->sweep_instances();
  if (impl_->knows_blockers) impl_->blockers.build();
  return impl_->shared_device->problem();
}

std::string Accel::watch_ends() {
  for (const Impl::Group& group : impl_->groups) {
    if (group.built) {
      group.built->watch_ends();
      continue;
    }
    AccelDevice::set_flags(group.scene, impl_->robust, kQueryFilter);
    // A scene is built anew when something in it is committed, and not for flags alone.
    if (group.some_geometry >= 0)
      rtcCommitGeometry(rtcGetGeometry(group.scene, static_cast<unsigned>(group.some_geometry)));
  }
  impl_->commit();
  return impl_->shared_device->problem();
}

/// The hits of rays [first, last), at most N.
template <int N>
void Accel::Impl::intersect(const RayLanes& rays, const Hits& hits, EmbreeQuery& query, bool also_analytic, int first,
                            int last) const {
  const int world_first = groups[kWorld].first_shape, world_shapes = groups[kWorld].shape_count;
  const int count = last - first;
  alignas(64) typename Packets<N>::RayHit packet;
  alignas(64) int valid[N];
  load_packet<N>(rays, LanesFrom{first}, count, {rays.t_max, 0}, packet.ray, valid);
  no_hits<N>(packet.hit);
  query.trace(valid, groups[kWorld].scene, packet);
  if (also_analytic) query.trace(valid, analytic->scene(), packet);
  copy_lanes<N>(hits.t + first, packet.ray.tfar, count);
  copy_lanes<N>(hits.u + first, packet.hit.u, count);
  copy_lanes<N>(hits.v + first, packet.hit.v, count);
  copy_lanes<N>(hits.prim + first, packet.hit.primID, count);
  for (int i = 0; i < count; ++i) {
    if (!valid[i]) hits.t[first + i] = std::numeric_limits<float>::quiet_NaN();
    const unsigned geometry = packet.hit.geomID[i], instance = packet.hit.instID[0][i];
    const bool hit = geometry != RTC_INVALID_GEOMETRY_ID;
    const bool instanced = hit && instance != RTC_INVALID_GEOMETRY_ID;
    hits.instance[first + i] = instanced ? static_cast<int32_t>(instance) - world_shapes : -1;
    hits.shape[first + i] = hit ? static_cast<int32_t>(geometry) + world_first : -1;
  }
}

template <int N>
void Accel::Impl::intersect(const RayLanes& rays, const Hits& hits, bool coherent) const {
  static_assert(kStream == AnalyticScene::kBlock);
  const bool alike = coherent || worth <= small_scene, may_stream = kHasStreams && alike && instance_group.empty();
  EmbreeQuery query(alike);
  int32_t lanes[kStream];
  for (int first = 0; first < rays.n; first += kStream) {
    const int last = std::min(first + kStream, rays.n), count = last - first;
    const int near = analytic->reaching(rays, first, count, rays.t_max ? rays.t_max + first : nullptr, kNobody, lanes);
    const bool all = AnalyticScene::are_most(near, count);
    if (may_stream && !all && count > N) {
      intersect<kStream>(rays, hits, query, false, first, last);
    } else {
      for (int k = first; k < last; k += N) intersect<N>(rays, hits, query, all, k, std::min(k + N, last));
    }
    if (!all) analytic->intersect<N>(rays, lanes, near, hits, query, groups[kWorld].first_shape);
  }
}

void Accel::Impl::intersect_packets(const RayLanes& rays, const Hits& hits, bool coherent) const {
  switch (width) {
    case 16: intersect<16>(rays, hits, coherent); break;
    case 8: intersect<8>(rays, hits, coherent); break;
    default: intersect<4>(rays, hits, coherent); break;
  }
}

void Accel::intersect(const RayLanes& rays, const Hits& hits, bool coherent) const {
  if (impl_->record) impl_->record->add(coherent ? RayKind::Camera : RayKind::Secondary, rays);
  const auto trace = [&](const RayLanes& r, const Hits& h) { impl_->intersect_packets(r, h, coherent); };
  trace(rays, hits);
  if (impl_->second_look && coherent && impl_->has_meshes && impl_->robust) SecondLook().look(rays, hits, trace);
  if (impl_->instance_group.empty()) return;
  const int world_first = impl_->groups[kWorld].first_shape;
  for (int i = 0; i < rays.n; ++i) {
    if (hits.instance[i] < 0) continue;
    const int group = impl_->instance_group[static_cast<size_t>(hits.instance[i])];
    hits.shape[i] += impl_->groups[static_cast<size_t>(group)].first_shape - world_first;
  }
}

/// Writes 1 where rays [first, first + count), at most a block, are blocked before t_far, which has a value for each of
/// them, else 0.
template <int N>
void Accel::Impl::trace_block(const RayLanes& rays, int first, int count, const float* t_far, int unshaded,
                              EmbreeQuery& query, uint8_t* blocked) const {
  alignas(64) typename Packets<N>::Ray packet;
  alignas(64) int valid[N];
  int32_t lanes[AnalyticScene::kBlock];
  int near = analytic->reaching(rays, first, count, t_far, unshaded, lanes);
  const bool all = AnalyticScene::are_most(near, count);
  for (int k = 0; k < count; k += N) {
    const int here = std::min(N, count - k);
    load_packet<N>(rays, LanesFrom{first + k}, here, {t_far, first}, packet, valid);
    query.trace(valid, groups[kWorld].scene, packet);
    if (all) query.trace(valid, analytic->scene(), packet);
    for (int i = 0; i < here; ++i) blocked[first + k + i] = (valid[i] != 0) & (packet.tfar[i] < 0);
  }
  if (all) return;
  near = static_cast<int>(std::remove_if(lanes, lanes + near, [&](int32_t i) { return blocked[i] != 0; }) - lanes);
  analytic->occluded<N>(rays, lanes, near, {t_far, first}, query, blocked);
}

template <int N>
int Accel::Impl::occluded(const RayLanes& rays, uint8_t* blocked) const {
  static_assert(Blockers::kGroup == AnalyticScene::kBlock);
  // Without the hint: shadow rays begin at different surfaces, and end on different points of a light (docs/speed.md).
  EmbreeQuery query(false);
  const ShadowRays shadow{groups[kWorld].scene, rays};
  const ShadowEnds ends(rays);
  if (ends.any) query.set_shadow(&shadow, ends.touched ? end_filter : nullptr);
  const bool may_be_clear = knows_blockers && !ends.touched;
  alignas(64) float t_far[Blockers::kGroup];
  // Where groups are not in the clear their neighbours are not: after each the next are not asked, one, three, seven ...
  int clear = 0, unasked = 0, patience = 0;
  for (int first = 0; first < rays.n; first += Blockers::kGroup) {
    const int count = std::min(Blockers::kGroup, rays.n - first);
    if (rays.t_max) std::copy_n(rays.t_max + first, count, t_far);
    else std::fill_n(t_far, count, std::numeric_limits<float>::infinity());
    ends.lengthen(first, count, t_far);
    const int unshaded = unshaded_by(rays, first, count);
    if (may_be_clear && unasked-- == 0) {
      if (blockers.are_clear(rays, first, count, t_far, unshaded)) {
        std::fill_n(blocked + first, count, uint8_t{0});
        clear += count, unasked = patience = 0;
        continue;
      }
      unasked = patience = 2 * patience + 1;
    }
    trace_block<N>(rays, first, count, t_far, unshaded, query, blocked);
  }
  return clear;
}

int Accel::occluded(const RayLanes& rays, uint8_t* blocked) const {
  if (impl_->record) impl_->record->add(RayKind::Shadow, rays);
  switch (impl_->width) {
    case 16: return impl_->occluded<16>(rays, blocked);
    case 8: return impl_->occluded<8>(rays, blocked);
    default: return impl_->occluded<4>(rays, blocked);
  }
}

void Accel::record(RayRecord* record) { impl_->record = record; }

Touching Accel::touching(const Box3d& box, const std::array<Vec3d, 3>* corners) const {
  const Impl::Group& world = impl_->groups[kWorld];
  const UserOf user_of = [&](unsigned instance, unsigned geometry) {
    RTCScene scene = world.scene;
    if (instance != RTC_INVALID_GEOMETRY_ID) {
      const auto index = instance - static_cast<unsigned>(world.shape_count);
      scene = impl_->group(impl_->instance_group[index]).scene;
    }
    return static_cast<const GeometryUser*>(rtcGetGeometryUserData(rtcGetGeometry(scene, geometry)));
  };
  const Box3d room(box.min - Vec3d(kNearEnd), box.max + Vec3d(kNearEnd));
  for (const Box3d& swept : impl_->swept) {
    if (swept.intersects(room)) return {true, {}, INFINITY};
  }
  const UserOf analytic_of = [&](unsigned, unsigned geometry) {
    return static_cast<const GeometryUser*>(rtcGetGeometryUserData(rtcGetGeometry(impl_->analytic->scene(), geometry)));
  };
  const Touching analytic = what_is_near(impl_->analytic->scene(), analytic_of, box, corners);
  return analytic.any ? analytic : what_is_near(world.scene, user_of, box, corners);
}

bool Accel::has_instances() const { return !impl_->instance_group.empty(); }

std::array<void*, 2> Accel::embree_scenes() const { return {impl_->groups[kWorld].scene, impl_->analytic->scene()}; }

size_t Accel::bytes() const { return static_cast<size_t>(std::max<ssize_t>(0, impl_->shared_device->bytes)); }

std::string accel_version() {
  return fmt::format("Embree {}.{}.{}", RTC_VERSION_MAJOR, RTC_VERSION_MINOR, RTC_VERSION_PATCH);
}

}  // namespace whit
