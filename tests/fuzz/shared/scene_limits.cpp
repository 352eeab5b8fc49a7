#include "tests/fuzz/shared/scene_limits.h"

#include <algorithm>
#include <variant>

namespace whit::fuzz {
namespace {

void clamp_integers(Entity& entity, int32_t most) {
  for (Parameter& p : entity.params) {
    if (auto* const values = std::get_if<std::vector<int32_t>>(&p.values))
      for (int32_t& v : *values) v = std::min(v, most);
  }
}

void set_integer(Entity& entity, const char* name, int32_t value) {
  Parameter p;
  p.type = ParamType::Integer, p.name = name, p.values = std::vector<int32_t>{value};
  std::erase_if(entity.params, [&](const Parameter& other) { return other.name == name; });
  entity.params.push_back(std::move(p));
}

void clamp_numbers(Entity& entity, const char* name, double most) {
  for (Parameter& p : entity.params) {
    auto* const values = std::get_if<std::vector<double>>(&p.values);
    if (values && p.name == name)
      for (double& v : *values) v = std::min(v, most);
  }
}

}  // namespace

void limit(SceneDescription& world) {
  constexpr int32_t kMost = 8;
  // Where there is no statement the film is the default one, which has no parameters.
  if (world.film.plugin.empty()) world.film.plugin = "image";
  set_integer(world.film, "xresolution", 4), set_integer(world.film, "yresolution", 4);
  // A tile's memory and time grow with the square of the filter's width.
  clamp_numbers(world.filter, "xwidth", kMost), clamp_numbers(world.filter, "ywidth", kMost);
  clamp_integers(world.sampler, kMost), clamp_integers(world.integrator, kMost);
  for (LightDescription& light : world.lights) clamp_integers(light, kMost);
  for (Entity& light : world.area_lights) clamp_integers(light, kMost);
}

}  // namespace whit::fuzz
