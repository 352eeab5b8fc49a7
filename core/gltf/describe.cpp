#include "core/gltf/describe.h"

#include <algorithm>
#include <map>
#include <set>

#include "core/gltf/attached_primitive.h"
#include "core/gltf/describe_camera.h"
#include "core/gltf/describe_material.h"
#include "core/gltf/pose.h"
#include "core/gltf/select.h"
#include "core/gltf/statement_text.h"

namespace whit::gltf {
namespace {

/// Writes the statements of a world.
class WorldWriter {
 public:
  WorldWriter(const std::shared_ptr<const Model>& model, const WorldOptions& options, Assets& assets)
      : model_(model),
        options_(options),
        assets_(assets),
        names_(options.prefix),
        materials_(*model, assets, names_),
        variant_(options.selection.variant.empty() ? -1 : variant_index(*model, options.selection.variant)) {}

  /// "" or what is wrong.
  std::string write(const ShownNodes& shown, std::string& text) {
    std::vector<DrawnMesh> drawn;
    size_t unplaceable = 0;
    if (std::string error = drawn_meshes(*model_, shown, drawn, unplaceable); !error.empty()) return error;
    for (const DrawnMesh& mesh : drawn) {
      if (!is_bent(mesh.pose)) uses_[mesh.mesh] += mesh.to_root.size();
    }
    for (const DrawnMesh& mesh : drawn) {
      for (const Mat4d& to_root : mesh.to_root) place(mesh, to_root);
    }
    if (options_.lights) write_lights(shown);
    if (unshown_ > 0) notes_.insert(fmt::format("{} primitives of points or lines are not shown", unshown_));
    if (unplaceable > 0) notes_.insert(fmt::format("{} meshes are scaled to nothing and not shown", unplaceable));
    text = materials_.statements() + lights_ + objects_ + shapes_;
    return {};
  }

  std::set<std::string> notes() const {
    std::set<std::string> all = notes_;
    all.insert(materials_.notes().begin(), materials_.notes().end());
    return all;
  }

 private:
  const Mesh& mesh_of(const DrawnMesh& drawn) const { return model_->meshes[static_cast<size_t>(drawn.mesh)]; }

  void write_lights(const ShownNodes& shown) {
    for (const int node : shown.nodes) {
      const Mat4d& to_root = shown.posed.to_root[static_cast<size_t>(node)];
      if (is_placeable(to_root)) lights_ += light_statements(*model_, node, to_root, notes_);
    }
  }

  int material_of(const Primitive& primitive) const {
    const auto variant = static_cast<size_t>(variant_);
    if (variant_ < 0 || variant >= primitive.variant_material.size()) return primitive.material;
    const int other = primitive.variant_material[variant];
    return other >= 0 ? other : primitive.material;
  }

  bool emits(const Mesh& mesh) {
    return options_.materials &&
           std::any_of(mesh.primitives.begin(), mesh.primitives.end(), [this](const Primitive& p) {
             return materials_.worn(material_of(p), p.attributes.color >= 0).emits;
           });
  }

  /// Where a mesh is placed several times, and does not emit: what an object has lights nothing.
  void place(const DrawnMesh& drawn, const Mat4d& to_root) {
    const Mesh& mesh = mesh_of(drawn);
    const std::string matrix = to_root == Mat4d() ? "" : matrix_statement("ConcatTransform", to_root);
    if (options_.objects && !is_bent(drawn.pose) && uses_[drawn.mesh] > 1 && !emits(mesh)) {
      auto [object, is_new] = object_names_.try_emplace(drawn.mesh);
      if (is_new) {
        object->second = names_.unique(mesh.name, fmt::format("mesh {}", drawn.mesh));
        objects_ += fmt::format("ObjectBegin {}\n{}{}ObjectEnd\n", scene_string(object->second),
                                options_.in_scene ? "Identity\n" : "", primitives(drawn));
      }
      shapes_ +=
          fmt::format("AttributeBegin\n{}ObjectInstance {}\nAttributeEnd\n", matrix, scene_string(object->second));
      return;
    }
    shapes_ += "AttributeBegin\n" + matrix + primitives(drawn) + "AttributeEnd\n";
  }

  std::string primitives(const DrawnMesh& drawn) {
    const Mesh& mesh = mesh_of(drawn);
    const Node& node = model_->nodes[static_cast<size_t>(drawn.node)];
    const std::string name = !node.name.empty() && is_bent(drawn.pose) ? node.name
                             : !mesh.name.empty()                      ? mesh.name
                                                                       : node.name;
    std::string out;
    for (const Primitive& primitive : mesh.primitives) {
      if (primitive.mode == Primitive::Mode::Points || primitive.mode == Primitive::Mode::Lines) {
        ++unshown_;
      } else if (primitive.attributes.position >= 0) {
        out += shape(primitive, drawn.pose, name.empty() ? fmt::format("mesh {}", drawn.mesh) : name);
      }
    }
    return out;
  }

  std::string shape(const Primitive& primitive, const Pose& pose, const std::string& name) {
    const int material = material_of(primitive);
    const bool colors = primitive.attributes.color >= 0;
    const std::string mesh = assets_.mesh(
        std::make_shared<AttachedPrimitive>(model_, primitive, pose,
                                            needs_of(*model_, material, options_.overridden || !options_.materials)),
        name);
    if (!options_.materials) return "Shape" + mesh + "\n";
    const WornMaterial& worn = materials_.worn(material, colors);
    const std::string text = worn.statements + "Shape" + mesh + worn.for_shape + "\n";
    return worn.emits ? "AttributeBegin\n" + text + "AttributeEnd\n" : text;
  }

  const std::shared_ptr<const Model> model_;
  const WorldOptions& options_;
  Assets& assets_;
  UniqueNames names_;
  MaterialWriter materials_;
  const int variant_;           ///< -1: none.
  std::map<int, size_t> uses_;  ///< How often a mesh is placed as it is.
  std::map<int, std::string> object_names_;
  std::string lights_, objects_, shapes_;
  std::set<std::string> notes_;
  int unshown_ = 0;
};

/// Selects and poses. False after an error.
bool find_shown(const Model& model, const Selection& selection, SourcePos where, ShownNodes& out,
                Diagnostics& diagnostics) {
  std::vector<int> roots;
  if (!select_roots(model, selection, roots, where, diagnostics)) return false;
  out.nodes = nodes_below(model, roots);
  const std::string error = pose_nodes(model, selection.time, out.posed);
  if (!error.empty()) diagnostics.error(where, model.at(error));
  return error.empty();
}

std::optional<Description> describe_nodes(const std::shared_ptr<const Model>& model, const WorldOptions& options,
                                          const ShownNodes& shown, Assets& assets, SourcePos where,
                                          Diagnostics& diagnostics) {
  WorldWriter writer(model, options, assets);
  Description out;
  if (const std::string error = writer.write(shown, out.text); !error.empty()) {
    diagnostics.error(where, model->at(error));
    return std::nullopt;
  }
  const std::set<std::string> notes = writer.notes();
  out.notes.assign(notes.begin(), notes.end());
  return out;
}

}  // namespace

std::optional<Description> describe_world(const std::shared_ptr<const Model>& model, const WorldOptions& options,
                                          Assets& assets, SourcePos where, Diagnostics& diagnostics) {
  ShownNodes shown;
  if (!find_shown(*model, options.selection, where, shown, diagnostics)) return std::nullopt;
  return describe_nodes(model, options, shown, assets, where, diagnostics);
}

std::optional<Description> describe_scene(const std::shared_ptr<const Model>& model, const Selection& selection,
                                          Assets& assets, Diagnostics& diagnostics) {
  WorldOptions options;
  options.selection = selection;
  options.lights = true;
  ShownNodes shown;
  if (!find_shown(*model, selection, {}, shown, diagnostics)) return std::nullopt;
  std::optional<Description> world = describe_nodes(model, options, shown, assets, {}, diagnostics);
  if (!world) return std::nullopt;
  std::string view;
  if (!describe_view(*model, selection, shown, view, world->notes, diagnostics)) return std::nullopt;
  const auto is_light = [&](int node) { return model->nodes[static_cast<size_t>(node)].light >= 0; };
  std::string sky;
  if (std::none_of(shown.nodes.begin(), shown.nodes.end(), is_light)) {
    sky = "LightSource \"skybox\"\n";
    world->notes.emplace_back("there are no lights in the file: it stands under a sky, a gradient");
  }
  world->text = view + "WorldBegin\n" + sky + world->text + "WorldEnd\n";
  return world;
}

}  // namespace whit::gltf
