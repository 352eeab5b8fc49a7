// Render space: world space seen from the camera's position and scaled by a power of two, in which all
// float arithmetic happens. Computed in double, so that a scene keeps its digits wherever it stands.
#pragma once

#include "core/base/vec.h"

namespace whit {

/// The similarity render = (world - origin) * scale; scale is a power of two, so it costs no digits.
struct RenderSpace {
  Vec3d origin{0, 0, 0};
  double scale = 1;

  Mat4d from_world() const {
    Mat4d m;
    m.setTranslation(-origin);
    return m * Mat4d().setScale(scale);
  }
  Mat4d to_world() const {
    Mat4d m;
    m.setScale(1 / scale);
    return m * Mat4d().setTranslation(origin);
  }
};

}  // namespace whit
