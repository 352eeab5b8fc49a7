#include "core/gltf/check_model.h"

#include "core/gltf/check_parts.h"

namespace whit::gltf {
namespace {

/// Every "extensions" is an object of objects, and every "name" is text. What is in extras and extensions is
/// looked at where it is read.
void check_everywhere(const Item& item) {
  if (item.value().is_array()) {
    for (size_t i = 0; i < item.value().size(); ++i) check_everywhere(Item(item, i, item.value()[i]));
    return;
  }
  item.members([](const Item& member, const std::string& key) {
    if (key == "extras") return;
    if (key == "name" && !member.value().is_string()) return member.error("must be a string");
    if (key == "extensions") {
      if (member.is_object()) member.members([](const Item& extension, const std::string&) { extension.is_object(); });
      return;
    }
    if (member.value().is_structured()) check_everywhere(member);
  });
}

Things count(const Item& item, const char* key) {
  const auto found = item.value().find(key);
  return {key, found != item.value().end() && found->is_array() ? found->size() : 0};
}

Counts counts_of(const Item& root) {
  Counts out;
  for (Things* things : {&out.accessors, &out.views, &out.nodes, &out.meshes, &out.skins, &out.cameras, &out.materials,
                         &out.textures, &out.images, &out.samplers, &out.scenes}) {
    *things = count(root, things->name);
  }
  root.object("extensions", [&](const Item& extensions) {
    extensions.object("KHR_lights_punctual", [&](const Item& e) { out.lights = count(e, out.lights.name); });
    extensions.object("KHR_materials_variants", [&](const Item& e) { out.variants = count(e, out.variants.name); });
  });
  return out;
}

bool uses(const Item& root, const std::string& extension) {
  const auto found = root.value().find("extensionsUsed");
  if (found == root.value().end() || !found->is_array()) return false;
  return std::find(found->begin(), found->end(), Json(extension)) != found->end();
}

}  // namespace

void check_model(const Item& root, const Buffers& buffers) {
  check_extensions(root);
  check_everywhere(root);
  CheckContext c{root, buffers, counts_of(root), false, uses(root, "KHR_mesh_quantization"), {}, {}};
  check_meshes(c);
  check_nodes(c);
  check_animations(c);
  check_cameras(c);
  check_materials(c);
  check_textures(c);
}

}  // namespace whit::gltf
