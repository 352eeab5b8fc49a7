// libFuzzer entry: any bytes are loaded as a glTF model, and all accessors and primitives of what loads are decoded; nothing
// may crash, and meshes must be what everybody relies on.
#include <cmath>

#include "core/gltf/accessor.h"
#include "core/gltf/primitive.h"
#include "tests/fuzz/shared/fuzz.h"
#include "tests/fuzz/shared/json_mutator.h"

namespace {

using whit::fuzz::require;

void check(const whit::MeshData& mesh) {
  const size_t vertices = mesh.positions.size() / 3;
  for (const uint32_t i : mesh.indices) require(i < vertices);
  const auto right = [&](const std::vector<float>& values, size_t width) {
    require(values.empty() || values.size() == vertices * width);
    for (const float v : values) require(std::isfinite(v));
  };
  right(mesh.normals, 3), right(mesh.tangents, 3), right(mesh.bitangent_signs, 1);
  right(mesh.uvs, 2), right(mesh.uvs1, 2), right(mesh.colors, 4);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static whit::fuzz::MemoryFile file;
  file.set(data, size);
  whit::Diagnostics diagnostics;
  const auto model = whit::gltf::load_model(file.path(), "fuzz.glb", {}, {}, diagnostics);
  require((model == nullptr) == diagnostics.has_errors());
  if (!model) return 0;
  whit::gltf::Pose pose;
  pose.weights = {0.5, 2, -1};
  pose.joints.resize(8);
  for (const bool tangents : {false, true}) {
    const whit::gltf::MeshNeeds needs{tangents, data[size / 2] & 1, true, tangents, true};
    for (const auto& mesh : model->meshes) {
      for (const auto& primitive : mesh.primitives) {
        whit::MeshData out;
        whit::gltf::read_primitive(*model, primitive, tangents ? pose : whit::gltf::Pose{}, needs, out);
        check(out);
      }
    }
  }
  std::vector<float> numbers;
  for (const auto& skin : model->skins) {
    if (skin.inverse_bind_matrices >= 0) whit::gltf::read_floats(*model, skin.inverse_bind_matrices, numbers);
  }
  for (const auto& animation : model->animations)
    for (const auto& channel : animation.channels) whit::gltf::read_floats(*model, channel.output, numbers);
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  return whit::fuzz::mutate_model(data, size, max_size, seed);
}
