#include "core/session/models.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "core/gltf/statement_text.h"
#include "core/plugin/model_shape.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

namespace fs = std::filesystem;

/// Meshes and pictures of models that are rendered: attached.
class AttachedAssets final : public gltf::Assets {
 public:
  explicit AttachedAssets(std::map<std::string, std::shared_ptr<const Attachment>>& attachments)
      : attachments_(attachments) {}

  std::string mesh(std::shared_ptr<const MeshSource> source, const std::string& /*name*/) override {
    return " \"gltf\"" + attach(std::move(source));
  }
  std::string picture(const gltf::Image& image, const std::string& /*name*/) override {
    if (!image.inside) return gltf::string_param("string filename", image.file);
    return attach(image.inside);
  }

 private:
  /// A picture of several textures has one name: textures that are the same are then one.
  std::string attach(std::shared_ptr<const Attachment> attachment) {
    const auto [named, is_new] = names_.try_emplace(attachment.get(), fmt::format("{}", attachments_.size()));
    if (is_new) attachments_[named->second] = std::move(attachment);
    return gltf::string_param(std::string("string ") + ModelReader::kAttached, named->second);
  }

  std::map<std::string, std::shared_ptr<const Attachment>>& attachments_;
  std::map<const Attachment*, std::string> names_;
};

const PluginInfo& model_plugin() { return *find_plugin("shape", "gltf"); }

/// The parameters of the request that are its own; those that its shapes get go to `for_shapes`.
ParameterList own_parameters(const ParameterList& all, ParameterList& for_shapes) {
  const std::vector<const PluginInfo*> materials = list_plugins("material");
  ParameterList own;
  for (const Parameter& p : all) {
    const bool is_alpha = p.name == "alpha" || p.name == "shadowalpha";
    const bool overrides = !model_plugin().find_param(p.name) &&
                           std::any_of(materials.begin(), materials.end(),
                                       [&](const PluginInfo* m) { return m->find_param(p.name) != nullptr; });
    (is_alpha || overrides ? for_shapes : own).push_back(p);
  }
  return own;
}

/// What a request asks for, by the plugin's table; nothing after errors.
std::optional<ModelChoice> choice_of(const ParameterList& own, const ModelRequest& request, Diagnostics& said) {
  BindContext context;
  context.diagnostics = &said;
  context.statement = request.where;
  context.statement_name = "gltf";
  context.folder = request.folder;
  const std::unique_ptr<Plugin> plugin = model_plugin().make();
  if (!bind_parameters(model_plugin(), *plugin, own, context)) return std::nullopt;
  Diagnostics found;
  plugin->check(found, request.where);
  said.append(found);
  if (found.has_errors()) return std::nullopt;
  return dynamic_cast<const ModelShape&>(*plugin).choice();
}

gltf::Selection selection_of(const ModelChoice& choice) {
  gltf::Selection out;
  out.scene = choice.scene, out.node = choice.node;
  if (choice.variant >= 0) out.variant = fmt::format("{}", choice.variant);
  if (choice.time) out.time = *choice.time;
  return out;
}

}  // namespace

namespace {

constexpr const char* kAsStatements = " as statements";

}  // namespace

std::string name_of_model_text(const std::string& model) { return model + kAsStatements; }
bool is_model_text(const std::string& name) { return name.ends_with(kAsStatements); }

bool is_model_file(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  if (ending == ".gltf" || ending == ".glb") return true;
  // A pipe can be read only once.
  std::error_code failed;
  if (ending == ".pbrt" || !fs::is_regular_file(path, failed)) return false;
  std::ifstream file(path, std::ios::binary);
  char magic[4] = {};
  return file.read(magic, 4) && std::string_view(magic, 4) == "glTF";
}

std::shared_ptr<const gltf::Model> ModelStore::load(const std::string& path, const std::string& shown, SourcePos where,
                                                    Diagnostics& said) {
  const auto [found, is_new] = loaded_.try_emplace(path);
  Loaded& loaded = found->second;
  loaded.used = true;
  if (is_new) {
    // Before it is read: a change meanwhile is then noticed.
    loaded.files[path] = file_state(path);
    timespec began{};
    ::clock_gettime(CLOCK_REALTIME_COARSE, &began);
    loaded.model = gltf::load_model(path, shown, options_, where, loaded.said);
    if (loaded.model)
      for (const std::string& file : loaded.model->files) {
        FileState state = file_state(file);
        // One that has changed since then may have been read before that: it is as good as changed.
        if (std::pair(state.seconds, state.nanoseconds) >= std::pair<int64_t, int64_t>(began.tv_sec, began.tv_nsec))
          state = {};
        loaded.files.try_emplace(file, state);
      }
  }
  if (!loaded.reported) said.append(loaded.said);
  else if (!loaded.model)
    said.error(where, fmt::format("{} cannot be read, as has been said where it is first placed", shown));
  loaded.reported = true;
  return loaded.model;
}

bool ModelStore::refresh() {
  const size_t forgotten = std::erase_if(loaded_, [](const auto& entry) {
    const Loaded& loaded = entry.second;
    return !loaded.model || !loaded.used || std::any_of(loaded.files.begin(), loaded.files.end(), [](const auto& file) {
      return file_state(file.first) != file.second;
    });
  });
  for (auto& [path, loaded] : loaded_) loaded.used = false;
  attachments_.clear();
  notes_.clear();
  placed_ = 0;
  return forgotten == 0;
}

std::vector<std::string> ModelStore::paths() const {
  std::vector<std::string> paths;
  for (const auto& [path, loaded] : loaded_) paths.push_back(path);
  return paths;
}

void ModelStore::begin() {
  for (auto& [path, loaded] : loaded_) loaded.reported = false;
}

void ModelStore::note(const std::string& shown, const gltf::Description& description) {
  for (const std::string& note : description.notes) {
    std::string line = shown + ": " + note;
    if (std::find(notes_.begin(), notes_.end(), line) == notes_.end()) notes_.push_back(std::move(line));
  }
}

std::optional<ModelStatements> ModelStore::read(const ModelRequest& request, Diagnostics& said) {
  ModelStatements out;
  const auto choice = choice_of(own_parameters(request.parameters, out.for_shapes), request, said);
  if (!choice) return std::nullopt;
  const std::string& shown = choice->file.as_given;
  const auto model = load(choice->file.path, shown, choice->file.where, said);
  if (!model) return std::nullopt;
  gltf::WorldOptions options;
  options.selection = selection_of(*choice);
  options.materials = choice->materials, options.lights = choice->lights;
  options.overridden = !out.for_shapes.empty(), options.in_scene = true;
  // What an object has lights nothing: not where all of it emits.
  options.objects = !request.in_object && (choice->materials || !request.under_emission);
  // Unlike any name that a scene may have, and unlike those of the model where it is placed again.
  options.prefix = fmt::format("{} #{}: ", shown, ++placed_);
  AttachedAssets assets(attachments_);
  const auto description = gltf::describe_world(model, options, assets, request.where, said);
  if (!description) return std::nullopt;
  note(shown, *description);
  // What it is to wear of its own does not stay, emission of before does not come in, and all of it moves.
  const char* dark = choice->materials ? "AreaLightSource \"\"\n" : "";
  out.name = name_of_model_text(shown);
  out.text = fmt::format("AttributeBegin\nActiveTransform All\n{}{}AttributeEnd\n", dark, description->text);
  return out;
}

std::shared_ptr<const Attachment> ModelStore::attachment(const std::string& name) const {
  const auto found = attachments_.find(name);
  return found == attachments_.end() ? nullptr : found->second;
}

std::optional<gltf::Description> ModelStore::scene_of(const std::string& path, const gltf::Selection& selection,
                                                      Diagnostics& said) {
  const auto model = load(path, path, {}, said);
  if (!model) return std::nullopt;
  AttachedAssets assets(attachments_);
  auto description = gltf::describe_scene(model, selection, assets, said);
  if (description) note(path, *description);
  return description;
}

}  // namespace whit
