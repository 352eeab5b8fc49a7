#include "core/scene/build_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/scene/alpha.h"
#include "core/scene/bake.h"
#include "core/scene/coincidence.h"
#include "core/scene/motion.h"

namespace whit {
namespace {

/// What is left of a loaded shape in its group's space; analytic shapes have neither.
struct BakedShape {
  std::shared_ptr<const Mesh> mesh, huge;
  std::unique_ptr<Curves> curves;
  size_t degenerate = 0;             ///< Triangles left out.
  std::shared_ptr<BuiltMesh> built;  ///< Of a mesh that is kept.
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
  void report(Diagnostics& diagnostics) const {
    if (triangles == 0) return;
    diagnostics.warning(
        first,
        fmt::format("{} degenerate triangle{} (no area, or repeated)", triangles, triangles == 1 ? "" : "s") +
            (shapes > 1 ? fmt::format(" in {} shapes, the first here", shapes) : ""),
        "left out; the picture is the same without");
  }
};

/// Numbers for shapes that are shaded alike.
class SortKeys {
 public:
  /// Meshes of one material are shaded together; an analytic shape by itself.
  int of(const SceneShape& shape, int index) {
    const int kind = shape.mesh ? 0 : shape.curves ? 1 : 2 + index;
    return keys_.try_emplace({shape.material, kind}, count()).first->second;
  }
  int count() const { return static_cast<int>(keys_.size()); }

 private:
  std::map<std::pair<int, int>, int> keys_;
};

/// What is collected from shape to shape.
struct Baking {
  SortKeys sort_keys;
  DegenerateTriangles degenerate;
  std::vector<LitShape> lit;
  std::vector<const Shape*> plugins;  ///< Of Scene::shapes.
};

Mat4d to_group_space(const Group& group, const LoadedShape& shape) { return shape.to_group * group.space.from_world(); }

MeshView view_of(const Mesh& mesh) {
  return {mesh.positions.data(), mesh.positions.size() / 3, mesh.indices.data(), mesh.triangle_count()};
}

/// Builds a mesh for this and later builds, which must have been baked whole.
void keep(const BuildContext& context, const Group& group, const LoadedShape& loaded, BakedShape& baked) {
  KeptGeometry& kept = *context.kept;
  baked.built = build_mesh(kept.device(), view_of(*baked.mesh), baked.mesh, context.robust);
  kept.put(loaded.key,
           std::make_shared<KeptMesh>(KeptMesh{baked.mesh, baked.built, group.space, loaded.bounds, baked.degenerate,
                                               loaded.said, context.shape(loaded.description).mesh}));
}

/// The geometry in its group's space; what it was made from is freed.
BakedShape bake(const BuildContext& context, const Group& group, const Shape* plugin, LoadedShape& loaded) {
  const Mat4d m = to_group_space(group, loaded);
  BakedShape baked;
  if (loaded.kept) {
    baked.mesh = loaded.kept->mesh, baked.built = loaded.kept->built, baked.degenerate = loaded.kept->degenerate;
    return baked;
  }
  if (dynamic_cast<const MeshShape*>(plugin)) {
    baked.mesh = bake_mesh(loaded.mesh, m, baked.degenerate);
    baked.degenerate += loaded.mesh.degenerate;
    if (size_t lost = 0; !loaded.huge.indices.empty()) {
      baked.huge = bake_huge(loaded.huge, loaded.mesh, m, lost);
      baked.degenerate += lost;
    }
    if (!loaded.key.empty() && !baked.huge && !baked.mesh->indices.empty()) keep(context, group, loaded, baked);
  } else if (dynamic_cast<const CurveShape*>(plugin)) {
    baked.curves = bake_curves(loaded.curves, m);
  }
  loaded.mesh = {}, loaded.huge = {}, loaded.curves = {};
  return baked;
}

/// All shapes of all groups, in order, on all threads.
std::vector<BakedShape> bake_all(const BuildContext& context, Groups& groups) {
  std::vector<std::pair<const Group*, LoadedShape*>> all;
  for (Group& group : groups.all) {
    for (LoadedShape& loaded : group.shapes) all.emplace_back(&group, &loaded);
  }
  std::vector<BakedShape> baked(all.size());
  tbb::parallel_for(size_t{0}, all.size(), [&](size_t i) {
    const auto& [group, loaded] = all[i];
    baked[i] = bake(context, *group, context.scene.bound.shapes[loaded->description].plugin.get(), *loaded);
  });
  return baked;
}

/// Makes a surface of the scene of a baked shape.
void add_shape(const BuildContext& context, const Group& group, const LoadedShape& loaded, BakedShape baked,
               Baking& baking, Scene& scene) {
  if (!scene.bound.shapes[loaded.description].plugin) return;  // dropped with a texture that cuts it out
  const ShapeDescription& d = context.shape(loaded.description);
  Shape& plugin = *scene.bound.shapes[loaded.description].plugin;
  SceneShape shape;
  shape.where = d.where;
  shape.material = scene.bound.shape_material[loaded.description];
  shape.passes_through = scene.materials[static_cast<size_t>(shape.material)]->is_interface();
  // Given normals are mirrored with the rest, and stay on their side; so does all of a moving shape, as in pbrt-v3.
  const bool own_normals = baked.mesh && !baked.mesh->normals.empty();
  const bool mirrored = swaps_handedness(loaded.to_group);
  shape.flips = d.reverse_orientation != (!own_normals && mirrored);
  const int index = static_cast<int>(scene.shapes.size());
  if (baked.mesh) {
    baking.degenerate.add(baked.degenerate, d.where);
    if (baked.mesh->indices.empty()) return;
    scene.meshes.push_back(baked.mesh);
    shape.mesh = baked.mesh.get();
    scene.attributes |= {!shape.mesh->uvs1.empty(), !shape.mesh->colors.empty()};
  } else if (baked.curves) {
    shape.curves = scene.curves.emplace_back(std::move(baked.curves)).get();
  } else {
    auto& analytic = dynamic_cast<AnalyticShape&>(plugin);
    analytic.place(to_group_space(group, loaded), d.reverse_orientation);
    shape.analytic = &analytic;
  }
  shape.unit = static_cast<float>(group.space.scale);
  shape.sort_key = baking.sort_keys.of(shape, index);
  const std::optional<Emission> emission = emission_of(context, d, shape.curves != nullptr, group.motion.has_value());
  if (emission)
    baking.lit.push_back({index, group.accel_group == Accel::kWorld, scene.bound.emission_of(d)->lights(), *emission});
  baking.plugins.push_back(&plugin);
  scene.shapes.push_back(shape);
}

/// Names both shapes of the first few pairs.
void report_coincidences(std::span<const SceneShape> shapes, const std::vector<Coincidence>& pairs,
                         const std::vector<bool>& has_alpha, Diagnostics& diagnostics) {
  constexpr size_t kNamed = 3;
  for (size_t i = 0; i < std::min(pairs.size(), kNamed); ++i) {
    const SceneShape& lower = shapes[static_cast<size_t>(pairs[i].lower)];
    const SceneShape& upper = shapes[static_cast<size_t>(pairs[i].upper)];
    const std::string more = i + 1 == kNamed && pairs.size() > kNamed
                                 ? fmt::format("; there are {} more such pairs", pairs.size() - kNamed)
                                 : "";
    diagnostics.add({Severity::Warning, ErrorClass::Scene, lower.where,
                     "a part of this shape's surface is also another's" + more,
                     has_alpha[static_cast<size_t>(pairs[i].upper)]
                         ? "rounding decides which is seen, for the other may have holes (alpha); move them apart"
                         : "the later one is seen there; move them apart to see the other",
                     upper.where});
  }
}

void attach(Accel& accel, int group, const SceneShape& shape, int index, const AlphaTest* alpha) {
  if (shape.mesh && !shape.mesh->exact.empty()) {
    accel.add_exact(group, shape.mesh->exact, index, alpha);
  } else if (shape.mesh) {
    accel.add_mesh(group, view_of(*shape.mesh), index, alpha);
  } else if (shape.curves) {
    accel.add_curves(group, shape.curves->view(), index, alpha);
  } else {
    accel.add_analytic(group, *shape.analytic, index, alpha);
  }
}

/// Hands a group's shapes, the scene's from `first` on, to the ray tracer. `plugins` are those of all its shapes.
void attach_shapes(const BuildContext& context, const Group& group, size_t first, std::span<const Shape* const> plugins,
                   Scene& scene) {
  const std::span<const SceneShape> shapes = std::span(scene.shapes).subspan(first);
  std::vector<std::unique_ptr<AlphaTest>> tests(shapes.size());
  std::vector<bool> has_alpha(shapes.size());
  for (size_t i = 0; i < shapes.size(); ++i) {
    if (!scene.plan.live(Effect::Alpha)) continue;
    has_alpha[i] = plugins[first + i]->is_cut_out();
    if (!has_alpha[i] && !scene.plan.everything_on) continue;
    tests[i] = make_alpha_test(shapes[i], *plugins[first + i], group.space.to_world() * scene.space.from_world());
  }
  Coincidences found = find_coincidences(
      shapes, has_alpha, group.accel_group == Accel::kWorld ? std::optional(Vec3d(0, 0, 0)) : std::nullopt);
  for (auto& [cut_shape, cut] : found.cuts) {
    auto& test = tests[static_cast<size_t>(cut_shape)];
    test = both(std::move(test), std::move(cut));
  }
  report_coincidences(shapes, found.pairs, has_alpha, context.diagnostics);
  for (size_t i = 0; i < shapes.size(); ++i) {
    attach(*scene.accel, group.accel_group, shapes[i], static_cast<int>(first + i), tests[i].get());
    if (tests[i]) scene.alpha_tests.push_back(std::move(tests[i]));
  }
}

/// A moving shape inside a moving instance: both interpolated at each of the finer set of keys.
std::vector<Mat4d> combined(const TransformPair& inner, const TransformPair& outer) {
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
bool is_placeable(const Mat4d& to_render) {
  constexpr double kLargest = 1e15, kLargestVolume = 1e36;
  const Mat4d back = to_render.inverse();
  double largest = 0;
  for (int i = 0; i < 9; ++i) {
    largest = std::max({largest, std::abs(to_render[i / 3][i % 3]), std::abs(back[i / 3][i % 3])});
  }
  const double volume = std::abs(to_render.determinant());
  return largest < kLargest && volume < kLargestVolume && volume > 1 / kLargestVolume;
}

Affine to_affine(const Mat4d& m) {
  Affine a;
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 3; ++c) a.m[3 * r + c] = static_cast<float>(m[r][c]);
  }
  return a;
}

void place(const BuildContext& context, const Group& group, std::vector<Mat4d> keys, SourcePos where, Scene& scene) {
  if (group.accel_group == Accel::kWorld) return;
  for (Mat4d& key : keys) key = group.space.to_world() * key * scene.space.from_world();
  if (!std::all_of(keys.begin(), keys.end(), is_placeable)) {
    context.diagnostics.error(where, "an object is 1e15 times smaller or flatter here than in its own space",
                              "apply the scale to the object's shapes instead, inside ObjectBegin");
    return;
  }
  scene.instances.push_back({static_cast<uint32_t>(scene.instance_keys.size()), static_cast<uint32_t>(keys.size())});
  scene.instance_keys.insert(scene.instance_keys.end(), keys.begin(), keys.end());
  std::vector<Affine> affine(keys.size());
  std::transform(keys.begin(), keys.end(), affine.begin(), to_affine);
  scene.accel->add_instance(group.accel_group, affine);
}

}  // namespace

BakedGeometry bake_groups(const BuildContext& context, Groups& groups, Scene& scene) {
  std::vector<BakedShape> baked = bake_all(context, groups);
  auto next = baked.begin();
  Baking baking;
  for (Group& group : groups.all) {
    if (group.shapes.empty()) continue;
    const size_t first = scene.shapes.size();
    if (next->built) {
      const std::shared_ptr<BuiltMesh> built = next->built;
      add_shape(context, group, group.shapes[0], std::move(*next++), baking, scene);
      if (scene.shapes.size() > first) group.accel_group = scene.accel->add_built(built, static_cast<int>(first));
      group.shapes = {};
      continue;
    }
    group.accel_group = &group == &groups.world() ? Accel::kWorld : scene.accel->add_group();
    for (const LoadedShape& loaded : group.shapes) {
      BakedShape shape = std::move(*next++);
      std::shared_ptr<const Mesh> huge = std::move(shape.huge);
      const bool only_huge = huge && shape.mesh->indices.empty();
      const size_t degenerate = only_huge ? shape.degenerate : 0;
      if (!only_huge) add_shape(context, group, loaded, std::move(shape), baking, scene);
      if (huge)
        add_shape(context, group, loaded, {std::move(huge), nullptr, nullptr, degenerate, nullptr}, baking, scene);
    }
    attach_shapes(context, group, first, baking.plugins, scene);
    group.shapes = {};
  }
  baking.degenerate.report(context.diagnostics);
  return {std::move(baking.lit), baking.sort_keys.count()};
}

void place_instances(const BuildContext& context, const Groups& groups, Scene& scene) {
  const auto& instances = context.description().instances;
  // One key each, as nearly all have, so that growing does not double what is the largest part of many a scene.
  scene.instance_keys.reserve(instances.size());
  scene.instances.reserve(instances.size());
  for (size_t g : groups.moving_in(-1)) {
    const Group& group = groups.all[g];
    place(context, group, keyframes(*group.motion), context.description().world_begin, scene);
  }
  for (size_t i = 0; i < instances.size(); ++i) {
    const InstanceDescription& instance = instances[i];
    if (context.description().is_singular(instance.transform)) continue;  // reported
    if (groups.left_out.count(i) > 0) continue;
    const TransformPair motion = context.transform(instance.transform);
    place(context, groups.placed_by(instance), keyframes(motion), instance.where, scene);
    for (size_t g : groups.moving_in(instance.object)) {
      const Group& group = groups.all[g];
      place(context, group, combined(*group.motion, motion), instance.where, scene);
    }
  }
}

}  // namespace whit
