#include "core/scene/left_out.h"

#include <filesystem>

#include "core/plugin/registry.h"

namespace whit {
namespace {

class Finder {
 public:
  Finder(const BoundScene& scene, const EffectPlan& plan)
      : scene_(scene), plan_(plan), description_(*scene.description) {}

  std::vector<LeftOut> run() {
    for (size_t i = 0; i < description_.textures.size(); ++i) {
      if (!plan_.texture_live[i]) add_texture(i);
    }
    const std::vector<bool> worn = find_worn();
    for (size_t i = 1; i < description_.materials.size(); ++i) {  // The first is pbrt's default, not a statement.
      if (!plan_.material_live[i]) add_material(i, worn[i]);
    }
    for (size_t i = 0; i < description_.lights.size(); ++i) {
      if (!plan_.light_live[i]) add_light(i);
    }
    add_objects();
    for (size_t i = 0; i < description_.shapes.size(); ++i) {
      if (!plan_.shape_live[i] && !is_in_left_out_object(description_.shapes[i])) add_shape(i);
    }
    return std::move(found_);
  }

 private:
  /// The files that a statement's parameters name.
  void add_files(const Entity& entity, const std::string& category, std::vector<LeftOutFile>& files) const {
    const PluginInfo* info = find_plugin(category, entity.plugin);
    for (const Parameter& p : entity.params) {
      const ParamSpec* spec = info ? info->find_param(p.name) : nullptr;
      if (!spec || !spec->is_file || p.strings().empty() || p.strings().front().empty()) continue;
      const std::string& name = p.strings().front();
      files.push_back({name, size_of(std::filesystem::path(description_.folder) / name)});
    }
  }

  /// In bytes; a file that is not there has been reported.
  static int64_t size_of(const std::filesystem::path& path) {
    std::error_code failed;
    const auto size = std::filesystem::file_size(path, failed);
    return failed ? 0 : static_cast<int64_t>(size);
  }

  LeftOut& add(const char* kind, const std::string& name, std::string reason, SourcePos where) {
    return found_.emplace_back(LeftOut{kind, name, std::move(reason), where, {}});
  }

  void add_texture(size_t i) {
    const TextureDescription& t = description_.textures[i];
    const auto& plugin = scene_.textures[i].plugin;
    const char* reason = plugin && is_folded(*plugin)      ? "the same everywhere: its users hold the value"
                         : plan_.off.has(Effect::Textures) ? "textures are switched off"
                                                           : "no visible surface uses it";
    add_files(t, t.spectrum ? "spectrum texture" : "float texture", add("texture", t.name, reason, t.where).files);
  }

  void add_material(size_t i, bool overridden) {
    const MaterialDescription& m = description_.materials[i];
    const char* reason = overridden ? "the shapes that wear it override parameters" : "no visible shape wears it";
    add_files(m, "material", add("material", m.name.empty() ? m.plugin : m.name, reason, m.where).files);
  }

  /// By material: whether a visible shape wears it, be it with other parameters.
  std::vector<bool> find_worn() const {
    std::vector<bool> worn(description_.materials.size());
    for (size_t i = 0; i < description_.shapes.size(); ++i) {
      if (plan_.shape_live[i]) worn[static_cast<size_t>(description_.shapes[i].material)] = true;
    }
    return worn;
  }

  void add_light(size_t i) {
    const LightDescription& light = description_.lights[i];
    const auto& plugin = scene_.lights[i].plugin;
    const char* reason = !plugin                                   ? "it is not usable"
                         : plugin->is_black()                      ? "it gives no light"
                         : (plugin->effects() - plan_.off).empty() ? "its kind is switched off"
                                                                   : "no surface scatters its light";
    add_files(light, "light", add("light", light.plugin, reason, light.where).files);
  }

  bool is_in_left_out_object(const ShapeDescription& shape) const {
    return shape.object >= 0 && !plan_.object_live[static_cast<size_t>(shape.object)];
  }

  /// Objects with the files of their shapes, and those that were to be included in them.
  void add_objects() {
    std::vector<uint8_t> placed(description_.objects.size());
    for (const auto& instance : description_.instances) placed[static_cast<size_t>(instance.object)] = 1;
    std::vector<size_t> entry(description_.objects.size());
    for (size_t i = 0; i < description_.objects.size(); ++i) {
      entry[i] = found_.size();
      if (plan_.object_live[i]) continue;
      const ObjectDescription& object = description_.objects[i];
      add("object", object.name, placed[i] ? "instancing is switched off" : "it is never placed", object.where);
    }
    for (const ShapeDescription& shape : description_.shapes) {
      if (!is_in_left_out_object(shape)) continue;
      add_files(shape, "shape", found_[entry[static_cast<size_t>(shape.object)]].files);
    }
    for (const UnreadFile& file : description_.unread_files) {
      if (plan_.object_live[static_cast<size_t>(file.object)]) continue;  // In a file with mistakes.
      found_[entry[static_cast<size_t>(file.object)]].files.push_back({file.path, size_of(file.path)});
    }
  }

  void add_shape(size_t i) {
    const ShapeDescription& shape = description_.shapes[i];
    const auto& plugin = scene_.shapes[i].plugin;
    const auto& material = scene_.materials[static_cast<size_t>(scene_.shape_material[i])].plugin;
    const bool passed = material && material->is_interface() && plan_.off.has(Effect::Interfaces);
    const char* reason = !plugin ? "it is not usable" : passed ? "interfaces are switched off" : "its alpha is 0";
    add_files(shape, "shape", add("shape", shape.plugin, reason, shape.where).files);
  }

  const BoundScene& scene_;
  const EffectPlan& plan_;
  const SceneDescription& description_;
  std::vector<LeftOut> found_;
};

}  // namespace

std::vector<LeftOut> find_left_out(const BoundScene& scene, const EffectPlan& plan) {
  return Finder(scene, plan).run();
}

}  // namespace whit
