// What is so near to an emitter that shadow rays must tell it from the emitter.
#pragma once

#include <array>
#include <functional>

#include "core/accel/embree_geometry.h"

namespace whit {

/// What stands behind a geometry of an instance (RTC_INVALID_GEOMETRY_ID: of the world itself).
using UserOf = std::function<const GeometryUser*(unsigned instance, unsigned geometry)>;

/// As Accel::touching(), of what does not move.
Touching what_is_near(RTCScene world, const UserOf& user_of, const Box3d& box, const std::array<Vec3d, 3>* corners);

}  // namespace whit
