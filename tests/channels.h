// The channels of a colour in double precision: for sums over many.
#pragma once

#include "core/base/vec.h"

namespace whit::test {

inline Vec3d channels(const RGB& c) {
  return {static_cast<double>(c.x), static_cast<double>(c.y), static_cast<double>(c.z)};
}

}  // namespace whit::test
