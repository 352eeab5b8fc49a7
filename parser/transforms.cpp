#include "parser/transforms.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace whit {

namespace {

double largest(const Vec3d& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// v with length 1; its largest component is divided out first, so that no square overflows or vanishes.
Vec3d unit(const Vec3d& v) {
  const double scale = largest(v);
  if (!(scale > 0)) return v;
  return (v / scale).normalized();
}

/// Sine and cosine of an angle in degrees, exact at multiples of 90.
std::pair<double, double> sincos_degrees(double degrees) {
  int quarters = 0;
  const double rest = std::remquo(degrees, 90.0, &quarters) * (M_PI / 180);
  const double s = std::sin(rest), c = std::cos(rest);
  switch (quarters & 3) {
    case 0: return {s, c};
    case 1: return {c, -s};
    case 2: return {-s, -c};
    default: return {-c, s};
  }
}

/// Divides every row, then every column, by its largest element. False when one is zero, not finite, or so small
/// or large that its reciprocal is useless.
bool equilibrate(Mat4d& m) {
  constexpr double kSmall = 1e-300, kLarge = 1e300;
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < 4; ++i) {
      double most = 0;
      for (int j = 0; j < 4; ++j) most = std::max(most, std::abs(pass == 0 ? m[i][j] : m[j][i]));
      if (!(most >= kSmall && most <= kLarge)) return false;
      for (int j = 0; j < 4; ++j) (pass == 0 ? m[i][j] : m[j][i]) /= most;
    }
  }
  return true;
}

/// The smallest pivot of Gaussian elimination with full pivoting, relative to elements of at most 1.
double smallest_pivot(Mat4d m) {
  double smallest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 4; ++k) {
    int row = k, column = k;
    for (int i = k; i < 4; ++i)
      for (int j = k; j < 4; ++j)
        if (std::abs(m[i][j]) > std::abs(m[row][column])) row = i, column = j;
    for (int j = 0; j < 4; ++j) std::swap(m[k][j], m[row][j]);
    for (int i = 0; i < 4; ++i) std::swap(m[i][k], m[i][column]);
    const double pivot = m[k][k];
    smallest = std::min(smallest, std::abs(pivot));
    if (pivot == 0) return 0;
    for (int i = k + 1; i < 4; ++i) {
      const double factor = m[i][k] / pivot;
      for (int j = k; j < 4; ++j) m[i][j] -= factor * m[k][j];
    }
  }
  return smallest;
}

}  // namespace

Mat4d translation(const Vec3d& by) {
  Mat4d m;
  for (int i = 0; i < 3; ++i) m[3][i] = by[i];
  return m;
}

Mat4d scaling(const Vec3d& by) {
  Mat4d m;
  for (int i = 0; i < 3; ++i) m[i][i] = by[i];
  return m;
}

Mat4d rotation(double degrees, const Vec3d& axis) {
  const Vec3d a = unit(axis);
  const auto [s, c] = sincos_degrees(degrees);
  const double t = 1 - c;
  // Rodrigues' formula, transposed for row vectors.
  return Mat4d(c + t * a.x * a.x, t * a.x * a.y + s * a.z, t * a.x * a.z - s * a.y, 0,  //
               t * a.x * a.y - s * a.z, c + t * a.y * a.y, t * a.y * a.z + s * a.x, 0,  //
               t * a.x * a.z + s * a.y, t * a.y * a.z - s * a.x, c + t * a.z * a.z, 0,  //
               0, 0, 0, 1);
}

std::optional<Mat4d> looking_at(const Vec3d& eye, const Vec3d& target, const Vec3d& up) {
  // Below this sine of the angle between view and up, rounding alone would choose the camera's roll.
  constexpr double kParallel = 1e-14;
  const Vec3d view = target - eye;
  if (!(largest(view) > 0) || !(largest(up) > 0) || !std::isfinite(largest(view))) return std::nullopt;
  const Vec3d z = unit(view);
  const Vec3d across = unit(up).cross(z);
  if (!(across.length() > kParallel)) return std::nullopt;
  const Vec3d x = unit(across);
  const Vec3d y = z.cross(x);
  // Camera to world has the axes as its rows, so the inverse of that rotation has them as columns.
  return Mat4d(x.x, y.x, z.x, 0,  //
               x.y, y.y, z.y, 0,  //
               x.z, y.z, z.z, 0,  //
               -eye.dot(x), -eye.dot(y), -eye.dot(z), 1);
}

Mat4d matrix_of_numbers(const std::array<double, 16>& numbers) {
  Mat4d m;
  for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = numbers[static_cast<size_t>(i)];
  return m;
}

std::optional<Mat4d> matrix_of_transform(std::string_view directive, const std::array<double, 16>& numbers) {
  const auto three = [&](size_t i) { return Vec3d(numbers[i], numbers[i + 1], numbers[i + 2]); };
  if (directive == "Translate") return translation(three(0));
  if (directive == "Scale") return scaling(three(0));
  if (directive == "LookAt") return looking_at(three(0), three(3), three(6));
  if (directive == "Transform" || directive == "ConcatTransform") return matrix_of_numbers(numbers);
  if (directive == "Rotate" && three(1) != Vec3d(0)) return rotation(numbers[0], three(1));
  return std::nullopt;
}

bool is_regular(const Mat4d& m) {
  // A few rounding errors of the elimination itself: a pivot below that is zero for all one can know.
  constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();
  const bool affine = m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] == 1;
  Mat4d scaled = m;
  for (int j = 0; j < 3; ++j) {
    if (!std::isfinite(m[3][j])) return false;
    // However far an affine map moves things, only its linear part decides.
    if (affine) scaled[3][j] = 0;
  }
  return equilibrate(scaled) && smallest_pivot(scaled) > kRounding;
}

}  // namespace whit
