#include "core/scene/problems.h"

#include "core/plugin/registry.h"

namespace whit {
namespace {

/// Which statements the picture needs or would need, were they usable: what the plan keeps, and what is wrong and within
/// its reach.
class Needed {
 public:
  Needed(const BoundScene& scene, const EffectPlan& plan)
      : scene_(scene),
        plan_(plan),
        description_(*scene.description),
        area_lights_(scene.area_lights.size()),
        materials_(scene.materials.size()),
        textures_(scene.textures.size()),
        singular_(description_.singular.size()) {
    for (size_t i = 0; i < scene.shapes.size(); ++i) {
      if (has_shape(i)) need_parts_of_shape(i);
    }
    for (size_t i = 0; i < scene.lights.size(); ++i) {
      if (has_light(i)) need_transform(description_.lights[i].transform);
    }
    for (const InstanceDescription& instance : description_.instances) {
      if (plan_.object_live[static_cast<size_t>(instance.object)]) need_transform(instance.transform);
    }
  }

  bool has(const Problem& p) const {
    switch (p.of) {
      case Problem::Of::Texture: return textures_[p.index];
      case Problem::Of::Material: return materials_[p.index];
      case Problem::Of::AreaLight: return area_lights_[p.index];
      case Problem::Of::Shape: return has_shape(p.index);
      case Problem::Of::Transform: return singular_[p.index];
      case Problem::Of::Light: return has_light(p.index);
      case Problem::Of::Options: break;
    }
    return true;
  }

 private:
  bool has_shape(size_t i) const {
    const int object = description_.shapes[i].object;
    const bool placed = object < 0 || plan_.object_live[static_cast<size_t>(object)];
    return placed && (plan_.shape_live[i] || !scene_.shapes[i].plugin);
  }

  /// By its kind, for what is wrong with it is not known to matter. As the planner: lights at infinity are also seen.
  bool has_light(size_t i) const {
    if (scene_.lights[i].plugin) return plan_.light_live[i] != 0;
    const PluginInfo* info = find_plugin(Light::kCategory, description_.lights[i].plugin);
    const EffectSet effects = info ? info->make()->effects() - plan_.off : EffectSet{};
    const EffectSet scatters = (plan_.called_for & EffectSet{Effect::Diffuse, Effect::Glossy}) - plan_.off;
    return effects.has(Effect::EnvironmentLights) || !(effects.empty() || scatters.empty());
  }

  void need_parts_of_shape(size_t i) {
    const ShapeDescription& d = description_.shapes[i];
    if (d.area_light >= 0) {
      area_lights_[static_cast<size_t>(d.area_light)] = true;
      need_textures(scene_.area_lights[static_cast<size_t>(d.area_light)].textures);
    }
    need_transform(d.transform);
    need_textures(scene_.shapes[i].textures);
    const auto worn = static_cast<size_t>(scene_.shape_material[i]);
    need_material(worn);
    // One with the shape's parameters is unusable for a reason that has been said of the material's own statement.
    if (!scene_.materials[worn].plugin) need_material(static_cast<size_t>(d.material));
  }

  void need_transform(int transform) {
    const auto found = description_.singular_transforms.find(transform);
    if (found != description_.singular_transforms.end()) singular_[static_cast<size_t>(found->second)] = true;
  }

  void need_material(size_t m) {
    if (materials_[m]) return;
    materials_[m] = true;
    need_textures(scene_.materials[m].textures);
    for (const int member : scene_.materials[m].materials) need_material(static_cast<size_t>(member));
  }

  void need_textures(const std::vector<TextureUse>& uses) {
    for (const TextureUse& use : uses) {
      const auto t = static_cast<size_t>(use.texture);
      if (textures_[t]) continue;
      textures_[t] = true;
      need_textures(scene_.textures[t].textures);
    }
  }

  const BoundScene& scene_;
  const EffectPlan& plan_;
  const SceneDescription& description_;
  std::vector<bool> area_lights_, materials_, textures_, singular_;
};

}  // namespace

Diagnostics weigh_problems(const BoundScene& scene, const EffectPlan& plan) {
  Diagnostics all;
  if (scene.problems.empty()) return all;  // As nearly always: nobody needs to know what a million shapes depend on.
  const Needed needed(scene, plan);
  for (const Problem& p : scene.problems) {
    Diagnostic d = p.diagnostic;
    if (d.severity == Severity::Error && (p.unread || !needed.has(p))) {
      d.severity = Severity::Warning;
      d.excused = true;
      if (!d.remedy.empty()) d.remedy += '\n';
      d.remedy += "nothing that is seen depends on it: the picture is made without";
    }
    all.add(std::move(d));
  }
  return all;
}

Diagnostics find_surprises(const SceneDescription& description, const EffectPlan& plan) {
  Diagnostics all;
  if (description.has_media()) {
    all.warning(description.first_medium(), "participating media are not simulated", "the picture is made without",
                "not-simulated");
  }
  for (const Ignored& ignored : plan.ignored) {
    if (!ignored.instead.empty())
      all.warning(ignored.where, ignored.what + " is not simulated", ignored.instead, "not-simulated");
  }
  const EffectSet lights{Effect::AreaLights, Effect::EnvironmentLights, Effect::DeltaLights};
  // An integrator that knows of no lights does without.
  const bool lit_otherwise = (lights - (plan.off - plan.off_by_hand)).empty();
  if ((plan.called_for & lights).empty() && !lit_otherwise) {
    all.warning(description.world_begin, "the scene has no lights, so the picture is black",
                "add a LightSource, or an AreaLightSource before a shape that stands in the world", "no-lights");
  }
  return all;
}

}  // namespace whit
