#include "core/scene/effect_plan.h"

#include <optional>
#include <utility>

namespace whit {
namespace {

class Planner {
 public:
  Planner(const BoundScene& scene, const PlanOptions& options) : scene_(scene), description_(*scene.description) {
    plan_.off = plan_.off_by_hand = options.off;
    if (!scene.integrator.plugin) return;
    const EffectSet simulated = scene.integrator.plugin->simulates();
    plan_.off |= EffectSet::all() - simulated;
    shades_ = !(simulated & EffectSet{Effect::Diffuse, Effect::Glossy, Effect::Reflection, Effect::Refraction}).empty();
    plan_.everything_on = options.everything_on;
  }

  EffectPlan run() {
    plan_.object_live.assign(description_.objects.size(), 0);
    plan_.shape_live.assign(description_.shapes.size(), 0);
    plan_.texture_live.assign(description_.textures.size(), 0);
    plan_.light_live.assign(description_.lights.size(), 0);
    plan_.material_live.assign(scene_.materials.size(), 0);
    named_light_.assign(description_.area_lights.size(), 0);
    worn_.assign(scene_.materials.size(), 0);
    place_instances();
    for (size_t i = 0; i < scene_.shapes.size(); ++i) visit_shape(i);
    scatters_ = wants(Effect::Diffuse) || wants(Effect::Glossy);
    visit_integrator();
    for (size_t i = 0; i < scene_.lights.size(); ++i) visit_light(i);
    visit_emitters();
    visit_camera();
    forgo_bounces();
    note_ignored();
    if (plan_.everything_on) plan_.attributes = {true, true};
    plan_.needed = plan_.called_for - plan_.off - forgone_;
    for_effects(plan_.called_for, [&](Effect e) {
      if (plan_.off.has(e)) use(e).why_off = "not of this integrator";
      if (plan_.off_by_hand.has(e)) use(e).why_off = "switched off";
      if (!compiled_in(e)) use(e).why_off = "not in this build";
    });
    return std::move(plan_);
  }

 private:
  EffectUse& use(Effect e) { return plan_.uses[static_cast<size_t>(e)]; }

  void call_for(const EffectSet& effects, SourcePos where, const std::string& what) {
    for_effects(effects, [&](Effect e) {
      if (use(e).count++ < EffectUse::kNamed) use(e).causes.push_back({where, what});
    });
    plan_.called_for |= effects;
  }
  bool is_off(Effect e) const { return plan_.off.has(e); }
  bool wants(Effect e) const { return plan_.called_for.has(e) && !is_off(e); }
  bool animated(int transform) const { return description_.transforms[static_cast<size_t>(transform)].animated(); }
  bool moves(int transform) const { return animated(transform) && !is_off(Effect::MotionBlur); }

  void place_instances() {
    std::vector<uint8_t> placed(description_.objects.size());
    for (const auto& instance : description_.instances) {
      const auto object = static_cast<size_t>(instance.object);
      if (!placed[object]) call_for({Effect::Instancing}, instance.where, description_.objects[object].name);
      placed[object] = 1;
      if (animated(instance.transform)) call_for({Effect::MotionBlur}, instance.where, "moving instance");
    }
    if (!is_off(Effect::Instancing)) plan_.object_live = std::move(placed);
  }

  /// A texture and what it is made of. Those that are evaluated for rays, as alpha, are not filtered.
  void visit_texture(int index, bool filtered) {
    const auto& texture = scene_.textures[static_cast<size_t>(index)];
    uint8_t& live = plan_.texture_live[static_cast<size_t>(index)];
    constexpr uint8_t kSeen = 1, kFiltered = 2;
    const uint8_t now = filtered ? kSeen | kFiltered : kSeen;
    if (!texture.plugin || (live & now) == now || is_folded(*texture.plugin)) return;
    EffectSet effects = texture.plugin->effects() | EffectSet{Effect::Textures};
    if (!filtered) effects.remove(Effect::TextureFiltering);
    if (is_off(Effect::Textures)) effects = {Effect::Textures};
    if (live & kSeen) effects.remove(Effect::Textures);
    call_for(effects, texture.where, description_.textures[static_cast<size_t>(index)].plugin);
    if (is_off(Effect::Textures)) return;
    live |= now;
    plan_.attributes |= texture.plugin->attributes_read();
    for (const TextureUse& t : texture.textures) visit_texture(t.texture, filtered);
  }

  void visit_shape(size_t i) {
    const ShapeDescription& d = description_.shapes[i];
    const auto& shape = scene_.shapes[i];
    if (!shape.plugin || (d.object >= 0 && !plan_.object_live[static_cast<size_t>(d.object)])) return;
    const auto material = static_cast<size_t>(scene_.shape_material[i]);
    const bool passes = scene_.materials[material].plugin && scene_.materials[material].plugin->is_interface();
    if (passes && is_off(Effect::Interfaces)) {
      call_for({Effect::Interfaces}, scene_.materials[material].where, "none");
      return;
    }
    const bool emits = scene_.emission_of(d) && !moves(d.transform);
    // A constant alpha of 0 is a shape that is not there, or that lights unseen.
    const bool unseen = shape.plugin->alpha.is_constant() && shape.plugin->alpha.value() == 0 && !is_off(Effect::Alpha);
    const bool lights = emits && scene_.emission_of(d)->lights() && !is_off(Effect::AreaLights) && d.object < 0;
    if (unseen && !lights) return;
    plan_.shape_live[i] = 1;
    call_for(shape.plugin->effects(), d.where, d.plugin);
    if (shape.plugin->is_cut_out()) call_for({Effect::Alpha}, d.where, d.plugin);
    if (!is_off(Effect::Alpha)) {
      for (const TextureUse& t : shape.textures) visit_texture(t.texture, false);
    }
    if (animated(d.transform)) call_for({Effect::MotionBlur}, d.where, "moving " + d.plugin);
    if (emits) visit_emission(i, lights);
    if (!unseen) visit_worn(scene_.shape_material[i], d.where);
  }

  /// A surface that emits, which none does that moves, as in pbrt-v3. `lights`: it stands in the world, so that it also
  /// lights others.
  void visit_emission(size_t i, bool lights) {
    const ShapeDescription& d = description_.shapes[i];
    const Entity& light = description_.area_lights[static_cast<size_t>(d.area_light)];
    if (!named_light_[static_cast<size_t>(d.area_light)]++) call_for({Effect::AreaLights}, light.where, light.plugin);
    if (!is_off(Effect::AreaLights)) {
      for (const TextureUse& t : scene_.area_lights[static_cast<size_t>(d.area_light)].textures)
        visit_texture(t.texture, true);
    }
    const bool is_curve = dynamic_cast<const CurveShape*>(scene_.shapes[i].plugin.get()) != nullptr;
    // One cause, however many shapes it is on.
    if (lights && !is_curve && (emitters_.empty() || emitters_.back() != &light)) emitters_.push_back(&light);
  }

  /// A material, and a shape that wears it.
  void visit_worn(int index, SourcePos shape) {
    const auto m = static_cast<size_t>(index);
    const auto& material = scene_.materials[m];
    if (worn_[m]) return;
    worn_[m] = 1;
    // Where a statement is wrong and --keep-going goes on, the default material is shown.
    if (!material.plugin && m > 0) visit_worn(0, shape);
    visit_material(index, shape);
    if (material.plugin && material.plugin->scatters_below() && !body_) body_ = m == 0 ? shape : material.where;
    // Normals of a surface without lobes are never asked for.
    if (!material.plugin || material.plugin->effects().empty()) return;
    const SourcePos where = m == 0 ? shape : material.where;
    const auto tilts = [&](const Plugin* map, const char* what) {
      call_for({Effect::Bump}, where, what);
      if (map && !is_off(Effect::Bump)) visit_bump(m, map);
    };
    if (!material.plugin->bump.is_constant()) tilts(material.plugin->bump.texture().get(), "bumpmap");
    if (material.plugin->has_normal_map()) tilts(material.plugin->normalmap.texture().get(), "normalmap");
  }

  /// A bump or normal map of a worn material, which a mix has of its first member: that of no other member is seen.
  void visit_bump(size_t m, const Plugin* map) {
    const auto& material = scene_.materials[m];
    for (const TextureUse& t : material.textures) {
      if (scene_.textures[static_cast<size_t>(t.texture)].plugin.get() == map) visit_texture(t.texture, true);
    }
    for (const int member : material.materials) visit_bump(static_cast<size_t>(member), map);
  }

  /// The lobes of a material that is worn or part of one.
  void visit_material(int index, SourcePos shape) {
    const auto m = static_cast<size_t>(index);
    if (plan_.material_live[m]) return;
    if (!shades_) return;
    plan_.material_live[m] = 1;
    const auto& material = scene_.materials[m];
    if (!material.plugin) return;
    // pbrt's default material is no statement, and what shapes override has the place of the one they wear.
    const SourcePos where = m == 0 ? shape : material.where;
    const std::string what = m == 0                              ? "the default material"
                             : m < description_.materials.size() ? description_.materials[m].plugin
                                                                 : "a material with overrides";
    call_for(material.plugin->effects(), where, what);
    for (const TextureUse& t : material.textures) {
      if (t.parameter != "bumpmap" && t.parameter != "normalmap") visit_texture(t.texture, true);
    }
    for (const int member : material.materials) visit_material(member, shape);
  }

  /// Lights at infinity are also seen. All others are there for surfaces that scatter.
  void visit_light(size_t i) {
    const auto& light = scene_.lights[i];
    if (!light.plugin || light.plugin->is_black()) return;
    const std::string& name = description_.lights[i].plugin;
    call_for(light.plugin->effects(), light.where, name);
    if (!(light.plugin->effects() - plan_.off).empty() && (scatters_ || light.plugin->is_environment())) {
      plan_.light_live[i] = 1;
      if (scatters_) light_up(light.where, name);
    }
  }

  void visit_emitters() {
    for (const Entity* light : emitters_) {
      if (scatters_) light_up(light->where, light->plugin);
    }
    if (!scatters_) forgo(Effect::DeltaLights, "no surface scatters their light");
  }

  void light_up(SourcePos where, const std::string& what) {
    plan_.direct_light = true;
    call_for({Effect::Shadows}, where, what);
  }

  void visit_integrator() {
    const auto& integrator = scene_.integrator;
    if (!integrator.plugin) return;
    call_for(integrator.plugin->effects(), integrator.where, description_.integrator.plugin);
    if (!scatters_) forgo(Effect::Indirect, "no surface scatters light");
  }

  void visit_camera() {
    if (!scene_.camera.plugin) return;
    call_for(scene_.camera.plugin->effects(), scene_.camera.where, "camera");
    if (animated(description_.camera_transform)) call_for({Effect::MotionBlur}, scene_.camera.where, "moving camera");
  }

  void forgo(Effect e, const std::string& why) {
    forgone_.add(e);
    if (plan_.called_for.has(e)) use(e).why_off = why;
  }

  /// At a maxdepth of 1 nothing is seen in mirrors.
  void forgo_bounces() {
    if (!scene_.integrator.plugin || scene_.integrator.plugin->max_depth() > 1) return;
    for (const Effect e : {Effect::Reflection, Effect::Refraction}) forgo(e, "\"maxdepth\" allows no bounce");
  }

  void note_ignored() {
    const SceneDescription& d = description_;
    if (d.has_media()) plan_.ignored.push_back({"participating media", d.first_medium()});
    const bool follows_paths = scene_.integrator.plugin && scene_.integrator.plugin->simulates().has(Effect::Indirect);
    if (body_ && follows_paths) {
      plan_.ignored.push_back({"scattering below surfaces", *body_, "the surface alone is shown"});
    }
    if (scene_.integrator.replaced) {
      plan_.ignored.push_back({"integrator \"" + d.integrator.plugin + '"', d.integrator.where});
    }
  }

  const BoundScene& scene_;
  const SceneDescription& description_;
  EffectPlan plan_;
  EffectSet forgone_;  ///< Called for, but without consequence.
  std::vector<const Entity*> emitters_;
  std::vector<int> named_light_;   ///< Whether an area light has called for the effect.
  std::vector<uint8_t> worn_;      ///< Materials that a shape wears, not only a mix.
  std::optional<SourcePos> body_;  ///< The first material that scatters below its surface.
  bool scatters_ = false;
  bool shades_ = true;  ///< The integrator asks for lobes.
};

}  // namespace

EffectPlan plan_effects(const BoundScene& scene, const PlanOptions& options) { return Planner(scene, options).run(); }

}  // namespace whit
