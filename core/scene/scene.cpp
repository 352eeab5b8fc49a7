#include "core/scene/scene.h"

namespace whit {

size_t Mesh::bytes() const {
  return sizeof(float) * (positions.capacity() + normals.capacity() + tangents.capacity() + bitangent_signs.capacity() +
                          uvs.capacity() + uvs1.capacity() + colors.capacity()) +
         sizeof(uint32_t) * indices.capacity() + sizeof(ExactTriangle) * exact.capacity();
}

size_t Scene::triangle_count() const {
  size_t n = 0;
  for (const auto& m : meshes) n += m->triangle_count();
  return n;
}

size_t Scene::geometry_bytes() const {
  size_t n = accel ? accel->bytes() : 0;
  for (const auto& m : meshes) n += m->bytes();
  return n;
}

}  // namespace whit
