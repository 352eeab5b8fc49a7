// From where a light shines and where it does not: what is needed to see that it leaves a batch of points dark.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/base/vec.h"

namespace whit {

/// A cone outside of which a light at a point sends nothing.
struct LightCone {
  Vec3f apex{0, 0, 0};                       ///< Render space.
  Vec3f x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  ///< Rows of the linear map from render to light space, where it is round.
  double stretch = 1;                        ///< The most by which that map lengthens a vector.
  Vec3d axis{0, 0, 1};                       ///< Light space, unit.
  double cosine = -1, sine = 0;              ///< Of the angle between axis and edge, which is at most 180 degrees.
};

/// What Light::sample(), or sampling an emitting primitive, can come up with at points farther than kNearestLight from
/// the light. By default anything.
struct LightReach {
  /// Points that are nearer than this to the light, in render space, are lit as far as anyone can tell.
  static constexpr double kNearestLight = 1e-9;
  /// Numbers that are multiplied with a 0 must not be infinite: a light may arrive this strong at that distance.
  static constexpr double kStrongest = 1e36;

  enum class From : uint8_t { Anywhere, Box, Direction };
  From from = From::Anywhere;
  bool one_sided = false;             ///< The points of the box lie in a plane, of which one side is lit.
  Vec3f low{0, 0, 0}, high{0, 0, 0};  ///< Box: of all sampled points, render space.
  /// Unit. Direction: towards the light. Box: across the plane that its points lie in, if they do; one-sided: towards the
  /// lit side. Else 0.
  Vec3f normal{0, 0, 0};
  double plane = 0;                 ///< One-sided: the least dot(normal, q) of a sampled point q.
  const LightCone* cone = nullptr;  ///< The light's, if it has one; its apex is the box.
};

/// Of a light at a point of render space whose radiance is at most intensity * (to_render / distance)^2.
inline LightReach reach_of_point(const Vec3f& position, const RGB& intensity, float to_render) {
  LightReach reach;
  reach.low = reach.high = position;
  const double falloff = static_cast<double>(to_render) / LightReach::kNearestLight;
  const auto strongest =
      static_cast<double>(std::max({std::abs(intensity.x), std::abs(intensity.y), std::abs(intensity.z)}));
  const bool finite = std::isfinite(position.x) && std::isfinite(position.y) && std::isfinite(position.z);
  if (finite && (1 + strongest) * falloff * falloff < LightReach::kStrongest) reach.from = LightReach::From::Box;
  return reach;
}

}  // namespace whit
