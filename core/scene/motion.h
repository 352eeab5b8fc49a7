// Animated transforms: translation, rotation and scale interpolated apart, as keyframes dense enough to be
// interpolated linearly by ray tracer and shading alike.
#pragma once

#include <span>
#include <vector>

#include "core/base/vec.h"
#include "parser/scene_description.h"

namespace whit {

/// M = S * R * T in row-vector order: stretch, then rotation, then translation (Shoemake and Duff 1992).
struct DecomposedTransform {
  Mat4d stretch;
  Imath::Quatd rotation;
  Vec3d translation;
};
DecomposedTransform decompose(const Mat4d& m);

/// The transform at time s in [0,1] between the pair's start and end: rotation by slerp along the shorter
/// arc, the rest linearly. The start or end matrix itself at and beyond the ends.
Mat4d interpolate(const TransformPair& pair, double s);

/// Keyframes evenly spaced over [0,1]: one when the pair does not move, two when it only translates or
/// stretches, and at most 129 so that the rotation between neighbours stays below 1.5 degrees.
std::vector<Mat4d> keyframes(const TransformPair& pair);

/// Linear interpolation of evenly spaced keyframes at s in [0,1].
Mat4d interpolate_keys(std::span<const Mat4d> keys, double s);

}  // namespace whit
