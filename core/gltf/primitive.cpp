#include "core/gltf/primitive.h"

#include <algorithm>
#include <cmath>

#include "core/gltf/primitive_parts.h"

namespace whit::gltf {
namespace {

/// Texture coordinates with v pointing up.
std::string read_uvs(const PrimitiveSource& source, int accessor, size_t vertices, std::vector<float>& out) {
  std::string error = source.floats(accessor, vertices, out);
  for (size_t i = 1; i < out.size(); i += 2) out[i] = 1 - out[i];
  return error;
}

/// Red, green, blue and alpha, which is 1 where the file has three numbers.
std::string read_colors(const PrimitiveSource& source, int accessor, size_t vertices, std::vector<float>& out) {
  std::vector<float> numbers;
  if (std::string error = source.floats(accessor, vertices, numbers); !error.empty()) return error;
  if (vertices == 0 || numbers.size() != vertices * 3) return out = std::move(numbers), "";
  out.resize(vertices * 4);
  for (size_t i = 0; i < vertices; ++i) {
    std::copy_n(numbers.data() + i * 3, 3, out.data() + i * 4);
    out[i * 4 + 3] = 1;
  }
  return {};
}

Vec3d corner(const MeshData& mesh, size_t index) {
  const double* p = mesh.positions.data() + size_t{mesh.indices[index]} * 3;
  return {p[0], p[1], p[2]};
}

/// Gives every triangle three vertices of its own, with its normal.
void make_flat(MeshData& mesh) {
  const std::vector<uint32_t> corners = mesh.indices;
  pick_vertices(mesh, corners);
  for (size_t i = 0; i < corners.size(); ++i) mesh.indices[i] = static_cast<uint32_t>(i);
  mesh.normals.resize(corners.size() * 3);
  for (size_t i = 0; i + 2 < corners.size(); i += 3) {
    const Vec3d a = corner(mesh, i);
    const Vec3d n = (corner(mesh, i + 1) - a).cross(corner(mesh, i + 2) - a).normalized();
    for (size_t k = 0; k < 9; ++k) mesh.normals[i * 3 + k] = static_cast<float>(n[static_cast<int>(k % 3)]);
  }
}

/// Tangents of the file as the mesh has them.
void split_tangents(const std::vector<float>& tangents, MeshData& mesh) {
  const size_t n = tangents.size() / 4;
  mesh.tangents.resize(n * 3), mesh.bitangent_signs.resize(n);
  for (size_t i = 0; i < n; ++i) {
    std::copy_n(tangents.data() + i * 4, 3, mesh.tangents.data() + i * 3);
    mesh.bitangent_signs[i] = tangents[i * 4 + 3];
  }
}

}  // namespace

void pick_vertices(MeshData& mesh, const std::vector<uint32_t>& from) {
  const auto pick = [&](const auto& values, size_t width, auto& out) {
    out.resize(from.size() * width);
    for (size_t i = 0; i < from.size(); ++i)
      std::copy_n(values.data() + size_t{from[i]} * width, width, out.data() + i * width);
  };
  std::vector<double> positions;
  pick(mesh.positions, 3, positions);
  mesh.owned_positions = std::move(positions);
  mesh.positions = mesh.owned_positions;
  const std::pair<std::vector<float>*, size_t> arrays[] = {{&mesh.normals, 3}, {&mesh.tangents, 3},
                                                           {&mesh.uvs, 2},     {&mesh.uvs1, 2},
                                                           {&mesh.colors, 4},  {&mesh.bitangent_signs, 1}};
  for (const auto& [array, width] : arrays) {
    if (array->empty()) continue;
    std::vector<float> picked;
    pick(*array, width, picked);
    *array = std::move(picked);
  }
}

std::string read_primitive(const Model& model, const Primitive& primitive, const Pose& pose, const MeshNeeds& needs,
                           MeshData& out) {
  out = {};
  const Attributes& attributes = primitive.attributes;
  if (primitive.mode == Primitive::Mode::Points || primitive.mode == Primitive::Mode::Lines || attributes.position < 0)
    return {};
  PrimitiveSource source(model, primitive);
  PosedArrays arrays;
  std::string error = source.open();
  const auto then = [&](const auto& step) {
    if (error.empty()) error = step();
  };
  then([&] { return source.positions(arrays.positions); });
  const size_t vertices = arrays.positions.size() / 3;
  then([&] { return source.triangles(vertices, out.indices); });
  then([&] { return source.floats(attributes.normal, vertices, arrays.normals); });
  // Tangents without normals say nothing.
  const bool file_tangents = needs.tangents && attributes.normal >= 0 && attributes.tangent >= 0;
  if (file_tangents) then([&] { return source.floats(attributes.tangent, vertices, arrays.tangents); });
  const bool make_tangents = needs.tangents && !file_tangents;
  const bool uv_needed[] = {needs.uv0 || (make_tangents && needs.tangent_uv_set == 0),
                            needs.uv1 || (make_tangents && needs.tangent_uv_set == 1)};
  if (uv_needed[0]) then([&] { return read_uvs(source, attributes.uv[0], vertices, out.uvs); });
  if (uv_needed[1]) then([&] { return read_uvs(source, attributes.uv[1], vertices, out.uvs1); });
  if (needs.colors) then([&] { return read_colors(source, attributes.color, vertices, out.colors); });
  then([&] { return pose_arrays(source, primitive, pose, arrays); });
  if (const std::string changed = model.buffers->problem(); !changed.empty()) error = model.at(changed);
  if (!error.empty()) return out = {}, error;

  out.owned_positions = std::move(arrays.positions);
  out.positions = out.owned_positions;
  out.normals = std::move(arrays.normals);
  split_tangents(arrays.tangents, out);
  out.degenerate = remove_degenerate_triangles(out);
  if (make_tangents) {
    std::vector<float>& uvs = needs.tangent_uv_set == 0 ? out.uvs : out.uvs1;
    if (!uvs.empty() && out.normals.empty()) make_flat(out);
    if (!uvs.empty()) add_tangents(out, std::vector<float>(uvs));
    if (!needs.uv0) out.uvs.clear();
    if (!needs.uv1) out.uvs1.clear();
  }
  return {};
}

}  // namespace whit::gltf
