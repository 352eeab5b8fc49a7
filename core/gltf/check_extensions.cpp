// The version of a file, and the extensions that it uses or requires.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/gltf/check_parts.h"

namespace whit::gltf {
namespace {

constexpr const char* kRead[] = {"KHR_texture_transform",
                                 "KHR_materials_ior",
                                 "KHR_materials_transmission",
                                 "KHR_materials_volume",
                                 "KHR_materials_specular",
                                 "KHR_materials_clearcoat",
                                 "KHR_materials_sheen",
                                 "KHR_materials_anisotropy",
                                 "KHR_materials_unlit",
                                 "KHR_materials_variants",
                                 "KHR_materials_emissive_strength",
                                 "KHR_lights_punctual",
                                 "KHR_mesh_quantization",
                                 "EXT_mesh_gpu_instancing",
                                 "EXT_texture_webp",
                                 "EXT_meshopt_compression",
                                 "KHR_draco_mesh_compression"};

bool is_read(const std::string& name) { return std::find(std::begin(kRead), std::end(kRead), name) != std::end(kRead); }

/// "2.0" as 2 and 0.
std::optional<std::pair<int, int>> version_of(const std::string& text) {
  int major = 0, minor = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%3d.%3d%c", &major, &minor, &rest) != 2 || major < 0 || minor < 0) return std::nullopt;
  return std::pair{major, minor};
}

bool check_asset(const Item& asset) {
  // Old files write 1 for "1.0".
  if (asset.has("version") && asset.value()["version"].is_number()) {
    asset.value()["version"] = fmt::format("{:.1f}", asset.value()["version"].get<double>());
  }
  const auto text = asset.text("version", Item::Need::Required);
  if (!text) return false;
  const auto version = version_of(*text);
  if (!version)
    return asset.error_at("version", fmt::format("must be a version like \"2.0\", and is {}", shown_text(*text))),
           false;
  if (version->first != 2) {
    asset.error_at("version",
                   fmt::format("is {}: glTF {}.{} is not read", shown_text(*text), version->first, version->second),
                   "re-export as glTF 2.0");
    return false;
  }
  const auto least = asset.text("minVersion");
  if (!least) return !asset.has("minVersion");
  const auto needed = version_of(*least);
  if (needed && *needed <= std::pair{2, 0}) return true;
  asset.error_at("minVersion", fmt::format("is {}, and glTF 2.0 is read", shown_text(*least)), "re-export as glTF 2.0");
  return false;
}

std::string why_unread(const std::string& name) {
  if (name == "KHR_texture_basisu") return "pictures in it cannot be decoded";
  if (name == "KHR_materials_pbrSpecularGlossiness") return "its materials are taken as metallic-roughness";
  return "what it says is left out";
}

}  // namespace

bool check_version(const Item& root) {
  bool right = false;
  if (!root.has("asset")) root.error_at("asset", "is missing", "it is no glTF 2.0: re-export as that");
  root.object("asset", [&](const Item& asset) { right = check_asset(asset); });
  return right;
}

void check_extensions(const Item& root) {
  std::set<std::string> used, required;
  const auto read = [&](const char* key, std::set<std::string>& names) {
    root.elements(key, [&](const Item& element, size_t) {
      if (!element.value().is_string()) return element.error("must be a string");
      const std::string& name = element.value().get_ref<const std::string&>();
      if (!names.insert(name).second) {
        root.problems().excused(element.place(), fmt::format("{} is there twice", shown_text(name)), "once would do");
        return;
      }
      if (&names == &required && !is_read(name)) {
        element.error(fmt::format("the file requires the extension {}, which is not read", shown_text(name)),
                      "re-export without " + shown_text(name));
      }
    });
  };
  read("extensionsRequired", required);
  read("extensionsUsed", used);
  for (const std::string& name : used) {
    if (is_read(name) || required.contains(name)) continue;
    root.problems().warning("/extensionsUsed", fmt::format("the extension {} is not read", shown_text(name)),
                            why_unread(name));
  }
  for (const std::string& name : required) {
    if (used.contains(name) || !is_read(name)) continue;
    root.problems().excused("/extensionsRequired",
                            fmt::format("names {}, which is not under \"extensionsUsed\"", shown_text(name)),
                            "it is read all the same");
  }
}

}  // namespace whit::gltf
