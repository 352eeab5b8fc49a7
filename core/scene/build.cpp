// Building: the only bridge from what a scene file says to live objects.

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <span>
#include <unordered_set>

#include "core/base/box.h"
#include "core/scene/alpha.h"
#include "core/scene/bake.h"
#include "core/scene/coincidence.h"
#include "core/scene/emitter.h"
#include "core/scene/far.h"
#include "core/scene/huge.h"
#include "core/scene/light_end.h"
#include "core/scene/motion.h"
#include "core/scene/read.h"
#include "core/scene/scene.h"

namespace whit {
namespace {

/// A mesh or curves between reading and baking.
struct LoadedShape {
  size_t description = 0;  ///< Index into SceneDescription::shapes.
  MeshData mesh, huge;     ///< Two parts of one mesh: core/scene/huge.h.
  CurveData curves;
  Box3d bounds;  ///< In the group's own world coordinates, double.
};

/// What is left of a loaded shape in its group's space; analytic shapes have neither.
struct BakedShape {
  std::unique_ptr<Mesh> mesh, huge;
  std::unique_ptr<Curves> curves;
  size_t degenerate = 0;  ///< Triangles left out.
};

/// A group of shapes that share a space: the world, an object definition, or one moving shape.
struct Group {
  std::vector<LoadedShape> shapes;
  RenderSpace space;
  Box3d bounds, near;  ///< Of all, and without what is huge or far: floats are made for that.
  Horizon horizon;     ///< Of what stands in it.
  int accel_group = 0;
  bool moving_shape = false;  ///< Holds one shape in object space that moves by its own transform.
};

/// Triangles without area: there can be some in every mesh of thousands, so they are counted and reported once.
struct DegenerateTriangles {
  size_t triangles = 0, shapes = 0;
  SourcePos first;
  void add(size_t n, SourcePos where) {
    if (n == 0) return;
    if (triangles == 0) first = where;
    triangles += n, ++shapes;
  }
};

/// The power of two that brings `radius` to between 64 and 128, where floats and Embree are at ease.
double sane_scale(double radius) {
  if (!(radius > 0) || !std::isfinite(radius)) return 1;
  return std::ldexp(1.0, 6 - std::ilogb(radius));
}

Affine to_affine(const Mat4d& m) {
  Affine a;
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 3; ++c) a.m[3 * r + c] = static_cast<float>(m[r][c]);
  }
  return a;
}

class Builder {
 public:
  Builder(BoundScene bound, EffectPlan plan, const BuildOptions& options, TextureStore& textures,
          Diagnostics& diagnostics)
      : options_(options), textures_(textures), diagnostics_(diagnostics), scene_(std::make_unique<Scene>()) {
    scene_->bound = std::move(bound);
    scene_->plan = std::move(plan);
    scene_->skip_lights = !scene_->plan.everything_on;
  }

  std::unique_ptr<Scene> run() {
    if (!options_complete()) return nullptr;
    read_live(scene_->bound, scene_->plan, diagnostics_);
    drop_unneeded();
    prepare_sampling();
    if (!options_complete()) return nullptr;
    scene_->accel = std::make_unique<Accel>(
        AccelOptions{.robust = options_.robust_traversal, .second_look = scene_->sampler().is_regular()});
    const auto start = Clock::now();
    load_groups();
    leave_out_far_things();
    part_huge_triangles();
    const auto loaded = Clock::now();
    choose_world_space();
    prepare_materials();
    const auto prepared = Clock::now();
    bake_groups();
    const auto baked = Clock::now();
    place_instances();
    prepare_lights();
    prepare_camera();
    if (!options_complete()) return nullptr;
    const auto placed = Clock::now();
    if (!options_.only_check) build_accel();
    const bool everything = scene_->plan.everything_on;
    scene_->sort_keys = std::max(static_cast<int>(keys_.size()), everything ? 2 : 0);
    scene_->has_instances = kKnowsInstances && (!scene_->instances.empty() || everything);
    scene_->build_seconds = {seconds(start, loaded), seconds(loaded, prepared), seconds(prepared, baked),
                             seconds(placed, Clock::now())};
    if (diagnostics_.has_errors() && !options_.keep_going) return nullptr;
    return std::move(scene_);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static double seconds(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
  }

  const SceneDescription& description() const { return *scene_->bound.description; }
  TransformPair transform(int i) const { return pair_of(description().transforms[static_cast<size_t>(i)]); }
  /// A transform as the plan has it move: without motion blur it stands as it does when the shutter opens.
  TransformPair pair_of(const TransformPair& given) const {
    if (!given.animated() || !scene_->plan.off.has(Effect::MotionBlur)) return given;
    const double span = description().time_end - description().time_start;
    const double open = static_cast<double>(scene_->camera().shutter_open) - description().time_start;
    const Mat4d still = interpolate(given, span != 0 ? std::clamp(open / span, 0.0, 1.0) : 0.0);
    return {still, still};
  }

  bool options_complete() const {
    const BoundScene& b = scene_->bound;
    return b.camera.plugin && b.film.plugin && b.filter.plugin && b.sampler.plugin && b.integrator.plugin;
  }

  /// Frees the plugins of statements that the picture does not need. They were made to check their parameters.
  void drop_unneeded() {
    const auto drop = [](auto& all, const std::vector<uint8_t>& live) {
      for (size_t i = 0; i < all.size(); ++i) {
        if (!live[i]) all[i].plugin.reset();
      }
    };
    drop(scene_->bound.shapes, scene_->plan.shape_live);
    drop(scene_->bound.textures, scene_->plan.texture_live);
    drop(scene_->bound.lights, scene_->plan.light_live);
    for (size_t i = 1; i < scene_->bound.materials.size(); ++i) {  // The first stands in for what is wrong.
      if (!scene_->plan.material_live[i]) scene_->bound.materials[i].plugin.reset();
    }
  }

  PrepareContext context(SourcePos where) { return context(where, diagnostics_); }
  PrepareContext context(SourcePos where, Diagnostics& diagnostics) {
    PrepareContext ctx;
    ctx.diagnostics = &diagnostics;
    ctx.statement = where;
    ctx.textures = &textures_;
    ctx.space = scene_->space;
    ctx.scene_radius = scene_radius_;
    ctx.samples_per_pixel = scene_->samples_per_pixel;
    return ctx;
  }

  /// Calls f(i, diagnostics) for each i below n, on all threads; what they report is kept in order.
  template <class F>
  void for_each(size_t n, const F& f) {
    std::vector<Diagnostics> reports(n);
    tbb::parallel_for(size_t{0}, n, [&](size_t i) { f(i, reports[i]); });
    for (const Diagnostics& report : reports) diagnostics_.append(report);
  }

  /// Reads and prepares a plugin, which is dropped when that fails.
  template <class T>
  void prepare(Bound<T>& bound) {
    prepare(bound, diagnostics_);
  }
  template <class T>
  void prepare(Bound<T>& bound, Diagnostics& diagnostics) {
    bound.plugin = after_reading(std::move(bound.plugin), diagnostics, bound.where);
    bound.plugin = prepared(std::move(bound.plugin), context(bound.where, diagnostics));
  }

  void prepare_sampling() {
    Sampler& sampler = *scene_->bound.sampler.plugin;
    sampler.seed = options_.seed;
    if (options_.quick) {
      sampler.set_samples_per_pixel(1);
    } else if (options_.samples_per_pixel > 0) {
      sampler.set_samples_per_pixel(options_.samples_per_pixel);
    }
    scene_->samples_per_pixel = sampler.samples_per_pixel();
    prepare(scene_->bound.sampler);
    prepare(scene_->bound.filter);
    prepare(scene_->bound.film);
    prepare(scene_->bound.integrator);
    for (auto& light : scene_->bound.area_lights) prepare(light);
    scene_->time_start = description().time_start;
    scene_->time_end = description().time_end;
  }

  // ---- Geometry ----

  /// Reads the live shapes, on all threads, and sorts them into groups: 0 the world, then one per object, then one per
  /// moving shape.
  void load_groups() {
    std::vector<LoadedShape> loaded;
    for (size_t i = 0; i < description().shapes.size(); ++i) {
      if (scene_->plan.shape_live[i]) loaded.emplace_back().description = i;
    }
    for_each(loaded.size(), [&](size_t i, Diagnostics& diagnostics) { load_shape(loaded[i], diagnostics); });
    groups_.resize(1 + description().objects.size());
    for (LoadedShape& shape : loaded) {
      const ShapeDescription& d = description().shapes[shape.description];
      Group* group = &groups_[static_cast<size_t>(d.object + 1)];
      if (transform(d.transform).animated()) {
        moving_[d.object].push_back(groups_.size());
        group = &groups_.emplace_back();
        group->moving_shape = true;
      }
      if (shape.bounds.isEmpty()) continue;
      group->bounds.extendBy(shape.bounds);
      group->shapes.push_back(std::move(shape));
    }
  }

  /// Reads or makes the geometry of a shape and finds its bounds, which stay empty when there is none.
  void load_shape(LoadedShape& loaded, Diagnostics& diagnostics) {
    const ShapeDescription& d = description().shapes[loaded.description];
    auto& bound = scene_->bound.shapes[loaded.description];
    prepare(bound, diagnostics);
    if (!bound.plugin) return;
    Shape& shape = *bound.plugin;
    const TransformPair placement = transform(d.transform);
    const Mat4d to_world = placement.animated() ? Mat4d() : placement.start;
    const PrepareContext ctx = context(d.where, diagnostics);
    if (auto* mesh = dynamic_cast<MeshShape*>(&shape)) {
      if (!mesh->build_mesh(ctx, loaded.mesh)) return;
      loaded.bounds = mesh_bounds(loaded.mesh, to_world);
    } else if (auto* curves = dynamic_cast<CurveShape*>(&shape)) {
      if (!curves->build_curves(ctx, loaded.curves)) return;
      MeshData points;
      points.positions = loaded.curves.control_points;
      loaded.bounds = mesh_bounds(points, to_world);
    } else if (auto* analytic = dynamic_cast<AnalyticShape*>(&shape); !analytic->has_no_surface()) {
      loaded.bounds = transform_box(to_world, analytic->object_bounds());
    }
  }

  /// Whether what reaches so far cannot be kept; says so at its statement.
  bool is_too_far(double extent, const Horizon& horizon, SourcePos where, const std::string& what) {
    if (extent <= horizon.limit()) return false;
    diagnostics_.warning(
        where,
        fmt::format("{} {:.3g} units away, more than {:g} times as far as what is nearest", what, extent, kFarthest),
        "left out: numbers have not as many digits");
    return true;
  }

  /// From where distances within a group are measured.
  Vec3d middle_of(const Group& group) const { return &group == &groups_[0] ? eyes()[0] : Vec3d(0, 0, 0); }
  Mat4d to_group_coordinates(const Group& group, const LoadedShape& shape) const {
    return group.moving_shape ? Mat4d() : transform(description().shapes[shape.description].transform).start;
  }

  void add_shapes_to_horizon(Group& group) const {
    // Scenes that are not so wide have no need to look at triangles.
    constexpr double kWide = 1e6;
    std::vector<double> extents(group.shapes.size());
    tbb::parallel_for(size_t{0}, extents.size(), [&](size_t i) {
      const LoadedShape& shape = group.shapes[i];
      const Vec3d middle = middle_of(group);
      extents[i] = extent_of(shape.bounds, middle);
      if (extents[i] > kWide && !shape.mesh.indices.empty())
        extents[i] = least_extent_of(shape.mesh, to_group_coordinates(group, shape), middle);
    });
    for (const double extent : extents) group.horizon.add(extent);
  }

  void leave_out_far_shapes(Group& group) {
    group.bounds = {};
    for (LoadedShape& shape : group.shapes) {
      const Vec3d middle = middle_of(group);
      const double extent = extent_of(shape.bounds, middle);
      const SourcePos where = description().shapes[shape.description].where;
      if (shape.mesh.indices.empty()) {
        if (is_too_far(extent, group.horizon, where, "this shape reaches")) shape.bounds = {};
      } else if (extent > group.horizon.limit()) {
        const Mat4d m = to_group_coordinates(group, shape);
        const size_t lost = leave_out_far(shape.mesh, m, middle, group.horizon.limit());
        is_too_far(
            extent, group.horizon, where,
            fmt::format("{} triangle{} of this shape reach{}", lost, lost == 1 ? "" : "s", lost == 1 ? "es" : ""));
        shape.bounds = shape.mesh.indices.empty() ? Box3d() : mesh_bounds(shape.mesh, m);
      }
      group.bounds.extendBy(shape.bounds);
    }
    std::erase_if(group.shapes, [](const LoadedShape& shape) { return shape.bounds.isEmpty(); });
  }

  /// Within objects first, for it is what is left of them that is placed in the world.
  void leave_out_far_things() {
    for (size_t g = groups_.size(); g-- > 0;) {
      add_shapes_to_horizon(groups_[g]);
      if (g > 0) leave_out_far_shapes(groups_[g]);
    }
    Group& world = groups_[0];
    const Vec3d eye = middle_of(world);
    const auto placed = [&](const Group& group, const TransformPair& t) {
      return std::max(extent_of(t.start, group.bounds, eye), extent_of(t.end, group.bounds, eye));
    };
    const auto instance_extent = [&](const auto& instance) {
      return placed(groups_[static_cast<size_t>(instance.object + 1)], transform(instance.transform));
    };
    for (size_t g : moving_[-1]) world.horizon.add(placed(groups_[g], moving_transform(groups_[g])));
    for (const auto& instance : description().instances) world.horizon.add(instance_extent(instance));
    leave_out_far_shapes(world);
    for (size_t g : moving_[-1]) {
      Group& group = groups_[g];
      if (group.shapes.empty()) continue;
      const SourcePos where = description().shapes[group.shapes[0].description].where;
      const double extent = placed(group, moving_transform(group));
      if (is_too_far(extent, world.horizon, where, "this shape moves")) group.shapes.clear(), group.bounds = {};
    }
    for (size_t i = 0; i < description().instances.size(); ++i) {
      const auto& instance = description().instances[i];
      if (is_too_far(instance_extent(instance), world.horizon, instance.where, "this instance is")) far_.insert(i);
    }
  }

  std::vector<Vec3d> eyes() const {
    const TransformPair camera = transform(description().camera_transform);
    return {camera.start.inverse().translation(), camera.end.inverse().translation()};
  }

  /// Where each group stands: the first of its places, of which an object may have millions.
  std::vector<std::vector<Mat4d>> places() const {
    constexpr size_t kMost = 16;
    std::vector<std::vector<Mat4d>> places(groups_.size());
    const auto add = [&](size_t g, const TransformPair& t) {
      for (const Mat4d& m : {t.start, t.end}) {
        if (places[g].size() < kMost && m.determinant() != 0) places[g].push_back(m);
      }
    };
    for (size_t g = 0; g < groups_.size(); ++g) {
      if (groups_[g].moving_shape) add(g, moving_transform(groups_[g]));
    }
    for (const auto& instance : description().instances) {
      const size_t g = static_cast<size_t>(instance.object + 1);
      if (places[g].size() < kMost) add(g, transform(instance.transform));
    }
    return places;
  }

  /// What is in the world, as far as it is soon told.
  std::vector<Box3d> things_in_world() const {
    constexpr size_t kMostInstances = 10000;
    std::vector<Box3d> things;
    for (const LoadedShape& shape : groups_[0].shapes) things.push_back(shape.bounds);
    const auto moving = moving_.find(-1);
    if (moving != moving_.end()) {
      for (size_t g : moving->second)
        things.push_back(transform_box(moving_transform(groups_[g]).start, groups_[g].bounds));
    }
    for (size_t i = 0; i < std::min(description().instances.size(), kMostInstances); ++i) {
      if (far_.count(i) > 0) continue;
      const auto& instance = description().instances[i];
      things.push_back(
          transform_box(transform(instance.transform).start, groups_[static_cast<size_t>(instance.object + 1)].bounds));
    }
    return things;
  }

  /// Finds what is huge beside what, and makes huge triangles meshes of their own.
  void part_huge_triangles() {
    const std::vector<Box3d> things = things_in_world();
    CloseUps world;
    for (const Box3d& thing : things) world.add(thing);
    for (const Vec3d& eye : eyes()) world.look_from(eye);
    world.end_at(middle_of(groups_[0]), groups_[0].horizon.reach());
    world.sort();
    part_huge_triangles(groups_[0], world);
    const std::vector<std::vector<Mat4d>> all_places = places();
    for (size_t g = 1; g < groups_.size(); ++g) {
      CloseUps around;
      around.end_at(middle_of(groups_[g]), groups_[g].horizon.reach());
      for (const LoadedShape& shape : groups_[g].shapes) around.add(shape.bounds);
      for (const Mat4d& place : all_places[g]) {
        if (groups_[g].bounds.isEmpty() || !world.may_make_huge(transform_box(place, groups_[g].bounds))) continue;
        const Mat4d back = place.inverse();
        for (const Vec3d& eye : eyes()) around.look_from(transform_point(back, eye));
        for (const Box3d& thing : things) around.add(transform_box(back, thing));
      }
      around.sort();
      part_huge_triangles(groups_[g], around);
    }
  }

  void part_huge_triangles(Group& group, const CloseUps& around) {
    tbb::parallel_for(size_t{0}, group.shapes.size(), [&](size_t i) {
      LoadedShape& shape = group.shapes[i];
      if (shape.mesh.indices.empty()) return;
      const Mat4d to_world =
          group.moving_shape ? Mat4d() : transform(description().shapes[shape.description].transform).start;
      const std::vector<uint32_t> huge = find_huge(shape.mesh, to_world, shape.bounds, around);
      if (!huge.empty()) shape.huge = take_huge(shape.mesh, huge);
      if (!huge.empty()) shape.bounds = shape.mesh.indices.empty() ? Box3d() : mesh_bounds(shape.mesh, to_world);
    });
    for (const LoadedShape& shape : group.shapes) {
      const bool is_mesh = !shape.mesh.positions.empty();
      if (extent_of(shape.bounds, middle_of(group)) > group.horizon.reach()) continue;
      if (is_mesh || !around.is_dwarfed_by(shape.bounds)) group.near.extendBy(shape.bounds);
    }
    if (group.near.isEmpty()) group.near = group.bounds;
  }

  /// Render space stands at the camera; object groups stand at their own centres.
  void choose_world_space() {
    const Mat4d camera_to_world = transform(description().camera_transform).start.inverse();
    scene_->space.origin = camera_to_world.translation();
    double radius = 0;
    const auto include = [&](const Box3d& box) {
      if (box.isEmpty()) return;
      double farthest = 0;
      for (const Vec3d& corner : corners_of(box)) {
        farthest = std::max(farthest, (corner - scene_->space.origin).length());
      }
      if (farthest < 2 * groups_[0].horizon.reach()) radius = std::max(radius, farthest);
    };
    include(groups_[0].near);
    for (size_t g : moving_[-1]) {
      const TransformPair t = moving_transform(groups_[g]);
      include(transform_box(t.start, groups_[g].near));
      include(transform_box(t.end, groups_[g].near));
    }
    for (size_t i = 0; i < description().instances.size(); ++i) {
      if (far_.count(i) > 0) continue;
      const auto& instance = description().instances[i];
      const Box3d& object = groups_[static_cast<size_t>(instance.object + 1)].near;
      const TransformPair t = transform(instance.transform);
      include(transform_box(t.start, object));
      if (t.animated()) include(transform_box(t.end, object));
    }
    scene_->space.scale = sane_scale(radius);
    scene_radius_ = radius * scene_->space.scale;
    groups_[0].space = scene_->space;
    for (size_t g = 1; g < groups_.size(); ++g) {
      if (groups_[g].bounds.isEmpty()) continue;
      groups_[g].space.origin = groups_[g].near.center();
      groups_[g].space.scale = sane_scale(groups_[g].near.size().length() / 2);
    }
  }

  TransformPair moving_transform(const Group& g) const {
    if (g.shapes.empty()) return description().transforms[0];
    return transform(description().shapes[g.shapes[0].description].transform);
  }

  void bake_groups() {
    std::vector<std::pair<const Group*, LoadedShape*>> all;
    for (Group& group : groups_) {
      for (LoadedShape& loaded : group.shapes) all.emplace_back(&group, &loaded);
    }
    std::vector<BakedShape> baked(all.size());
    tbb::parallel_for(size_t{0}, all.size(), [&](size_t i) { baked[i] = bake(*all[i].first, *all[i].second); });
    auto next = baked.begin();
    for (Group& group : groups_) {
      if (group.shapes.empty()) continue;
      group.accel_group = &group == &groups_[0] ? Accel::kWorld : scene_->accel->add_group();
      const size_t first = scene_->shapes.size();
      for (const LoadedShape& loaded : group.shapes) {
        BakedShape shape = std::move(*next++);
        std::unique_ptr<Mesh> huge = std::move(shape.huge);
        const bool only_huge = huge && shape.mesh->indices.empty();
        const size_t degenerate = only_huge ? shape.degenerate : 0;
        if (!only_huge) add_shape(group, loaded, std::move(shape));
        if (huge) add_shape(group, loaded, {std::move(huge), nullptr, nullptr, degenerate});
      }
      attach_shapes(group, first);
      group.shapes.resize(1);  // The data is baked; what is left identifies a moving shape.
    }
    if (const auto& [triangles, shapes, first] = degenerate_; triangles > 0) {
      diagnostics_.warning(
          first,
          fmt::format("{} degenerate triangle{} (no area, or repeated)", triangles, triangles == 1 ? "" : "s") +
              (shapes > 1 ? fmt::format(" in {} shapes, the first here", shapes) : ""),
          "left out; the picture is the same without");
    }
  }

  Mat4d to_group(const Group& group, const ShapeDescription& d) const {
    return (group.moving_shape ? Mat4d() : transform(d.transform).start) * group.space.from_world();
  }

  /// The geometry in its group's space; what it was made from is freed.
  BakedShape bake(const Group& group, LoadedShape& loaded) const {
    const ShapeDescription& d = description().shapes[loaded.description];
    const Shape* plugin = scene_->bound.shapes[loaded.description].plugin.get();
    BakedShape baked;
    if (dynamic_cast<const MeshShape*>(plugin)) {
      baked.mesh = bake_mesh(loaded.mesh, to_group(group, d), baked.degenerate);
      baked.degenerate += loaded.mesh.degenerate;
      if (size_t lost = 0; !loaded.huge.indices.empty()) {
        baked.huge = bake_huge(loaded.huge, loaded.mesh, to_group(group, d), lost);
        baked.degenerate += lost;
      }
    } else if (dynamic_cast<const CurveShape*>(plugin)) {
      baked.curves = bake_curves(loaded.curves, to_group(group, d));
    }
    loaded.mesh = {}, loaded.huge = {}, loaded.curves = {};
    return baked;
  }

  void add_shape(const Group& group, const LoadedShape& loaded, BakedShape baked) {
    if (!scene_->bound.shapes[loaded.description].plugin) return;  // dropped with a texture that cuts it out
    const ShapeDescription& d = description().shapes[loaded.description];
    Shape& plugin = *scene_->bound.shapes[loaded.description].plugin;
    SceneShape shape;
    shape.where = d.where;
    shape.material = scene_->bound.shape_material[loaded.description];
    shape.passes_through = scene_->materials[static_cast<size_t>(shape.material)]->is_interface();
    // Given normals are mirrored with the rest, and stay on their side; so does all of a moving shape, as in pbrt-v3.
    const bool own_normals = baked.mesh && !baked.mesh->normals.empty();
    const bool mirrored = !group.moving_shape && swaps_handedness(transform(d.transform).start);
    shape.flips = d.reverse_orientation != (!own_normals && mirrored);
    const int index = static_cast<int>(scene_->shapes.size());
    if (baked.mesh) {
      degenerate_.add(baked.degenerate, d.where);
      if (baked.mesh->indices.empty()) return;
      shape.mesh = scene_->meshes.emplace_back(std::move(baked.mesh)).get();
    } else if (baked.curves) {
      shape.curves = scene_->curves.emplace_back(std::move(baked.curves)).get();
    } else {
      auto& analytic = dynamic_cast<AnalyticShape&>(plugin);
      analytic.place(to_group(group, d), d.reverse_orientation);
      shape.analytic = &analytic;
    }
    shape.unit = static_cast<float>(group.space.scale);
    shape.sort_key = sort_key(shape, index);
    const std::optional<Emission> emission = group.moving_shape ? std::nullopt : emission_of(d, shape);
    if (shape.curves && emission) {
      diagnostics_.warning(d.where, "a curve cannot light other surfaces", "it glows, and that is all");
    }
    if (group.moving_shape && d.area_light >= 0) {
      diagnostics_.warning(d.where, "a moving shape cannot be an area light",
                           "it is shown without emission, as in pbrt");
    }
    plugins_.push_back(&plugin);
    scene_->shapes.push_back(shape);
    if (emission) lit_shapes_.push_back({index, group.accel_group == Accel::kWorld, *emission});
  }

  /// Hands a group's shapes, those from `first` on, to the ray tracer.
  void attach_shapes(const Group& group, size_t first) {
    const std::span<const SceneShape> shapes = std::span(scene_->shapes).subspan(first);
    std::vector<std::unique_ptr<AlphaTest>> tests(shapes.size());
    std::vector<bool> has_alpha(shapes.size());
    for (size_t i = 0; i < shapes.size(); ++i) {
      if (!scene_->plan.live(Effect::Alpha)) continue;
      has_alpha[i] = plugins_[first + i]->is_cut_out();
      if (!has_alpha[i] && !scene_->plan.everything_on) continue;
      tests[i] = make_alpha_test(shapes[i], *plugins_[first + i], group.space.to_world() * scene_->space.from_world());
    }
    Coincidences found = find_coincidences(
        shapes, has_alpha, group.accel_group == Accel::kWorld ? std::optional(Vec3d(0, 0, 0)) : std::nullopt);
    for (auto& [cut_shape, cut] : found.cuts) {
      auto& test = tests[static_cast<size_t>(cut_shape)];
      test = both(std::move(test), std::move(cut));
    }
    report_coincidences(shapes, found.pairs, has_alpha);
    for (size_t i = 0; i < shapes.size(); ++i) {
      attach(group, shapes[i], static_cast<int>(first + i), tests[i].get());
      if (tests[i]) scene_->alpha_tests.push_back(std::move(tests[i]));
    }
  }

  /// Names both shapes of the first few pairs.
  void report_coincidences(std::span<const SceneShape> shapes, const std::vector<Coincidence>& pairs,
                           const std::vector<bool>& has_alpha) {
    constexpr size_t kNamed = 3;
    for (size_t i = 0; i < std::min(pairs.size(), kNamed); ++i) {
      const SceneShape& lower = shapes[static_cast<size_t>(pairs[i].lower)];
      const SceneShape& upper = shapes[static_cast<size_t>(pairs[i].upper)];
      const std::string more = i + 1 == kNamed && pairs.size() > kNamed
                                   ? fmt::format("; there are {} more such pairs", pairs.size() - kNamed)
                                   : "";
      diagnostics_.add({Severity::Warning, ErrorClass::Scene, lower.where,
                        "a part of this shape's surface is also another's" + more,
                        has_alpha[static_cast<size_t>(pairs[i].upper)]
                            ? "rounding decides which is seen, for the other may have holes (alpha); move them apart"
                            : "the later one is seen there; move them apart to see the other",
                        upper.where});
    }
  }

  void attach(const Group& group, const SceneShape& shape, int index, const AlphaTest* alpha) {
    if (shape.mesh && !shape.mesh->exact.empty()) {
      scene_->accel->add_exact(group.accel_group, shape.mesh->exact, index, alpha);
    } else if (shape.mesh) {
      const Mesh& m = *shape.mesh;
      scene_->accel->add_mesh(group.accel_group,
                              {m.positions.data(), m.positions.size() / 3, m.indices.data(), m.triangle_count()}, index,
                              alpha);
    } else if (shape.curves) {
      scene_->accel->add_curves(group.accel_group, shape.curves->view(), index, alpha);
    } else {
      scene_->accel->add_analytic(group.accel_group, *shape.analytic, index, alpha);
    }
  }

  /// Meshes of one material are shaded together; an analytic shape by itself.
  int sort_key(const SceneShape& shape, int index) {
    const int kind = shape.mesh ? 0 : shape.curves ? 1 : 2 + index;
    return keys_.try_emplace({shape.material, kind}, static_cast<int>(keys_.size())).first->second;
  }

  std::optional<Emission> emission_of(const ShapeDescription& d, const SceneShape& shape) const {
    const AreaLight* light = scene_->bound.emission_of(d);
    if (!light || !scene_->plan.needed.has(Effect::AreaLights)) return {};
    // A curve always faces the ray, so it has no back that could be dark.
    return Emission{light->radiance(), light->two_sided() || shape.curves != nullptr, light->sample_count()};
  }

  void place_instances() {
    // One key each, as nearly all have, so that growing does not double what is the largest part of many a scene.
    scene_->instance_keys.reserve(description().instances.size());
    scene_->instances.reserve(description().instances.size());
    for (size_t g : moving_[-1]) place(groups_[g], keyframes(moving_transform(groups_[g])), description().world_begin);
    for (size_t i = 0; i < description().instances.size(); ++i) {
      const auto& instance = description().instances[i];
      if (description().is_singular(instance.transform)) continue;  // reported
      if (far_.count(i) > 0) continue;
      const std::vector<Mat4d> keys = keyframes(transform(instance.transform));
      const Group& object = groups_[static_cast<size_t>(instance.object + 1)];
      place(object, keys, instance.where);
      for (size_t g : moving_[instance.object])
        place(groups_[g], combined(moving_transform(groups_[g]), transform(instance.transform)), instance.where);
    }
  }

  /// A moving shape inside a moving instance: both interpolated at each of the finer set of keys.
  static std::vector<Mat4d> combined(const TransformPair& inner, const TransformPair& outer) {
    const size_t n = std::max(keyframes(inner).size(), keyframes(outer).size());
    std::vector<Mat4d> keys;
    for (size_t i = 0; i < n; ++i) {
      const double s = n > 1 ? static_cast<double>(i) / static_cast<double>(n - 1) : 0;
      keys.push_back(interpolate(inner, s) * interpolate(outer, s));
    }
    return keys;
  }

  /// Whether Embree takes rays to an object's space: it inverts the matrix in float, and ends the program for rays that
  /// get beyond 1.8e18 there.
  bool is_placeable(const Group& group, const Mat4d& to_world) const {
    constexpr double kLargest = 1e15, kLargestVolume = 1e36;
    const Mat4d there = group.space.to_world() * to_world * scene_->space.from_world(), back = there.inverse();
    double largest = 0;
    for (int i = 0; i < 9; ++i) {
      largest = std::max({largest, std::abs(there[i / 3][i % 3]), std::abs(back[i / 3][i % 3])});
    }
    const double volume = std::abs(there.determinant());
    return largest < kLargest && volume < kLargestVolume && volume > 1 / kLargestVolume;
  }

  void place(const Group& group, const std::vector<Mat4d>& to_world, SourcePos where) {
    if (group.shapes.empty() || group.accel_group == Accel::kWorld) return;
    if (!std::all_of(to_world.begin(), to_world.end(), [&](const Mat4d& m) { return is_placeable(group, m); })) {
      diagnostics_.error(where, "an object is 1e15 times smaller or flatter here than in its own space",
                         "apply the scale to the object's shapes instead, inside ObjectBegin");
      return;
    }
    std::vector<Mat4d>& keys = scene_->instance_keys;
    scene_->instances.push_back({static_cast<uint32_t>(keys.size()), static_cast<uint32_t>(to_world.size())});
    std::vector<Affine> affine;
    for (const Mat4d& key : to_world) {
      keys.push_back(group.space.to_world() * key * scene_->space.from_world());
      affine.push_back(to_affine(keys.back()));
    }
    scene_->accel->add_instance(group.accel_group, affine);
  }

  /// What touches lights is found by asking what was built, and needs another build only where something does.
  void build_accel() {
    std::string problem = scene_->accel->build();
    if (problem.empty()) {
      for_each(scene_->lights.size(),
               [&](size_t i, Diagnostics&) { scene_->lights[i].end = end_of(*scene_, scene_->lights[i]); });
      scene_->any_touched =
          std::any_of(scene_->lights.begin(), scene_->lights.end(), [](const SceneLight& l) { return l.end.touched; });
      if (scene_->any_touched) problem = scene_->accel->watch_ends();
    }
    if (!problem.empty()) diagnostics_.error(description().world_begin, problem);
  }

  // ---- Everything else ----

  void prepare_materials() {
    BoundScene& bound = scene_->bound;
    std::vector<uint8_t> failed(bound.textures.size());
    for_each(bound.textures.size(), [&](size_t i, Diagnostics& diagnostics) {
      if (!bound.textures[i].plugin || !scene_->plan.texture_live[i]) return;
      prepare(bound.textures[i], diagnostics);
      failed[i] = !bound.textures[i].plugin;
    });
    for (size_t i = 0; i < bound.materials.size(); ++i) {
      if (scene_->plan.material_live[i]) prepare(bound.materials[i]);
    }
    drop_users(bound, failed);
    for (auto& material : bound.materials) {
      // Nobody wears it. Or it is not usable, which has been reported; --keep-going shows the default material.
      if (!material.plugin) material.plugin = bound.materials[0].plugin;
      scene_->materials.push_back(material.plugin.get());
    }
  }

  void prepare_lights() {
    for (size_t i = 0; i < scene_->bound.lights.size(); ++i) {
      auto& light = scene_->bound.lights[i];
      if (!scene_->plan.light_live[i]) continue;
      prepare(light);
      if (!light.plugin) continue;
      // Squares of distances up to here are within the range of floats.
      constexpr double kFarthestLight = 1e18;
      const std::optional<Vec3d> position = light.plugin->position();
      if (position && !(position->length() < kFarthestLight)) {
        diagnostics_.warning(light.where,
                             fmt::format("this light is {:.3g} units away", position->length() / scene_->space.scale),
                             "left out: floats cannot hold the square of that beside the rest of the scene");
        continue;
      }
      const int number = scene_->plan.direct_light ? static_cast<int>(scene_->lights.size()) : -1;
      if (number >= 0) add_light({.light = light.plugin.get()});
      if (light.plugin->is_environment()) scene_->environments.push_back({light.plugin.get(), number});
    }
    for (const LitShape& lit : lit_shapes_) add_emitters(lit);
    const std::optional<LightStrategy> strategy = scene_->integrator().light_strategy();
    if (strategy && !scene_->lights.empty())
      scene_->light_choice = make_light_choice(scene_->lights, *strategy, scene_radius_);
  }

  void add_light(SceneLight entry) {
    if (!entry.light->is_delta()) {
      entry.dimension = scene_->light_dimensions;
      scene_->light_dimensions += 2;
    }
    entry.reach = entry.light->reach();
    entry.samples = entry.light->sample_count();
    scene_->lights.push_back(entry);
  }

  /// A shape that emits. What is in an object can be seen, but not sampled.
  struct LitShape {
    int index;
    bool in_world;
    Emission emission;
  };

  /// As in pbrt, each triangle of an emitting mesh is a light of its own.
  void add_emitters(const LitShape& lit) {
    SceneShape& shape = scene_->shapes[static_cast<size_t>(lit.index)];
    shape.emitter = static_cast<int>(scene_->emitters.size());
    const bool sampled = lit.in_world && scene_->plan.direct_light && !shape.curves;
    if (sampled) shape.first_light = static_cast<int>(scene_->lights.size());
    const size_t count = sampled && shape.mesh ? shape.mesh->triangle_count() : 1;
    for (size_t t = 0; t < count; ++t) {
      const auto prim = static_cast<uint32_t>(t);
      scene_->emitters.push_back(make_emitter(shape, prim, lit.emission));
      if (sampled) add_light({.light = scene_->emitters.back().get(), .shape = lit.index, .prim = prim});
    }
  }

  void prepare_camera() {
    Camera& camera = *scene_->bound.camera.plugin;
    const Film& film = *scene_->bound.film.plugin;
    camera.film = {film.resolution(), film.diagonal_metres()};
    if (options_.quick) {
      camera.film.resolution.x = std::max(1, camera.film.resolution.x / 4);
      camera.film.resolution.y = std::max(1, camera.film.resolution.y / 4);
    }
    prepare(scene_->bound.camera);
    if (!scene_->bound.camera.plugin) return;
    const TransformPair world_to_camera = transform(description().camera_transform);
    const TransformPair camera_to_world{world_to_camera.start.inverse(), world_to_camera.end.inverse()};
    for (const Mat4d& key : keyframes(camera_to_world)) {
      scene_->camera_keys.push_back(key * scene_->space.from_world());
    }
  }

  BuildOptions options_;
  TextureStore& textures_;
  Diagnostics& diagnostics_;
  std::unique_ptr<Scene> scene_;
  std::vector<Group> groups_;
  std::map<int, std::vector<size_t>> moving_;  ///< Groups of moving shapes, by object (-1: the world).
  std::unordered_set<size_t> far_;             ///< Instances that are left out.
  std::map<std::pair<int, int>, int> keys_;
  std::vector<LitShape> lit_shapes_;
  DegenerateTriangles degenerate_;
  std::vector<const Shape*> plugins_;  ///< Of Scene::shapes.
  double scene_radius_ = 1;
};

}  // namespace

size_t Mesh::bytes() const {
  return sizeof(float) * (positions.capacity() + normals.capacity() + tangents.capacity() + uvs.capacity()) +
         sizeof(uint32_t) * indices.capacity() + sizeof(ExactTriangle) * exact.capacity();
}

size_t Scene::triangle_count() const {
  size_t n = 0;
  for (const auto& m : meshes) n += m->triangle_count();
  return n;
}

size_t Scene::geometry_bytes() const {
  size_t n = accel ? accel->bytes() : 0;
  for (const auto& m : meshes) n += m->bytes();
  return n;
}

std::unique_ptr<Scene> build_scene(BoundScene bound, EffectPlan plan, const BuildOptions& options,
                                   TextureStore& textures, Diagnostics& diagnostics) {
  return Builder(std::move(bound), std::move(plan), options, textures, diagnostics).run();
}

}  // namespace whit
