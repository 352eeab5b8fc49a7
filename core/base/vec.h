// The vector, matrix and colour types of the whole program: Imath's vectors and matrices, under the names used here, and
// a colour of our own, since Imath's header for colours brings half-precision numbers and the processor's intrinsics
// into every file.
//
// Matrices follow Imath's row-vector convention, p' = p * M, so "first A, then B" is A * B. A pbrt
// `Transform [...]` lists the matrix in exactly this order, sixteen numbers row by row.
#pragma once

#include <Imath/ImathBox.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathQuat.h>
#include <Imath/ImathVec.h>

namespace whit {

using Vec2f = Imath::V2f;
using Vec3f = Imath::V3f;
using Vec2d = Imath::V2d;
using Vec3d = Imath::V3d;
using Vec2i = Imath::V2i;
using Mat4d = Imath::M44d;
using Box2i = Imath::Box2i;
using Box3d = Imath::Box3d;

/// Linear Rec.709 colour: radiance, reflectance or a weight, never display-encoded. Its three channels have a vector's
/// names, and operators work channel by channel.
struct RGB {
  float x, y, z;

  RGB() = default;  // Not initialised, like Imath's vectors.
  constexpr RGB(float r, float g, float b) : x(r), y(g), z(b) {}
  constexpr explicit RGB(float grey) : x(grey), y(grey), z(grey) {}

  float& operator[](int channel) { return (&x)[channel]; }
  const float& operator[](int channel) const { return (&x)[channel]; }

  constexpr RGB& operator+=(const RGB& c) { return x += c.x, y += c.y, z += c.z, *this; }
  constexpr RGB& operator-=(const RGB& c) { return x -= c.x, y -= c.y, z -= c.z, *this; }
  constexpr RGB& operator*=(const RGB& c) { return x *= c.x, y *= c.y, z *= c.z, *this; }
  constexpr RGB& operator/=(const RGB& c) { return x /= c.x, y /= c.y, z /= c.z, *this; }
  constexpr RGB& operator*=(float s) { return x *= s, y *= s, z *= s, *this; }
  constexpr RGB& operator/=(float s) { return x /= s, y /= s, z /= s, *this; }

  constexpr RGB operator-() const { return {-x, -y, -z}; }
  friend constexpr RGB operator+(RGB a, const RGB& b) { return a += b; }
  friend constexpr RGB operator-(RGB a, const RGB& b) { return a -= b; }
  friend constexpr RGB operator*(RGB a, const RGB& b) { return a *= b; }
  friend constexpr RGB operator/(RGB a, const RGB& b) { return a /= b; }
  friend constexpr RGB operator*(RGB a, float s) { return a *= s; }
  friend constexpr RGB operator*(float s, RGB a) { return a *= s; }
  friend constexpr RGB operator/(RGB a, float s) { return a /= s; }
  friend constexpr bool operator==(const RGB&, const RGB&) = default;
};

/// Rec.709 luminance Y of a linear colour.
inline float luminance(const RGB& c) { return 0.212671f * c.x + 0.715160f * c.y + 0.072169f * c.z; }

inline bool is_black(const RGB& c) { return c.x == 0 && c.y == 0 && c.z == 0; }

/// The image of a point, divided by w where the matrix is not affine.
inline Vec3d transform_point(const Mat4d& m, const Vec3d& p) {
  const auto row = [&](int c) { return p.x * m[0][c] + p.y * m[1][c] + p.z * m[2][c] + m[3][c]; };
  const Vec3d out(row(0), row(1), row(2));
  const double w = row(3);
  return w == 1 ? out : out / w;
}

/// The linear part applied to a direction.
inline Vec3d transform_vector(const Mat4d& m, const Vec3d& v) {
  Vec3d out;
  m.multDirMatrix(v, out);
  return out;
}

/// True when the linear part turns a right-handed frame into a left-handed one.
inline bool swaps_handedness(const Mat4d& m) {
  const double det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                     m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                     m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return det < 0;
}

}  // namespace whit
