// Building: the only bridge from what a scene file says to live objects. Here is the order of the steps, and what is
// neither geometry (build_groups.h, build_geometry.h) nor light (build_lights.h).

#include <algorithm>
#include <new>

#include "core/plugin/memory_limit.h"
#include "core/scene/build_context.h"
#include "core/scene/build_geometry.h"
#include "core/scene/build_groups.h"
#include "core/scene/build_lights.h"
#include "core/scene/kept_geometry.h"
#include "core/scene/motion.h"
#include "core/scene/read.h"

namespace whit {
namespace {

bool options_complete(const BoundScene& b) {
  return b.camera.plugin && b.film.plugin && b.filter.plugin && b.sampler.plugin && b.integrator.plugin;
}

/// Frees the plugins of statements that the picture does not need. They were made to check their parameters.
void drop_unneeded(const EffectPlan& plan, BoundScene& bound) {
  const auto drop = [](auto& all, const std::vector<uint8_t>& live) {
    for (size_t i = 0; i < all.size(); ++i) {
      if (!live[i]) all[i].plugin.reset();
    }
  };
  drop(bound.shapes, plan.shape_live);
  drop(bound.textures, plan.texture_live);
  drop(bound.lights, plan.light_live);
  for (size_t i = 1; i < bound.materials.size(); ++i) {  // The first stands in for what is wrong.
    if (!plan.material_live[i]) bound.materials[i].plugin.reset();
  }
}

void prepare_sampling(const BuildContext& context, const BuildOptions& options, Scene& scene) {
  Sampler& sampler = *scene.bound.sampler.plugin;
  sampler.seed = options.seed;
  scene.footprint_samples = options.footprint_samples > 0 ? options.footprint_samples : sampler.samples_per_pixel();
  if (options.quick) {
    sampler.set_samples_per_pixel(1);
  } else if (options.samples_per_pixel > 0) {
    sampler.set_samples_per_pixel(options.samples_per_pixel);
  }
  scene.samples_per_pixel = sampler.samples_per_pixel();
  context.prepare(scene.bound.sampler);
  context.prepare(scene.bound.filter);
  context.prepare(scene.bound.film);
  context.prepare(scene.bound.integrator);
  for (auto& light : scene.bound.area_lights) context.prepare(light);
  scene.time_start = context.description().time_start;
  scene.time_end = context.description().time_end;
}

void prepare_materials(const BuildContext& context, Scene& scene) {
  BoundScene& bound = scene.bound;
  std::vector<uint8_t> failed(bound.textures.size());
  context.for_each(bound.textures.size(), [&](size_t i, Diagnostics& reports) {
    if (!bound.textures[i].plugin || !scene.plan.texture_live[i]) return;
    context.prepare(bound.textures[i], reports);
    failed[i] = !bound.textures[i].plugin;
  });
  for (size_t i = 0; i < bound.materials.size(); ++i) {
    if (scene.plan.material_live[i]) context.prepare(bound.materials[i]);
  }
  drop_users(bound, failed);
  for (auto& material : bound.materials) {
    // Nobody wears it. Or it is not usable, which has been reported; --keep-going shows the default material.
    if (!material.plugin) material.plugin = bound.materials[0].plugin;
    scene.materials.push_back(material.plugin.get());
  }
}

void prepare_camera(const BuildContext& context, bool quick, Scene& scene) {
  Camera& camera = *scene.bound.camera.plugin;
  camera.film = {scene.film().resolution(), scene.film().diagonal_metres()};
  if (quick) {
    camera.film.resolution.x = std::max(1, camera.film.resolution.x / 4);
    camera.film.resolution.y = std::max(1, camera.film.resolution.y / 4);
  }
  context.prepare(scene.bound.camera);
  if (!scene.bound.camera.plugin) return;
  const TransformPair world_to_camera = context.transform(context.description().camera_transform);
  const TransformPair camera_to_world{world_to_camera.start.inverse(), world_to_camera.end.inverse()};
  for (const Mat4d& key : keyframes(camera_to_world)) scene.camera_keys.push_back(key * scene.space.from_world());
}

/// What touches lights is found by asking what was built, and needs another build only where something does.
void build_accel(const BuildContext& context, Scene& scene) {
  std::string problem;
  try {
    problem = scene.accel->build();
    if (problem.empty()) {
      scene.any_touched = find_light_ends(context, scene.lights);
      if (scene.any_touched) problem = scene.accel->watch_ends();
    }
    if (problem.empty()) return;
    context.diagnostics.error(context.description().world_begin, problem);
  } catch (const std::bad_alloc&) {
    context.diagnostics.add(limit_error(context.description().world_begin,
                                        "not enough memory for the ray tracer's trees",
                                        "fewer triangles or curves take less"));
  }
  // Which mesh it was is not known.
  if (context.kept) context.kept->clear();
}

}  // namespace

std::unique_ptr<Scene> build_scene(BoundScene bound, EffectPlan plan, const BuildOptions& options,
                                   TextureStore& textures, Diagnostics& diagnostics) {
  if (!options_complete(bound)) return nullptr;
  Laps laps;
  read_live(bound, plan, diagnostics);
  drop_unneeded(plan, bound);
  auto scene = std::make_unique<Scene>();
  BuildTimes& times = scene->build_times;
  scene->bound = std::move(bound);
  scene->plan = std::move(plan);
  const bool everything = scene->plan.everything_on;
  scene->skip_lights = !everything;
  BuildContext context{*scene, textures, diagnostics, options.kept, options.robust_traversal};
  if (options.kept) {
    options.kept->begin();
    context.placed.resize(context.description().objects.size());
    for (const InstanceDescription& instance : context.description().instances)
      ++context.placed[static_cast<size_t>(instance.object)];
  }
  prepare_sampling(context, options, *scene);
  if (!options_complete(scene->bound)) return nullptr;
  scene->accel = std::make_unique<Accel>(AccelOptions{.robust = options.robust_traversal,
                                                      .second_look = scene->sampler().is_regular(),
                                                      .device = options.kept ? options.kept->device() : nullptr});
  times.inputs = laps.lap();
  Groups groups = load_groups(context, scene->bound.shapes);
  times.geometry = laps.lap();
  const WorldSpace world = choose_spaces(context, groups);
  scene->space = world.space;
  context.scene_radius = world.radius;
  prepare_materials(context, *scene);
  times.materials = laps.lap();
  const BakedGeometry geometry = bake_groups(context, groups, *scene);
  place_instances(context, groups, *scene);
  times.placing = laps.lap();
  context.reading_pictures = &times.pictures;
  build_lights(context, geometry.lit, *scene);
  prepare_camera(context, options.quick, *scene);
  if (!options_complete(scene->bound)) return nullptr;
  times.lights = laps.lap() - times.pictures;
  if (!options.only_check) build_accel(context, *scene);
  times.ray_tracer = laps.lap();
  scene->sort_keys = std::max(geometry.sort_keys, everything ? 2 : 0);
  if (everything) scene->attributes = {true, true};
  scene->has_instances = kKnowsInstances && (!scene->instances.empty() || everything);
  if (diagnostics.has_errors() && !options.keep_going) return nullptr;
  return scene;
}

}  // namespace whit
