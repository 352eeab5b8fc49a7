#include "core/scene/effect_plan.h"

namespace whit {
namespace {

class Planner {
 public:
  explicit Planner(const BoundScene& scene) : scene_(scene), description_(*scene.description) {}

  EffectPlan run() {
    plan_.object_live.assign(description_.objects.size(), 0);
    plan_.shape_live.assign(description_.shapes.size(), 0);
    plan_.texture_live.assign(description_.textures.size(), 0);
    plan_.light_live.assign(description_.lights.size(), 0);
    plan_.material_live.assign(scene_.materials.size(), 0);
    place_instances();
    for (size_t i = 0; i < scene_.shapes.size(); ++i) visit_shape(i);
    for (size_t i = 0; i < scene_.lights.size(); ++i) visit_light(i);
    visit_camera();
    if (!description_.media.empty() || !description_.media_uses.empty()) {
      plan_.ignored.push_back("participating media");
    }
    plan_.needs_differentials = plan_.live(Effect::TextureFiltering) || plan_.live(Effect::Bump);
    plan_.needs_time = plan_.live(Effect::MotionBlur);
    plan_.needs_lens = plan_.live(Effect::DepthOfField);
    return std::move(plan_);
  }

 private:
  void call_for(EffectSet effects, SourcePos where, const std::string& what) {
    for (unsigned e = 0; e < static_cast<unsigned>(Effect::kCount); ++e) {
      const auto effect = static_cast<Effect>(e);
      if (effects.has(effect)) plan_.causes.push_back({effect, where, what});
    }
    plan_.effects |= effects;
  }
  bool animated(int transform) const { return description_.transforms[static_cast<size_t>(transform)].animated(); }

  void place_instances() {
    for (const auto& instance : description_.instances) {
      const auto object = static_cast<size_t>(instance.object);
      if (!plan_.object_live[object]) call_for({Effect::Instancing}, instance.where, description_.objects[object].name);
      plan_.object_live[object] = 1;
      if (animated(instance.transform)) call_for({Effect::MotionBlur}, instance.where, "moving instance");
    }
  }

  void visit_textures(const std::vector<int>& textures) {
    for (int t : textures) {
      const auto i = static_cast<size_t>(t);
      if (plan_.texture_live[i]) continue;
      plan_.texture_live[i] = 1;
      visit_textures(scene_.textures[i].textures);
      if (scene_.textures[i].plugin) {
        call_for(scene_.textures[i].plugin->effects(), scene_.textures[i].where, description_.textures[i].plugin);
      }
    }
  }

  void visit_shape(size_t i) {
    const ShapeDescription& d = description_.shapes[i];
    const auto& shape = scene_.shapes[i];
    if (!shape.plugin || (d.object >= 0 && !plan_.object_live[static_cast<size_t>(d.object)])) return;
    const bool emits = d.area_light >= 0 && scene_.area_lights[static_cast<size_t>(d.area_light)].plugin;
    // A constant alpha of 0 is a shape that is not there, or that lights unseen.
    const bool unseen = shape.plugin->alpha.is_constant() && shape.plugin->alpha.value() == 0;
    if (unseen && !(emits && d.object < 0 && !animated(d.transform))) return;
    plan_.shape_live[i] = 1;
    call_for(shape.plugin->effects(), d.where, d.plugin);
    const bool cut = unseen || !shape.plugin->alpha.is_constant() || !shape.plugin->shadow_alpha.is_constant() ||
                     shape.plugin->shadow_alpha.value() == 0;
    if (cut) call_for({Effect::AlphaMask}, d.where, d.plugin);
    visit_textures(shape.textures);
    if (animated(d.transform)) call_for({Effect::MotionBlur}, d.where, "moving " + d.plugin);
    if (emits) {
      call_for({Effect::AreaLight}, description_.area_lights[static_cast<size_t>(d.area_light)].where,
               description_.area_lights[static_cast<size_t>(d.area_light)].plugin);
    }
    if (!unseen) visit_material(scene_.shape_material[i]);
  }

  void visit_material(int index) {
    const auto m = static_cast<size_t>(index);
    if (plan_.material_live[m]) return;
    plan_.material_live[m] = 1;
    const auto& material = scene_.materials[m];
    if (!material.plugin) return;
    call_for(material.plugin->effects(), material.where, "material");
    visit_textures(material.textures);
    if (!material.plugin->bump.is_constant()) call_for({Effect::Bump}, material.where, "bumpmap");
    for (const int member : material.materials) visit_material(member);
  }

  void visit_light(size_t i) {
    const auto& light = scene_.lights[i];
    if (!light.plugin || light.plugin->is_black()) return;
    plan_.light_live[i] = 1;
    call_for(light.plugin->effects(), light.where, description_.lights[i].plugin);
  }

  void visit_camera() {
    if (!scene_.camera.plugin) return;
    call_for(scene_.camera.plugin->effects(), scene_.camera.where, "camera");
    if (scene_.camera.plugin->needs_lens()) call_for({Effect::DepthOfField}, scene_.camera.where, "lens");
    if (animated(description_.camera_transform)) call_for({Effect::MotionBlur}, scene_.camera.where, "moving camera");
  }

  const BoundScene& scene_;
  const SceneDescription& description_;
  EffectPlan plan_;
};

}  // namespace

EffectPlan plan_effects(const BoundScene& scene) { return Planner(scene).run(); }

}  // namespace whit
