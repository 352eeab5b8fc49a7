// A glTF 2.0 model. Its statement is replaced by those that stand for the model (core/session/models.h) when a scene is
// read; what is built here are the meshes that these have attached.

#include <fmt/format.h>

#include "core/plugin/memory_need.h"
#include "core/plugin/model_shape.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

struct GltfShape final : ModelShape, NeedsMemory {
  FileName filename;
  std::string scene, node;
  int variant = -1;
  bool usematerials = true, uselights = false;
  std::optional<float> time;
  std::shared_ptr<const MeshSource> mesh;

  ModelChoice choice() const override { return {filename, scene, node, variant, time, usematerials, uselights}; }

  void attach(std::shared_ptr<const Attachment> attached) override {
    mesh = std::dynamic_pointer_cast<const MeshSource>(attached);
  }

  void check(Diagnostics& diagnostics, SourcePos statement) override {
    if (!mesh && filename.empty()) diagnostics.error(statement, "gltf has no \"filename\"");
  }

  MemoryNeed memory_need(const MeshAttributes& attributes) const override {
    const auto* source = dynamic_cast<const NeedsMemory*>(mesh.get());
    return source ? source->memory_need(attributes) : MemoryNeed();
  }

  bool build_mesh(const PrepareContext& ctx, MeshData& out) override {
    if (!mesh) {
      ctx.diagnostics->error(ctx.statement, fmt::format("{} was not read with the scene", filename.as_given));
      return false;
    }
    if (const std::string error = mesh->read(out); !error.empty()) {
      ctx.diagnostics->file_error(ctx.statement, error);
      return false;
    }
    if (out.indices.empty() && out.degenerate > 0) {
      ctx.diagnostics->warning(
          ctx.statement,
          fmt::format("none of its {} triangles has an area and corners that are finite", out.degenerate),
          "the shape is left out");
    }
    return true;
  }
};

const Register<GltfShape> gltf{
    "gltf",
    "A model in a glTF 2.0 file (.gltf or .glb): its nodes under the current transform.",
    param(&GltfShape::filename, "filename", Unit::None, "The model's file. Required."),
    param(&GltfShape::usematerials, "usematerials", true, Unit::None,
          "Its own materials and emission; otherwise the current ones."),
    param(&GltfShape::uselights, "uselights", false, Unit::None,
          "Its lights (KHR_lights_punctual) too: candela and lux are taken as intensity and irradiance."),
    param(&GltfShape::scene, "scene", "", Unit::None,
          "Name or number, from 0, of its scene. By default the one that the file names, else its first."),
    param(&GltfShape::node, "node", "", Unit::None,
          "Name or number, from 0, of a node: only that is placed, with all below it, where it is in the model."),
    param(&GltfShape::variant, "variant", -1, Unit::None,
          "Number, from 0, of a variant of its materials (KHR_materials_variants); by default none.", {-1, kAny.max}),
    param(&GltfShape::time, "time", Unit::Seconds,
          "Poses it by its animations at that time. By default as it stands without them."),
    alpha_param(),
    shadowalpha_param()};

}  // namespace
}  // namespace whit
