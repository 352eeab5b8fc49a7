// libFuzzer entry: any bytes are read as a PLY file. What is read must be what everybody relies on.
#include <cmath>

#include "core/base/ply.h"
#include "tests/fuzz/shared/fuzz.h"
#include "tests/fuzz/shared/ply_mutator.h"

namespace {

using whit::fuzz::require;

void check(const whit::PlyMesh& mesh) {
  const size_t vertices = mesh.positions.size() / 3;
  require(mesh.positions.size() % 3 == 0 && mesh.indices.size() % 3 == 0);
  for (const uint32_t i : mesh.indices) require(i < vertices);
  const auto right = [&](const std::vector<float>& values, size_t width) {
    require(values.empty() || values.size() == vertices * width);
    for (const float v : values) require(std::isfinite(v));
  };
  right(mesh.normals, 3), right(mesh.uvs, 2), right(mesh.uvs1, 2), right(mesh.colors, 4);
  right(mesh.tangents, 3), right(mesh.bitangent_signs, 1);
  require(mesh.bitangent_signs.empty() || !mesh.tangents.empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  for (const bool all : {false, true}) {
    whit::PlyMesh mesh;
    if (whit::parse_ply(bytes, mesh, {all, all}).empty()) check(mesh);
  }
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  return whit::fuzz::mutate_ply(data, size, max_size, seed);
}
