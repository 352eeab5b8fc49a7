#include "core/scene/light_end.h"

#include <algorithm>
#include <cmath>

#include "core/base/box.h"

namespace whit {
namespace {

RayEnd end_on_triangle(const Accel& accel, const Mesh& mesh, uint32_t prim) {
  const std::array<Vec3d, 3> corners{mesh.corner(prim, 0), mesh.corner(prim, 1), mesh.corner(prim, 2)};
  RayEnd end;
  end.on = RayEnd::On::Plane;
  end.p = corners[0];
  end.n = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  const Box3d box = triangle_box(corners[0], corners[1], corners[2]);
  end.error = rounding_of(farthest_of(box));
  end.touching = accel.touching(box, &corners);
  end.own_vertices = mesh.positions.data(), end.own_triangle = prim;
  return end;
}

RayEnd end_on_shape(const Accel& accel, const AnalyticShape& shape, const SceneLight& light) {
  RayEnd end;
  end.on = RayEnd::On::Shape;
  end.analytic = &shape;
  // The back of a two-sided light is seen past its front.
  if (!light.light->is_two_sided()) end.unshaded_by = light.shape;
  const Box3d box = transform_box(shape.object_to_scene(), shape.object_bounds());
  end.error = Vec3d(rounding_of_size(shape.object_bounds(), shape.object_to_scene()));
  end.touching = accel.touching(box, nullptr);
  return end;
}

}  // namespace

RayEnd end_of(const Scene& scene, const SceneLight& light) {
  if (light.shape >= 0) {
    const SceneShape& shape = scene.shapes[static_cast<size_t>(light.shape)];
    return shape.mesh ? end_on_triangle(*scene.accel, *shape.mesh, light.prim)
                      : end_on_shape(*scene.accel, *shape.analytic, light);
  }
  RayEnd end;
  const std::optional<Vec3d> position = light.light->position();
  if (!position) return end;
  end.on = RayEnd::On::Point;
  end.p = *position;
  end.touching = scene.accel->touching(Box3d(end.p, end.p), nullptr);
  return end;
}

}  // namespace whit
