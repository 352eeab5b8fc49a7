#include "core/scene/build_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>

#include "core/base/box.h"
#include "core/plugin/memory_limit.h"
#include "core/scene/bake.h"
#include "core/scene/huge.h"

namespace whit {
namespace {

// ---- Reading ----

/// Objects that are placed more often are kept no more: each placing of each of their meshes would be an instance.
constexpr int kMostPlaces = 100;

/// Whether a mesh is the same wherever it stands, and asks nothing of the scene when rays meet it.
bool may_be_kept(const BuildContext& context, const ShapeDescription& d, const Shape& shape) {
  if (!context.kept || d.area_light >= 0 || shape.is_cut_out()) return false;
  const TransformPair placement = context.transform(d.transform);
  // What is bent further than this cannot be an instance in floats.
  constexpr double kLeastScale = 1e-6, kLargestScale = 1e6;
  const double scale = std::cbrt(std::abs(placement.start.determinant()));
  if (placement.animated() || !(scale > kLeastScale && scale < kLargestScale)) return false;
  return d.object < 0 || context.placed[static_cast<size_t>(d.object)] <= kMostPlaces;
}

/// Reads or makes the geometry of a shape and finds its bounds, which stay empty when there is none.
void load_shape(const BuildContext& context, Bound<Shape>& bound, LoadedShape& loaded, Diagnostics& reports) {
  const ShapeDescription& d = context.shape(loaded.description);
  context.prepare(bound, reports);
  if (!bound.plugin) return;
  Shape& shape = *bound.plugin;
  const TransformPair placement = context.transform(d.transform);
  const PrepareContext preparation = context.preparation(d.where, reports);
  if (auto* mesh = dynamic_cast<MeshShape*>(&shape); mesh && may_be_kept(context, d, shape)) {
    loaded.key = mesh_key(d, context.description().folder, preparation.attributes);
    if (!loaded.key.empty()) loaded.kept = context.kept->find(loaded.key);
    if (loaded.kept) {
      loaded.bounds = loaded.kept->bounds;
      for (Diagnostic said : loaded.kept->said.all()) {
        // They were said of a text that is no more.
        said.where = d.where, said.other = {};
        reports.add(std::move(said));
      }
      return;
    }
  }
  if (!placement.animated()) loaded.to_group = placement.start;
  if (auto* mesh = dynamic_cast<MeshShape*>(&shape)) {
    if (!mesh->build_mesh(preparation, loaded.mesh)) return;
    if (loaded.mesh.indices.size() < 3 * KeptGeometry::kLeast) loaded.key = {};
    if (!loaded.key.empty()) loaded.to_group = Mat4d(), loaded.said = reports;
    if (!preparation.attributes.uvs1) loaded.mesh.uvs1 = {};
    if (!preparation.attributes.colors) loaded.mesh.colors = {};
    loaded.bounds = mesh_bounds(loaded.mesh, loaded.to_group);
  } else if (auto* curves = dynamic_cast<CurveShape*>(&shape)) {
    if (!curves->build_curves(preparation, loaded.curves)) return;
    MeshData points;
    points.positions = loaded.curves.control_points;
    loaded.bounds = mesh_bounds(points, loaded.to_group);
  } else if (auto* analytic = dynamic_cast<AnalyticShape*>(&shape); !analytic->has_no_surface()) {
    loaded.bounds = transform_box(loaded.to_group, analytic->object_bounds());
  }
}

Groups read_groups(const BuildContext& context, std::vector<Bound<Shape>>& shapes) {
  std::vector<LoadedShape> loaded;
  for (size_t i = 0; i < shapes.size(); ++i) {
    if (context.scene.plan.shape_live[i]) loaded.emplace_back().description = i;
  }
  context.for_each(loaded.size(), [&](size_t i, Diagnostics& reports) {
    Bound<Shape>& shape = shapes[loaded[i].description];
    try {
      load_shape(context, shape, loaded[i], reports);
    } catch (const std::bad_alloc&) {
      // What there is of it goes first, to have room for words.
      loaded[i].mesh = {}, loaded[i].curves = {}, loaded[i].bounds = {};
      const ShapeDescription& d = context.shape(loaded[i].description);
      reports.add(limit_error(d.where, fmt::format("not enough memory for this {}", d.plugin)));
      shape.plugin.reset();
    }
  });
  Groups groups;
  groups.all.resize(1 + context.description().objects.size());
  for (LoadedShape& shape : loaded) {
    const ShapeDescription& d = context.shape(shape.description);
    Group* group = &groups.all[static_cast<size_t>(d.object + 1)];
    const TransformPair placement = context.transform(d.transform);
    if (placement.animated() || !shape.key.empty()) {
      groups.moving[d.object].push_back(groups.all.size());
      group = &groups.all.emplace_back();
      group->motion = placement;
    }
    if (shape.bounds.isEmpty()) continue;
    group->bounds.extendBy(shape.bounds);
    group->shapes.push_back(std::move(shape));
  }
  return groups;
}

/// Where the camera is at the first and at the last moment.
std::array<Vec3d, 2> eyes(const BuildContext& context) {
  const TransformPair camera = context.transform(context.description().camera_transform);
  return {camera.start.inverse().translation(), camera.end.inverse().translation()};
}

// ---- What is too far away ----

/// Whether what reaches so far cannot be kept; says so at its statement.
bool is_too_far(const BuildContext& context, double extent, const Horizon& horizon, SourcePos where,
                const std::string& what) {
  if (extent <= horizon.limit()) return false;
  context.diagnostics.warning(
      where,
      fmt::format("{} {:.3g} units away, more than {:g} times as far as what is nearest", what, extent, kFarthest),
      "left out: numbers have not as many digits");
  return true;
}

void add_shapes_to_horizon(Group& group) {
  // Scenes that are not so wide have no need to look at triangles.
  constexpr double kWide = 1e6;
  std::vector<double> extents(group.shapes.size());
  tbb::parallel_for(size_t{0}, extents.size(), [&](size_t i) {
    const LoadedShape& shape = group.shapes[i];
    extents[i] = extent_of(shape.bounds, group.middle);
    if (extents[i] > kWide && !shape.mesh.indices.empty())
      extents[i] = least_extent_of(shape.mesh, shape.to_group, group.middle);
  });
  for (const double extent : extents) group.horizon.add(extent);
}

void leave_out_far_shapes(const BuildContext& context, Group& group) {
  group.bounds = {};
  for (LoadedShape& shape : group.shapes) {
    const double extent = extent_of(shape.bounds, group.middle);
    const SourcePos where = context.shape(shape.description).where;
    if (shape.mesh.indices.empty()) {
      if (is_too_far(context, extent, group.horizon, where, "this shape reaches")) shape.bounds = {};
    } else if (extent > group.horizon.limit()) {
      const size_t lost = leave_out_far(shape.mesh, shape.to_group, group.middle, group.horizon.limit());
      is_too_far(context, extent, group.horizon, where,
                 fmt::format("{} triangle{} of this shape reach{}", lost, lost == 1 ? "" : "s", lost == 1 ? "es" : ""));
      shape.bounds = shape.mesh.indices.empty() ? Box3d() : mesh_bounds(shape.mesh, shape.to_group);
    }
    group.bounds.extendBy(shape.bounds);
  }
  std::erase_if(group.shapes, [](const LoadedShape& shape) { return shape.bounds.isEmpty(); });
}

/// Within objects first, for it is what is left of them that is placed in the world.
void leave_out_far_things(const BuildContext& context, Groups& groups) {
  for (size_t g = groups.all.size(); g-- > 0;) {
    add_shapes_to_horizon(groups.all[g]);
    if (g > 0) leave_out_far_shapes(context, groups.all[g]);
  }
  Group& world = groups.world();
  const auto placed = [&](const Group& group, const TransformPair& t) {
    return std::max(extent_of(t.start, group.bounds, world.middle), extent_of(t.end, group.bounds, world.middle));
  };
  const auto instance_extent = [&](const InstanceDescription& instance) {
    return placed(groups.placed_by(instance), context.transform(instance.transform));
  };
  const auto& instances = context.description().instances;
  for (size_t g : groups.moving_in(-1)) world.horizon.add(placed(groups.all[g], *groups.all[g].motion));
  for (const auto& instance : instances) world.horizon.add(instance_extent(instance));
  leave_out_far_shapes(context, world);
  for (size_t g : groups.moving_in(-1)) {
    Group& group = groups.all[g];
    if (group.shapes.empty()) continue;
    const SourcePos where = context.shape(group.shapes[0].description).where;
    const double extent = placed(group, *group.motion);
    if (is_too_far(context, extent, world.horizon, where,
                   group.motion->animated() ? "this shape moves" : "this shape reaches"))
      group.shapes.clear(), group.bounds = {};
  }
  for (size_t i = 0; i < instances.size(); ++i) {
    if (is_too_far(context, instance_extent(instances[i]), world.horizon, instances[i].where, "this instance is"))
      groups.left_out.insert(i);
  }
}

// ---- What is huge ----

/// Where each group stands: the first of its places, of which an object may have millions.
std::vector<std::vector<Mat4d>> places(const BuildContext& context, const Groups& groups) {
  constexpr size_t kMost = 16;
  std::vector<std::vector<Mat4d>> places(groups.all.size());
  const auto add = [&](size_t g, const TransformPair& t) {
    for (const Mat4d& m : {t.start, t.end}) {
      if (places[g].size() < kMost && m.determinant() != 0) places[g].push_back(m);
    }
  };
  for (size_t g = 0; g < groups.all.size(); ++g) {
    if (groups.all[g].motion) add(g, *groups.all[g].motion);
  }
  for (const auto& instance : context.description().instances) {
    const auto g = static_cast<size_t>(instance.object + 1);
    if (places[g].size() < kMost) add(g, context.transform(instance.transform));
  }
  return places;
}

/// What is in the world, as far as it is soon told.
std::vector<Box3d> things_in_world(const BuildContext& context, const Groups& groups) {
  constexpr size_t kMostInstances = 10000;
  std::vector<Box3d> things;
  for (const LoadedShape& shape : groups.world().shapes) things.push_back(shape.bounds);
  for (size_t g : groups.moving_in(-1))
    things.push_back(transform_box(groups.all[g].motion->start, groups.all[g].bounds));
  const auto& instances = context.description().instances;
  for (size_t i = 0; i < std::min(instances.size(), kMostInstances); ++i) {
    if (groups.left_out.count(i) > 0) continue;
    things.push_back(
        transform_box(context.transform(instances[i].transform).start, groups.placed_by(instances[i]).bounds));
  }
  return things;
}

/// Makes the huge triangles of each mesh a mesh of their own, and bounds what is not huge.
void part_group(Group& group, const CloseUps& around) {
  tbb::parallel_for(size_t{0}, group.shapes.size(), [&](size_t i) {
    LoadedShape& shape = group.shapes[i];
    if (shape.mesh.indices.empty()) return;
    const std::vector<uint32_t> huge = find_huge(shape.mesh, shape.to_group, shape.bounds, around);
    if (huge.empty()) return;
    shape.huge = take_huge(shape.mesh, huge);
    shape.bounds = shape.mesh.indices.empty() ? Box3d() : mesh_bounds(shape.mesh, shape.to_group);
  });
  for (const LoadedShape& shape : group.shapes) {
    const bool is_mesh = !shape.mesh.positions.empty();
    if (extent_of(shape.bounds, group.middle) > group.horizon.reach()) continue;
    if (is_mesh || !around.is_dwarfed_by(shape.bounds)) group.near.extendBy(shape.bounds);
  }
  if (group.near.isEmpty()) group.near = group.bounds;
}

void part_huge_triangles(const BuildContext& context, Groups& groups) {
  const std::vector<Box3d> things = things_in_world(context, groups);
  CloseUps world;
  for (const Box3d& thing : things) world.add(thing);
  for (const Vec3d& eye : eyes(context)) world.look_from(eye);
  world.end_at(groups.world().middle, groups.world().horizon.reach());
  world.sort();
  part_group(groups.world(), world);
  const std::vector<std::vector<Mat4d>> all_places = places(context, groups);
  for (size_t g = 1; g < groups.all.size(); ++g) {
    Group& group = groups.all[g];
    CloseUps around;
    around.end_at(group.middle, group.horizon.reach());
    for (const LoadedShape& shape : group.shapes) around.add(shape.bounds);
    for (const Mat4d& place : all_places[g]) {
      if (group.bounds.isEmpty() || !world.may_make_huge(transform_box(place, group.bounds))) continue;
      const Mat4d back = place.inverse();
      for (const Vec3d& eye : eyes(context)) around.look_from(transform_point(back, eye));
      for (const Box3d& thing : things) around.add(transform_box(back, thing));
    }
    around.sort();
    part_group(group, around);
  }
}

// ---- Spaces ----

/// The power of two that brings `radius` to between 64 and 128, where floats and Embree are at ease.
double sane_scale(double radius) {
  if (!(radius > 0) || !std::isfinite(radius)) return 1;
  return std::ldexp(1.0, 6 - std::ilogb(radius));
}

/// How far from a point all that is not far reaches, in world units.
double world_radius(const BuildContext& context, const Groups& groups, const Vec3d& from) {
  double radius = 0;
  const auto include = [&](const Box3d& box) {
    if (box.isEmpty()) return;
    double farthest = 0;
    for (const Vec3d& corner : corners_of(box)) farthest = std::max(farthest, (corner - from).length());
    if (farthest < 2 * groups.world().horizon.reach()) radius = std::max(radius, farthest);
  };
  include(groups.world().near);
  for (size_t g : groups.moving_in(-1)) {
    const Group& group = groups.all[g];
    include(transform_box(group.motion->start, group.near));
    include(transform_box(group.motion->end, group.near));
  }
  const auto& instances = context.description().instances;
  for (size_t i = 0; i < instances.size(); ++i) {
    if (groups.left_out.count(i) > 0) continue;
    const Box3d& object = groups.placed_by(instances[i]).near;
    const TransformPair t = context.transform(instances[i].transform);
    include(transform_box(t.start, object));
    if (t.animated()) include(transform_box(t.end, object));
  }
  return radius;
}

}  // namespace

Groups load_groups(const BuildContext& context, std::vector<Bound<Shape>>& shapes) {
  Groups groups = read_groups(context, shapes);
  groups.world().middle = eyes(context)[0];
  leave_out_far_things(context, groups);
  part_huge_triangles(context, groups);
  return groups;
}

WorldSpace choose_spaces(const BuildContext& context, Groups& groups) {
  WorldSpace world;
  world.space.origin = eyes(context)[0];
  const double radius = world_radius(context, groups, world.space.origin);
  world.space.scale = sane_scale(radius);
  world.radius = radius * world.space.scale;
  groups.world().space = world.space;
  for (size_t g = 1; g < groups.all.size(); ++g) {
    Group& group = groups.all[g];
    if (group.bounds.isEmpty()) continue;
    group.space.origin = group.near.center();
    group.space.scale = sane_scale(group.near.size().length() / 2);
    if (!group.shapes.empty() && group.shapes[0].kept) group.space = group.shapes[0].kept->space;
  }
  return world;
}

}  // namespace whit
