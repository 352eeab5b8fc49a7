// Surfaces that lie in one another, like a picture on a wall without a gap: rounding would decide which of them a ray
// meets. Such pairs are found when a scene is built, and the later statement's surface is the one that is there.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/scene/scene.h"

namespace whit {

/// Two shapes of a group, by their places in it, that share a part of their surfaces; lower < upper.
struct Coincidence {
  int lower = 0, upper = 0;
};

/// What find_coincidences() found: the pairs to be warned of, and for shapes that are cut away under others the test.
struct Coincidences {
  std::vector<Coincidence> pairs;
  std::vector<std::pair<int, std::unique_ptr<AlphaTest>>> cuts;  ///< By shape, in rising order.
};

/// Looks at the meshes and analytic shapes of one group, whose surfaces coincide to within what the group's floats can
/// tell. Beyond 20,000 shapes none is looked at, and no more after ten million comparisons of triangles. The upper shape
/// is the one that is there, unless the lower one hides it: a solid that stands on something has its face cut away, and no
/// pair is told. Who looks from `eye` does not see that face; without one a solid stands on what faces it. A shape for
/// which `has_alpha` is true may have holes: it cuts nothing away, and hides nothing.
Coincidences find_coincidences(std::span<const SceneShape> shapes, const std::vector<bool>& has_alpha,
                               const std::optional<Vec3d>& eye);

/// A surface that is there where neither test cuts it; both may be null, and so may the result.
std::unique_ptr<AlphaTest> both(std::unique_ptr<AlphaTest> a, std::unique_ptr<AlphaTest> b);

}  // namespace whit
