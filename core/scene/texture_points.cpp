#include "core/scene/texture_points.h"

namespace whit {

ShadingBatch texture_points(const Mesh* mesh, int n, Arena& arena) {
  ShadingBatch s;
  s.n = n;
  s.arena = &arena;
  s.p = arena.vec3(n);
  s.u = arena.floats(n), s.v = arena.floats(n);
  if (mesh && !mesh->uvs1.empty()) s.u1 = arena.floats(n), s.v1 = arena.floats(n);
  if (mesh && !mesh->colors.empty()) s.color = arena.rgb(n), s.color_alpha = arena.floats(n);
  return s;
}

}  // namespace whit
