#include "core/scene/motion.h"

#include <Imath/ImathMatrixAlgo.h>

#include <algorithm>
#include <cmath>

namespace whit {
namespace {

/// The rotation nearest to a regular 3x3 part, by Higham's iteration R <- (R + R^-T) / 2.
Mat4d nearest_rotation(Mat4d m) {
  for (int i = 0; i < 100; ++i) {
    const Mat4d next_sum = m + m.inverse().transposed();
    const Mat4d next = next_sum * 0.5;
    double change = 0;
    for (int r = 0; r < 3; ++r) {
      double row = 0;
      for (int c = 0; c < 3; ++c) row += std::abs(next[r][c] - m[r][c]);
      change = std::max(change, row);
    }
    m = next;
    if (change < 1e-14) break;
  }
  return m;
}

Imath::Quatd to_quaternion(const Mat4d& rotation) {
  Imath::Quatd q = Imath::extractQuat(rotation);
  return q.normalized();
}

}  // namespace

DecomposedTransform decompose(const Mat4d& m) {
  DecomposedTransform d;
  d.translation = m.translation();
  Mat4d linear = m;
  linear[3][0] = linear[3][1] = linear[3][2] = 0;
  // The polar iteration wants a matrix of ordinary size; a scale of 1e-12 is as regular as any.
  double size = 0;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) size = std::max(size, std::abs(linear[r][c]));
  }
  Mat4d unit = linear;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) unit[r][c] /= size;
  }
  Mat4d rotation = nearest_rotation(unit);
  // A mirroring has no rotation of its own: the reflection stays in the stretch.
  if (swaps_handedness(rotation)) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) rotation[r][c] = -rotation[r][c];
    }
  }
  d.rotation = to_quaternion(rotation);
  d.stretch = linear * rotation.transposed();
  return d;
}

Mat4d interpolate(const TransformPair& pair, double s) {
  if (!pair.animated() || s <= 0) return pair.start;
  if (s >= 1) return pair.end;
  const DecomposedTransform a = decompose(pair.start), b = decompose(pair.end);
  const Imath::Quatd rotation = Imath::slerpShortestArc(a.rotation, b.rotation, s);
  Mat4d translation;
  translation.setTranslation(a.translation * (1 - s) + b.translation * s);
  return (a.stretch * (1 - s) + b.stretch * s) * rotation.toMatrix44() * translation;
}

std::vector<Mat4d> keyframes(const TransformPair& pair) {
  if (!pair.animated()) return {pair.start};
  const DecomposedTransform a = decompose(pair.start), b = decompose(pair.end);
  const double cosine = std::min(1.0, std::abs(a.rotation ^ b.rotation));
  const double degrees = 2 * std::acos(cosine) * 180 / M_PI;
  const int steps = degrees < 1e-7 ? 1 : std::clamp(static_cast<int>(std::ceil(degrees / 1.5)), 1, 128);
  std::vector<Mat4d> keys;
  for (int i = 0; i <= steps; ++i) keys.push_back(interpolate(pair, static_cast<double>(i) / steps));
  return keys;
}

Mat4d interpolate_keys(std::span<const Mat4d> keys, double s) {
  if (keys.size() == 1) return keys.front();
  const double at = std::clamp(s, 0.0, 1.0) * static_cast<double>(keys.size() - 1);
  const size_t i = std::min(static_cast<size_t>(at), keys.size() - 2);
  const double f = at - static_cast<double>(i);
  return keys[i] * (1 - f) + keys[i + 1] * f;
}

}  // namespace whit
