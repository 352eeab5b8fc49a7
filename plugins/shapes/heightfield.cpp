// A grid of heights over the unit square of the xy plane, as a mesh of two triangles per cell, as in pbrt-v3.

#include <fmt/format.h>

#include "core/plugin/memory_need.h"
#include "core/plugin/registry.h"
#include "core/plugin/shape.h"

namespace whit {
namespace {

struct Heightfield final : MeshShape, NeedsMemory {
  int nu, nv;
  FloatList Pz;

  void check(Diagnostics& diagnostics, SourcePos statement) override {
    if (is_empty()) return diagnostics.warning(statement, "heightfield has no cells", "it is left out");
    if (nu < 2) diagnostics.error(statement, fmt::format("heightfield needs \"nu\" of at least 2, not {}", nu));
    if (nv < 2) diagnostics.error(statement, fmt::format("heightfield needs \"nv\" of at least 2, not {}", nv));
    if (nu < 2 || nv < 2) return;
    const uint64_t points = static_cast<uint64_t>(nu) * static_cast<uint64_t>(nv);
    if (Pz.size() != points) {
      diagnostics.error(
          Pz.given ? Pz.where : statement,
          fmt::format("heightfield: \"Pz\" has {} values, expected {} (nu {} times nv {})", Pz.size(), points, nu, nv));
    } else if (points > 0xffffffffu) {
      diagnostics.error(statement, "heightfield has too many points");
    }
  }

  MemoryNeed memory_need(const MeshAttributes&) const override {
    if (is_empty()) return {};
    return {.vertices = Pz.size(), .triangles = 2 * cells(), .floats = 2};
  }

  bool build_mesh(const PrepareContext&, MeshData& out) override {
    if (is_empty()) return true;
    const auto columns = static_cast<uint32_t>(nu), rows = static_cast<uint32_t>(nv);
    out.owned_positions.reserve(3 * Pz.size());
    out.uvs.reserve(2 * Pz.size());
    out.indices.reserve(6 * cells());
    for (uint32_t y = 0; y < rows; ++y) {
      for (uint32_t x = 0; x < columns; ++x) {
        const double u = static_cast<double>(x) / (columns - 1), v = static_cast<double>(y) / (rows - 1);
        out.owned_positions.insert(out.owned_positions.end(), {u, v, Pz.values[size_t{y} * columns + x]});
        out.uvs.insert(out.uvs.end(), {static_cast<float>(u), static_cast<float>(v)});
      }
    }
    out.positions = out.owned_positions;
    for (uint32_t y = 0; y + 1 < rows; ++y) {
      for (uint32_t x = 0; x + 1 < columns; ++x) {
        const uint32_t a = y * columns + x, b = a + 1, c = b + columns, d = a + columns;
        out.indices.insert(out.indices.end(), {a, b, c, a, c, d});
      }
    }
    return true;
  }

 private:
  size_t cells() const { return static_cast<size_t>(nu - 1) * static_cast<size_t>(nv - 1); }
  /// True where the heights are as many as they should be, but make no cell.
  bool is_empty() const { return (nu < 2 || nv < 2) && Pz.size() == static_cast<size_t>(nu) * static_cast<size_t>(nv); }
};

const Register<Heightfield> heightfield{
    "heightfield", "A grid of heights over the unit square.",
    param(&Heightfield::nu, "nu", Unit::None, "Number of points along x, at least 2. Required.", kNonNegative),
    param(&Heightfield::nv, "nv", Unit::None, "Number of points along y, at least 2. Required.", kNonNegative),
    param(&Heightfield::Pz, "Pz", Unit::Length, "The heights, nu times nv, row by row in x. Required.", kCoordinates)};

}  // namespace
}  // namespace whit
