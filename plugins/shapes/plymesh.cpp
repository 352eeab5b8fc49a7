// A triangle mesh read from a PLY file. Quads are split as pbrt-v3 splits them, faces with other numbers of
// corners and triangles without area are left out with a warning.

#include <fmt/format.h>

#include "core/base/mapped_file.h"
#include "core/base/ply.h"
#include "core/plugin/memory_need.h"
#include "core/plugin/registry.h"
#include "core/plugin/shape.h"

namespace whit {
namespace {

struct PlyMeshShape final : MeshShape, NeedsMemory {
  FileName filename;

  void check(Diagnostics& diagnostics, SourcePos statement) override {
    if (filename.empty()) diagnostics.error(statement, "plymesh has no \"filename\"");
  }

  MemoryNeed memory_need(const MeshAttributes& attributes) const override {
    const MappedFile file(filename.path);
    const PlyCounts counts = count_ply(file.bytes(), attributes);
    MemoryNeed need{.vertices = counts.vertices, .triangles = counts.triangles, .floats = counts.floats};
    need.making = file.bytes().size();
    return need;
  }

  bool build_mesh(const PrepareContext& ctx, MeshData& out) override {
    const MappedFile file(filename.path);
    if (!file.error().empty()) {
      ctx.diagnostics->file_error(filename.where, fmt::format("cannot open {}: {}", filename.as_given, file.error()));
      return false;
    }
    PlyMesh mesh;
    const std::string wrong = parse_ply(file.bytes(), mesh, ctx.attributes), changed = file.problem();
    if (const std::string& error = changed.empty() ? wrong : changed; !error.empty()) {
      ctx.diagnostics->file_error(filename.where, fmt::format("cannot read {}: {}", filename.as_given, error));
      return false;
    }
    if (mesh.indices.empty() && mesh.skipped_faces == 0) {
      ctx.diagnostics->warning(filename.where, fmt::format("{} has no faces or no vertices", filename.as_given),
                               "the shape is left out");
    }
    out.owned_positions = std::move(mesh.positions);
    out.positions = out.owned_positions;
    out.indices = std::move(mesh.indices);
    out.normals = std::move(mesh.normals);
    out.uvs = std::move(mesh.uvs);
    out.uvs1 = std::move(mesh.uvs1);
    out.colors = std::move(mesh.colors);
    out.tangents = std::move(mesh.tangents);
    out.bitangent_signs = std::move(mesh.bitangent_signs);
    out.degenerate = remove_degenerate_triangles(out);
    if (mesh.bad_numbers > 0) {
      ctx.diagnostics->warning(
          filename.where,
          fmt::format("{} has {} numbers of normals, tangents, surface parameters or colours that are not finite",
                      filename.as_given, mesh.bad_numbers),
          "they count as 0");
    }
    if (mesh.skipped_faces > 0) {
      ctx.diagnostics->warning(filename.where,
                               fmt::format("{} has {} faces with fewer than 3 or more than 4 corners",
                                           filename.as_given, mesh.skipped_faces),
                               "they are left out");
    }
    return true;
  }
};

const Register<PlyMeshShape> plymesh{
    "plymesh",
    "A triangle mesh in a PLY file. Vertices have x y z and may have normals (nx ny nz), texture coordinates (u v, "
    "also "
    "named s t, texture_u texture_v or texture_s texture_t), a second set of them (u1 v1), tangents (tx ty tz, and tw, "
    "negative where the bitangent is the cross product of tangent and normal instead of normal and tangent) and "
    "colours "
    "(red green blue, and alpha). Colours are linear: floats as they are, integers as parts of their largest value.",
    param(&PlyMeshShape::filename, "filename", Unit::None, "The PLY file, ascii or binary. Required."), alpha_param(),
    shadowalpha_param()};

}  // namespace
}  // namespace whit
