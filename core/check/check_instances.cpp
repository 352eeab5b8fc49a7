// Objects that are placed flat or mirrored.

#include <algorithm>
#include <string>

#include "core/check/findings.h"

namespace whit {
namespace {

/// The determinant of what a matrix does to directions, over the cube of what it makes of the longest axis: 1 or -1 for a
/// rotation or mirroring of any scale, near 0 for what is flat.
double shape_of(const Mat4d& m) {
  const Vec3d x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]), z(m[2][0], m[2][1], m[2][2]);
  const double size = std::max({x.length(), y.length(), z.length()});
  return size > 0 ? (x / size).cross(y / size).dot(z / size) : 0.0;
}

/// Flatter than that is thinner than the roundings of what is in the plane.
constexpr double kFlat = 1e-8;

}  // namespace

void check_instances(const CheckedWorld& world, Findings& found) {
  const SceneDescription& d = world.description;
  int last_seen = -1;
  double last = 0;
  size_t mirrored = 0, flat = 0;
  for (const InstanceDescription& instance : d.instances) {
    // Instances of one transform stand together.
    if (instance.transform != last_seen) {
      last_seen = instance.transform;
      last = shape_of(d.transforms[static_cast<size_t>(last_seen)].start);
    }
    if (last > kFlat) continue;
    const std::string name = "object \"" + d.objects[static_cast<size_t>(instance.object)].name + '"';
    if (last < -kFlat) {
      if (mirrored++ < kMostAlike)
        found.add("mirrored-instance", instance.where, name + " is placed mirrored",
                  "its transform turns right into left; a Scale with a negative number does");
    } else if (!d.is_singular(instance.transform) && flat++ < kMostAlike) {
      found.add("singular-instance", instance.where, name + " is placed so flat that nothing of it may be seen",
                "its transform takes all directions into a plane");
    }
  }
}

}  // namespace whit
