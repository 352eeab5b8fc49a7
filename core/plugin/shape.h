// Shapes: triangle meshes, which core hands to the ray tracer as they are, and analytic shapes (quadrics),
// which intersect batches of rays themselves in double precision.
#pragma once

#include <cstdint>
#include <vector>

#include "core/batch/lanes.h"
#include "core/batch/shading.h"
#include "core/plugin/param.h"
#include "core/plugin/texture.h"

namespace whit {

class Shape : public Plugin {
 public:
  static constexpr const char* kCategory = "shape";
  Tex<float> alpha{1.0f};         ///< Where exactly 0 the surface is not there.
  Tex<float> shadow_alpha{1.0f};  ///< The same, for shadow rays only, in addition to alpha.

  /// Whether parts of it are cut away, or may be.
  bool is_cut_out() const {
    const auto cuts = [](const Tex<float>& a) { return !a.is_constant() || a.value() == 0; };
    return cuts(alpha) || cuts(shadow_alpha);
  }
};

/// For lists of coordinates: any number that is one. NaN, infinity and what a float cannot hold are errors at
/// the value's own place.
inline constexpr Range kCoordinates{-std::numeric_limits<float>::max(), std::numeric_limits<float>::max()};

/// The alpha parameters of shapes that can be cut out.
inline auto alpha_param() {
  return param(&Shape::alpha, "alpha", 1.0f, Unit::None, "Where this is exactly 0 the surface is cut away.");
}
inline auto shadowalpha_param() {
  return param(&Shape::shadow_alpha, "shadowalpha", 1.0f, Unit::None,
               "Where this is exactly 0 the surface casts no shadow.");
}

/// A triangle mesh in object space. Positions may stay in the scene description (positions) or be owned.
struct MeshData {
  std::span<const double> positions;  ///< Flat, 3 per vertex, object space.
  std::vector<double> owned_positions;
  std::vector<uint32_t> indices;  ///< 3 per triangle, counter-clockwise seen from the front.
  std::vector<float> normals;     ///< Flat, 3 per vertex, object space, or empty.
  std::vector<float> tangents;    ///< pbrt's "S", flat, 3 per vertex, or empty.
  std::vector<float> uvs;         ///< Flat, 2 per vertex, or empty.
  std::vector<float> uvs1;        ///< A second set, or empty.
  std::vector<float> colors;      ///< Flat, 4 per vertex: linear red, green, blue and alpha, or empty.
  /// Of each vertex, with `tangents`: where it is negative the bitangent is cross(tangent, normal), elsewhere, and where
  /// this is empty, cross(normal, tangent). Only normal maps ask.
  std::vector<float> bitangent_signs;
  size_t degenerate = 0;  ///< How many triangles of the user's were left out because they have no area.
};

/// Removes the triangles that have no area (two corners alike, or all three on a line as far as double precision can
/// tell), a corner that is not finite, or all corners in common with an earlier one, in the same order. Returns how many
/// there were.
size_t remove_degenerate_triangles(MeshData& mesh);

/// A shape that is, or turns itself into, a triangle mesh.
class MeshShape : public Shape {
 public:
  /// Reads or builds the mesh; what PrepareContext::attributes does not ask for may be left out. Indices are valid and no value is NaN or infinite when this returns true;
  /// otherwise an error has been reported.
  virtual bool build_mesh(const PrepareContext& ctx, MeshData& out) = 0;
};

/// Rays for analytic shapes, in object space and double precision. Directions are not unit vectors: t is
/// the same number in every space.
struct ObjectRays {
  int n = 0;
  const double *ox = nullptr, *oy = nullptr, *oz = nullptr;
  const double *dx = nullptr, *dy = nullptr, *dz = nullptr;
  const double* t_min = nullptr;
  double* t = nullptr;  ///< In: t_max. Out: the nearest hit in (t_min, t_max), or unchanged.
};

/// A point of an analytic shape with its local geometry, in object space.
struct SurfacePoint {
  Vec3d p;        ///< On the surface (refined).
  Vec3d p_error;  ///< Bound on |p - exact| per component.
  double u = 0, v = 0;
  Vec3d dpdu, dpdv;
  Vec3d dndu, dndv;  ///< Derivatives of the unit normal normalize(dpdu x dpdv).
};

/// Vectors of SurfacePointLanes.
struct SurfaceVectors {
  static constexpr int kWidth = 64;
  double x[kWidth], y[kWidth], z[kWidth];
  Vec3d operator[](int i) const { return {x[i], y[i], z[i]}; }
  void set(int i, const Vec3d& v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
};

/// SurfacePoint for up to kWidth hits of one shape, structure of arrays: few enough to stay in the cache.
struct SurfacePointLanes {
  static constexpr int kWidth = SurfaceVectors::kWidth;
  int n = 0;
  SurfaceVectors p;  ///< In: the computed hits. Out: on the surface.
  SurfaceVectors p_error, dpdu, dpdv, dndu, dndv;
  double u[kWidth], v[kWidth];
};

/// Replaces every hit of s by point(hit), a SurfacePoint.
template <class PointAt>
[[gnu::flatten]] inline void for_surface_points(SurfacePointLanes& s, const PointAt& point) {
  for_lanes(s.n, [&s, &point](int i) {
    const SurfacePoint at = point(s.p[i]);
    s.p.set(i, at.p), s.p_error.set(i, at.p_error);
    s.u[i] = at.u, s.v[i] = at.v;
    s.dpdu.set(i, at.dpdu), s.dpdv.set(i, at.dpdv);
    s.dndu.set(i, at.dndu), s.dndv.set(i, at.dndv);
  });
}

/// A point sampled on a shape for lighting.
struct ShapeSample {
  Vec3d p;     ///< In the space of the shape's placement.
  Vec3d n;     ///< Unit, oriented as the shape's front.
  double pdf;  ///< Density with respect to solid angle at the reference point, or to area (see the call).
};

/// One sample of a shape for each of n reference points, structure of arrays, in the space of the placement.
struct ShapeSampleLanes {
  int n = 0;
  Vec3Lanes ref;                           ///< In: reference points.
  const float *u = nullptr, *v = nullptr;  ///< In: uniform numbers in [0,1).
  Vec3Lanes wi;                            ///< Out: unit direction from ref to the sampled point.
  float* distance = nullptr;               ///< Out: to the point.
  float* cosine = nullptr;                 ///< Out: between the front's normal and -wi; negative behind.
  float* pdf = nullptr;                    ///< Out: per solid angle at ref; 0 when the sample is useless.
};

/// Writes the i-th sample of a batch.
void set_sample(const ShapeSampleLanes& s, int i, const ShapeSample& sample);

/// A shape given by equations. It is placed once: object space to the space of its scene (render space, or
/// the local space of an object definition).
class AnalyticShape : public Shape {
 public:
  void place(const Mat4d& object_to_scene, bool reverse_orientation);
  const Mat4d& object_to_scene() const { return object_to_scene_; }
  const Mat4d& scene_to_object() const { return scene_to_object_; }
  /// True when normals flip: ReverseOrientation XOR the transform swaps handedness.
  bool flips_normals() const { return flips_; }

  /// True when there is nothing to hit, as with a radius of 0: the shape is left out, and nothing else is asked of it.
  bool has_no_surface() const { return no_surface_; }

  virtual Box3d object_bounds() const = 0;

  /// Finds the nearest hits, without cancellation: t within 2 ulp of the exact root.
  virtual void intersect(const ObjectRays& rays) const = 0;

  /// True when no line that arrives at the front of the shape has met the shape before, as with convex shapes that face
  /// outward: shadow rays to it then need not be tested against it.
  virtual bool cannot_shade_itself() const { return false; }

  /// True when the shape lies in a plane, with one front.
  virtual bool is_planar() const { return false; }

  /// The local geometry at hits; object space. Shapes write it for one point and let for_surface_points() loop.
  virtual void surfaces(SurfacePointLanes& s) const = 0;
  /// The same for one hit.
  SurfacePoint surface(const Vec3d& p) const;

  /// The point of the surface at parameters in [0,1)^2 uniform in *object-space* area, with its unnormalised
  /// outward object-space normal direction dpdu x dpdv (before flips) as n, and pdf = 1 / object area.
  virtual ShapeSample sample_area(double u0, double u1) const = 0;

  /// The area of the placed shape: exact of planar shapes and where the placement stretches all ways alike, else about.
  double placed_area() const;

  /// A point on the shape as seen from `ref`, all in scene space (see place()), for u in [0,1)^2; pdf with
  /// respect to solid angle at ref, 0 when the sample is useless. The default samples by area, with the
  /// exact Jacobian of the placement; the sphere samples its cone.
  virtual ShapeSample sample_from(const Vec3d& ref, double u0, double u1) const;

  /// The density of sample_from(ref) at a point p of the placed surface: per solid angle at ref.
  virtual double density_from(const Vec3d& ref, const Vec3d& p) const;

  /// sample_from() for a batch; by default one by one.
  virtual void sample_lanes(const ShapeSampleLanes& s) const;

 protected:
  /// For check(): warns that the statement's shape has no surface, and why; it is left out.
  void report_no_surface(Diagnostics& diagnostics, SourcePos statement, const std::string& why);

  Mat4d object_to_scene_, scene_to_object_;
  bool flips_ = false;

 private:
  bool no_surface_ = false;
};

/// Cubic Bezier segments with widths. All face the ray. Flat: and are shaded so. Cylinder: shaded as a tube. Ribbon:
/// turned by the normals, and the narrower the more they turn away.
struct CurveData {
  enum class Kind { Flat, Ribbon, Cylinder } kind = Kind::Flat;
  std::vector<double> control_points;  ///< Cubic Bezier, 4 x 3 per segment, object space.
  std::vector<float> widths;           ///< 4 per segment, linear along it, object space, full width (not radius).
  std::vector<float> normals;          ///< Ribbon: 4 x 3 per segment, an arc of the unit sphere as a Bezier curve.
  std::vector<float> u_range;          ///< 2 per segment: u at its start and end.
  int split_depth = 3;                 ///< Segments are traced in 2^split_depth pieces.
};

/// A shape made of curves (hair, grass), traced by core/accel/curve.cpp.
class CurveShape : public Shape {
 public:
  virtual bool build_curves(const PrepareContext& ctx, CurveData& out) = 0;
};

}  // namespace whit
