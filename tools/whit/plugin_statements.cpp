#include "tools/whit/plugin_statements.h"

#include <utility>

namespace whit {
namespace {

constexpr PluginStatement kRows[] = {
    {"area light", "AreaLightSource", "AreaLightSource"},
    {"camera", "Camera", "Camera"},
    {"film", "Film", "Film"},
    {"filter", "PixelFilter", "PixelFilter"},
    {"float texture", "Texture", "Texture \"name\" \"float\""},
    {"integrator", "Integrator", "Integrator"},
    {"light", "LightSource", "LightSource"},
    {"material", "Material", "Material"},
    {"sampler", "Sampler", "Sampler"},
    {"shape", "Shape", "Shape"},
    {"spectrum texture", "Texture", "Texture \"name\" \"spectrum\""},
};

/// Further statements whose plugins, by name or in "string type", are those of another one.
constexpr std::pair<std::string_view, std::string_view> kOtherNames[] = {{"Filter", "PixelFilter"},
                                                                         {"MakeNamedMaterial", "Material"}};

}  // namespace

std::span<const PluginStatement> plugin_statements() { return kRows; }

const PluginStatement* statement_of(std::string_view category) {
  for (const PluginStatement& row : kRows)
    if (row.category == category) return &row;
  return nullptr;
}

std::vector<const char*> categories_of(std::string_view statement) {
  for (const auto& [name, other] : kOtherNames)
    if (name == statement) statement = other;
  std::vector<const char*> categories;
  for (const PluginStatement& row : kRows)
    if (row.statement == statement) categories.push_back(row.category);
  return categories;
}

}  // namespace whit
