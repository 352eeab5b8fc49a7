// What Embree's callbacks know of the geometry that they are called for, and the callbacks of each kind of geometry: each
// kind has a file, whose templates stay beside the callbacks that they are made for.
#pragma once

#include "core/accel/accel.h"
#include "core/accel/embree.h"

namespace whit {

/// In place of a number of a shape that cannot shade itself: one that can, which is never what rays are unshaded by.
constexpr int kShadesItself = -2;

/// What Embree hands back to us with a user geometry or a filter call.
struct GeometryUser {
  const AnalyticShape* analytic = nullptr;
  const AlphaTest* alpha = nullptr;
  MeshView mesh{};
  CurveView curves{};
  const ExactTriangle* triangles = nullptr;
  RTCBounds bounds{};                      ///< Of an analytic shape.
  int unshaded_by_itself = kShadesItself;  ///< The number of a shape that cannot shade itself.
};

/// Callbacks for geometry with a GeometryUser of that kind.
void set_analytic_callbacks(RTCGeometry geometry);
void set_curve_callbacks(RTCGeometry geometry);
void set_exact_callbacks(RTCGeometry geometry);
/// Has every hit of a mesh asked of its alpha test.
void set_alpha_filter(RTCGeometry geometry);
/// Drops the hits of triangles that the end of their shadow ray lies on, or that are behind it.
void end_filter(const RTCFilterFunctionNArguments* args);

/// Rounded outward: a float box must hold what was bounded in double.
inline void set_bounds(const Box3d& box, RTCBounds& out) {
  const auto down = [](double v) { return std::nextafterf(static_cast<float>(v), -INFINITY); };
  const auto up = [](double v) { return std::nextafterf(static_cast<float>(v), INFINITY); };
  out = {down(box.min.x), down(box.min.y), down(box.min.z), 0, up(box.max.x), up(box.max.y), up(box.max.z), 0};
}

/// Of an analytic shape in its group's space.
RTCBounds bounds_of(const AnalyticShape& shape);

/// Where an instance of the world is at a time.
inline Mat4d instance_to_render(RTCScene world, unsigned instance, float time) {
  float m[16];
  rtcGetGeometryTransform(rtcGetGeometry(world, instance), time, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, m);
  Mat4d out;  // column-major, as Embree writes it
  for (int i = 0; i < 16; ++i) out[i / 4][i % 4] = static_cast<double>(m[i]);
  return out;
}

/// A triangle in render space, with what rounding its vertices, and the matrix of its instance, may have moved it by.
EndTriangle end_triangle(const MeshView& mesh, unsigned triangle, const Mat4d* to_render);
/// The same of a triangle in double precision.
EndTriangle end_triangle(const ExactTriangle& triangle, const Mat4d* to_render);

constexpr double kRounding = 0x1p-24;  ///< Half a unit in the last place of 1, in float.

}  // namespace whit
