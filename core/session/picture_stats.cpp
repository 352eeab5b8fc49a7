#include "core/session/picture_stats.h"

#include "core/plugin/memory_limit.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

/// The steps' seconds by one of the two clocks.
Json seconds(const StepTimes& t, double Elapsed::*clock) {
  return Json::Object{{"parse", t.parse.*clock},
                      {"plan", t.plan.*clock},
                      {"build", t.build.*clock},
                      {"render", t.render.*clock},
                      {"write", t.write.*clock}};
}

/// Until rendering began, by one of the two clocks: all of it, and its parts.
Json start(const RenderOutcome& outcome, double Elapsed::*clock) {
  Json::Object out{{"ready", outcome.times.ready.*clock}};
  for (const StartPart& part : start_parts(outcome.times, outcome.scene.build_times))
    out.emplace_back(part.key, part.elapsed.*clock);
  return out;
}

Json rays(const RenderStatistics& s) {
  return Json::Object{
      {"camera", s.camera_rays},     {"reflection", s.reflection_rays}, {"refraction", s.refraction_rays},
      {"indirect", s.indirect_rays}, {"passing", s.passing_rays},       {"shadow", s.shadow_rays},
      {"probe", s.probe_rays}};
}

Json textures(const TextureStatistics& t) {
  return Json::Object{{"lookups", t.lookups},
                      {"files", t.files},
                      {"decodes", t.decodes},
                      {"decode_cpu_seconds", t.decode_seconds},
                      {"decoded_bytes", t.decoded_bytes},
                      {"trims", t.trims},
                      {"evictions", t.evictions},
                      {"returns", t.returns},
                      {"peak_bytes", static_cast<int64_t>(t.peak_bytes)}};
}

/// One value by itself, several as an array.
Json values_of(const Parameter& p) {
  Json::Array values;
  for (const double number : p.numbers()) values.emplace_back(number);
  for (const int32_t number : p.integers()) values.emplace_back(number);
  for (const uint8_t truth : p.bools()) values.emplace_back(truth != 0);
  for (const std::string& text : p.strings()) values.emplace_back(text);
  return values.size() == 1 ? values.front() : Json(values);
}

/// What the statement says that the plugin knows.
Json parameters(const Entity& statement, const PluginInfo& plugin) {
  Json::Object out;
  for (const Parameter& p : statement.params) {
    if (!plugin.find_param(p.name)) continue;
    std::erase_if(out, [&](const auto& earlier) { return earlier.first == p.name; });  // The last one counts.
    out.emplace_back(p.name, values_of(p));
  }
  return out;
}

/// All that decides the time, apart from what is in the scene's world.
Json settings_of(const PictureSettings& asked, const RenderOutcome& outcome) {
  const Scene& scene = outcome.scene;
  const SceneDescription& world = *scene.bound.description;
  const PluginInfo &integrator = integrator_in_force(world), &sampler = sampler_in_force(world);
  const Picture& picture = outcome.result.picture;
  const Box2i& window = picture.window;
  Json::Array effects;
  for_effects(scene.plan.needed, [&](Effect e) { effects.emplace_back(effect_name(e)); });
  return Json::Object{{"scene", asked.scene},
                      {"samples_per_pixel", outcome.result.samples_per_pixel},
                      {"footprint_samples", scene.footprint_samples},
                      {"threads", outcome.result.threads},
                      {"integrator", integrator.name},
                      {"integrator_parameters", parameters(world.integrator, integrator)},
                      {"lights", static_cast<int64_t>(scene.lights.size())},
                      {"lights_chosen", scene.chosen_lights > 0 ? Json(scene.chosen_lights) : Json()},
                      {"sampler", sampler.name},
                      {"sampler_parameters", parameters(world.sampler, sampler)},
                      {"resolution", Json::Array{picture.resolution.x, picture.resolution.y}},
                      {"window", Json::Array{window.min.x, window.min.y, window.max.x, window.max.y}},
                      {"traversal", asked.traversal},
                      {"texture_filter", asked.texture_filter.empty() ? Json() : Json(asked.texture_filter)},
                      {"texture_memory_mib", asked.texture_memory},
                      {"effects", effects},
                      {"aovs", outcome.output.aovs},
                      {"outfile", outcome.output.main_file},
                      {"display", outcome.output.display_file},
                      {"command", asked.command},
                      {"version", asked.version}};
}

}  // namespace

std::vector<StartPart> build_parts(const BuildTimes& b) {
  return {{"inputs", "inputs read", b.inputs},
          {"geometry", "geometry read", b.geometry},
          {"materials", "textures and materials prepared", b.materials},
          {"placing", "geometry moved to render space", b.placing},
          {"pictures", "pictures of lights read", b.pictures},
          {"lights", "lights prepared", b.lights},
          {"ray_tracer", "ray tracer built", b.ray_tracer}};
}

std::vector<StartPart> start_parts(const StepTimes& times, const BuildTimes& build) {
  std::vector<StartPart> parts = {{"program", "program loaded", times.program},
                                  {"flags", "flags read", times.flags},
                                  {"parse", "scene parsed", times.parse},
                                  {"plan", "effects planned", times.plan},
                                  {"output", "output planned", times.output}};
  const std::vector<StartPart> built = build_parts(build);
  parts.insert(parts.end(), built.begin(), built.end());
  return parts;
}

Json::Object picture_stats(const PictureSettings& asked, const RenderOutcome& outcome) {
  const RenderStatistics& s = outcome.result.statistics;
  return {{"seconds", seconds(outcome.times, &Elapsed::wall)},
          {"cpu_seconds", seconds(outcome.times, &Elapsed::cpu)},
          {"start",
           Json::Object{{"seconds", start(outcome, &Elapsed::wall)}, {"cpu_seconds", start(outcome, &Elapsed::cpu)}}},
          {"rays", rays(s)},
          {"clear_shadow_rays", s.clear_rays},
          {"textures", textures(outcome.textures.statistics())},
          {"samples", s.camera_samples},
          {"memory_bytes", static_cast<int64_t>(peak_memory())},
          {"memory_peak_bytes", static_cast<int64_t>(peak_memory())},
          {"memory_estimate_bytes", static_cast<int64_t>(outcome.memory_estimate)},
          {"invalid_samples", s.invalid_samples},
          {"settings", settings_of(asked, outcome)},
          {"seed", asked.seed}};
}

}  // namespace whit
