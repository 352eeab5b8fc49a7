#include "core/scene/build_lights.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/scene/emission_map.h"
#include "core/scene/light_end.h"

namespace whit {
namespace {

void add_light(Scene& scene, SceneLight entry) {
  if (!entry.light->is_delta()) {
    entry.dimension = scene.light_dimensions;
    scene.light_dimensions += 2;
  }
  entry.reach = entry.light->reach();
  entry.samples = entry.light->sample_count();
  scene.lights.push_back(entry);
}

/// Whether a light is at a place that cannot be calculated with; says so.
bool is_too_far(const BuildContext& context, const Bound<Light>& light) {
  // Squares of distances up to here are within the range of floats.
  constexpr double kFarthestLight = 1e18;
  const std::optional<Vec3d> position = light.plugin->position();
  if (!position || position->length() < kFarthestLight) return false;
  context.diagnostics.warning(
      light.where, fmt::format("this light is {:.3g} units away", position->length() / context.scene.space.scale),
      "left out: floats cannot hold the square of that beside the rest of the scene");
  return true;
}

/// Those of a surface whose emission has a map: where that is black nothing is sampled, as on nearly all triangles of many
/// a model.
void add_mapped_emitters(Scene& scene, const LitShape& lit) {
  SceneShape& shape = scene.shapes[static_cast<size_t>(lit.index)];
  const std::vector<RGB> means = emission_means(shape, *lit.emission.map);
  scene.emitters.push_back(make_seen_emitter(shape, lit.emission));
  std::vector<int32_t> numbers(means.size(), -1);
  for (size_t t = 0; t < means.size(); ++t) {
    if (is_black(means[t])) continue;
    if (shape.first_light < 0) shape.first_light = static_cast<int>(scene.lights.size());
    numbers[t] = static_cast<int32_t>(scene.lights.size());
    Emission emission = lit.emission;
    emission.mean = means[t];
    const auto prim = static_cast<uint32_t>(t);
    scene.emitters.push_back(make_emitter(shape, prim, emission));
    add_light(scene, {.light = scene.emitters.back().get(), .shape = lit.index, .prim = prim});
  }
  if (shape.first_light < 0) return;
  shape.light_of_prim =
      scene.lights_of_prims.emplace_back(std::make_unique<const std::vector<int32_t>>(std::move(numbers))).get();
}

/// As in pbrt, each triangle of an emitting mesh is a light of its own.
void add_emitters(Scene& scene, const LitShape& lit) {
  SceneShape& shape = scene.shapes[static_cast<size_t>(lit.index)];
  shape.emitter = static_cast<int>(scene.emitters.size());
  const bool sampled = lit.in_world && lit.sampled && scene.plan.direct_light && !shape.curves;
  scene.has_emission_maps |= lit.emission.map != nullptr;
  if (lit.emission.map && sampled) return add_mapped_emitters(scene, lit);
  if (sampled) shape.first_light = static_cast<int>(scene.lights.size());
  const size_t count = sampled && shape.mesh ? shape.mesh->triangle_count() : 1;
  for (size_t t = 0; t < count; ++t) {
    const auto prim = static_cast<uint32_t>(t);
    scene.emitters.push_back(make_emitter(shape, prim, lit.emission));
    if (sampled) add_light(scene, {.light = scene.emitters.back().get(), .shape = lit.index, .prim = prim});
  }
}

/// Where the integrator wants some lights chosen for each point, what chooses them: unless it can have them all for that.
void choose_some(const BuildContext& context, Scene& scene) {
  const std::optional<LightStrategy> strategy = scene.integrator().light_strategy();
  const int wanted = scene.integrator().light_choices();
  if (!strategy || scene.lights.empty()) return;
  if (wanted > 1 && scene.lights.size() <= static_cast<size_t>(wanted)) return;
  scene.light_choice = make_light_choice(scene.lights, *strategy, context.scene_radius);
  scene.chosen_lights = wanted;
  // Which ones, and a point of each.
  scene.light_dimensions = 3;
}

}  // namespace

std::optional<Emission> emission_of(const BuildContext& context, const ShapeDescription& description, bool is_curve,
                                    bool is_moving) {
  if (is_moving && description.area_light >= 0) {
    context.diagnostics.warning(description.where, "a moving shape cannot be an area light",
                                "it is shown without emission, as in pbrt");
  }
  const AreaLight* light = context.scene.bound.emission_of(description);
  if (is_moving || !light || !context.scene.plan.needed.has(Effect::AreaLights)) return {};
  if (is_curve) {
    context.diagnostics.warning(description.where, "a curve cannot light other surfaces",
                                "it glows; paths alone may meet it by chance");
  }
  // A curve always faces the ray, so it has no back that could be dark.
  Emission emission;
  emission.radiance = light->radiance();
  emission.map = light->map();
  emission.two_sided = light->two_sided() || is_curve;
  emission.samples = light->sample_count();
  emission.group = &light->group;
  return emission;
}

void build_lights(const BuildContext& context, std::span<const LitShape> lit, Scene& scene) {
  for (size_t i = 0; i < scene.bound.lights.size(); ++i) {
    auto& light = scene.bound.lights[i];
    if (!scene.plan.light_live[i]) continue;
    context.prepare(light);
    if (!light.plugin || is_too_far(context, light)) continue;
    const int number = scene.plan.direct_light ? static_cast<int>(scene.lights.size()) : -1;
    if (number >= 0) add_light(scene, {.light = light.plugin.get()});
    if (light.plugin->is_environment()) scene.environments.push_back({light.plugin.get(), number});
  }
  for (const LitShape& shape : lit) add_emitters(scene, shape);
  choose_some(context, scene);
}

bool find_light_ends(const BuildContext& context, std::vector<SceneLight>& lights) {
  context.for_each(lights.size(), [&](size_t i, Diagnostics&) { lights[i].end = end_of(context.scene, lights[i]); });
  return std::any_of(lights.begin(), lights.end(), [](const SceneLight& l) { return l.end.touched(); });
}

}  // namespace whit
