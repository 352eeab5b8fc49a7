#include "core/plugin/shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace whit {
namespace {

/// The inverse of an affine map, in the long double of the machine: cofactors cancel where a transform is
/// badly conditioned, and eleven more bits pay for that.
Mat4d affine_inverse(const Mat4d& m) {
  using Real = long double;
  Real cofactor[3][3];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      cofactor[i][j] = Real(m[i1][j1]) * Real(m[i2][j2]) - Real(m[i1][j2]) * Real(m[i2][j1]);
    }
  }
  const Real det = Real(m[0][0]) * cofactor[0][0] + Real(m[0][1]) * cofactor[0][1] + Real(m[0][2]) * cofactor[0][2];
  Mat4d inverse;
  for (int j = 0; j < 3; ++j) {
    Real shift = 0;
    for (int i = 0; i < 3; ++i) {
      const Real element = cofactor[j][i] / det;  // Row i, column j of the inverse is cofactor (j, i) / det.
      inverse[i][j] = static_cast<double>(element);
    }
    for (int i = 0; i < 3; ++i) shift -= Real(m[3][i]) * (cofactor[j][i] / det);
    inverse[3][j] = static_cast<double>(shift);
  }
  return inverse;
}

/// u x v of the transformed tangents, given n = u x v: the cofactor matrix applied to n. Its length is the
/// factor by which an area of unit normal n grows; its sign includes that of the determinant.
Vec3d transform_area(const Mat4d& m, const Vec3d& n) {
  const Vec3d x{m[0][0], m[0][1], m[0][2]}, y{m[1][0], m[1][1], m[1][2]}, z{m[2][0], m[2][1], m[2][2]};
  return n.x * y.cross(z) + n.y * z.cross(x) + n.z * x.cross(y);
}

/// Also where a corner is not finite, or not as a float.
bool has_no_area(const double* a, const double* b, const double* c) {
  const auto is_float = [](double v) { return std::abs(v) <= static_cast<double>(std::numeric_limits<float>::max()); };
  for (int k = 0; k < 3; ++k) {
    if (!is_float(a[k]) || !is_float(b[k]) || !is_float(c[k])) return true;
  }
  Vec3d e1{b[0] - a[0], b[1] - a[1], b[2] - a[2]}, e2{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  // Brought to size one first: the squares of a mesh of size 1e-200 underflow.
  const auto largest = [](const Vec3d& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
  const double s1 = largest(e1), s2 = largest(e2);
  if (!(s1 > 0) || !(s2 > 0)) return true;
  e1 /= s1, e2 /= s2;
  // The sine of the angle at a is below four roundings.
  constexpr double kSine = 4 * 2.220446049250313e-16;
  return e1.cross(e2).length2() <= kSine * kSine * e1.length2() * e2.length2() ||
         (a[0] == b[0] && a[1] == b[1] && a[2] == b[2]) || (b[0] == c[0] && b[1] == c[1] && b[2] == c[2]);
}

}  // namespace

SurfacePoint AnalyticShape::surface(const Vec3d& p) const {
  SurfacePointLanes s;
  s.n = 1, s.p.set(0, p);
  surfaces(s);
  return {s.p[0], s.p_error[0], s.u[0], s.v[0], s.dpdu[0], s.dpdv[0], s.dndu[0], s.dndv[0]};
}

namespace detail {

template <>
std::vector<ParamType> Binding<UvList>::accepts() {
  return {ParamType::Point2, ParamType::Float};
}
template <>
std::string Binding<UvList>::to_text(const UvList&) {
  return {};
}
template <>
bool Binding<UvList>::read(const Parameter& p, const BindContext& ctx, const Range& range, UvList& out) {
  const auto& v = p.numbers();
  for (size_t i = 0; i < v.size(); ++i) {
    if (std::isfinite(v[i]) && v[i] >= range.min && v[i] <= range.max) continue;
    ctx.diagnostics->error(ctx.at(p, i), '"' + p.name + "\" of " + ctx.statement_name + " is not a usable number");
    return false;
  }
  out.values = v;
  out.where = p.values_at;
  out.given = true;
  return true;
}

}  // namespace detail

namespace {

/// Which triangles are an earlier one again: the same corners in the same order, whichever comes first.
std::vector<bool> find_repeated(const std::vector<uint32_t>& indices, size_t vertices) {
  const size_t triangles = indices.size() / 3;
  const auto rotated = [&](uint32_t t) {
    const uint32_t* i = &indices[3 * size_t{t}];
    const int first = i[0] <= i[1] && i[0] <= i[2] ? 0 : i[1] <= i[2] ? 1 : 2;
    return std::array<uint32_t, 3>{i[first], i[(first + 1) % 3], i[(first + 2) % 3]};
  };
  // Sorted by counting by their least corner, in the order of the mesh; few triangles share one.
  std::vector<uint32_t> start(vertices + 1), order(triangles);
  for (uint32_t t = 0; t < triangles; ++t) ++start[rotated(t)[0] + 1];
  for (size_t v = 0; v < vertices; ++v) start[v + 1] += start[v];
  for (uint32_t t = 0; t < triangles; ++t) order[start[rotated(t)[0]]++] = t;
  std::vector<bool> repeated(triangles);
  for (size_t first = 0, last; first < triangles; first = last) {
    last = first + 1;
    while (last < triangles && rotated(order[last])[0] == rotated(order[first])[0]) ++last;
    if (last - first < 2) continue;
    std::sort(order.begin() + static_cast<ptrdiff_t>(first), order.begin() + static_cast<ptrdiff_t>(last),
              [&](uint32_t a, uint32_t b) { return std::pair(rotated(a), a) < std::pair(rotated(b), b); });
    for (size_t k = first + 1; k < last; ++k) {
      if (rotated(order[k]) == rotated(order[k - 1])) repeated[order[k]] = true;
    }
  }
  return repeated;
}

}  // namespace

size_t remove_degenerate_triangles(MeshData& mesh) {
  const double* p = mesh.positions.data();
  const std::vector<bool> repeated = find_repeated(mesh.indices, mesh.positions.size() / 3);
  size_t kept = 0;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
    if (repeated[i / 3] || has_no_area(p + 3 * size_t{a}, p + 3 * size_t{b}, p + 3 * size_t{c})) continue;
    mesh.indices[kept++] = a, mesh.indices[kept++] = b, mesh.indices[kept++] = c;
  }
  const size_t removed = (mesh.indices.size() - kept) / 3;
  mesh.indices.resize(kept);
  return removed;
}

void AnalyticShape::report_no_surface(Diagnostics& diagnostics, SourcePos statement, const std::string& why) {
  diagnostics.warning(statement, "shape without surface: " + why, "left out; the picture is the same without");
  no_surface_ = true;
}

void AnalyticShape::place(const Mat4d& object_to_scene, bool reverse_orientation) {
  object_to_scene_ = object_to_scene;
  scene_to_object_ = affine_inverse(object_to_scene);
  flips_ = reverse_orientation != swaps_handedness(object_to_scene);
}

/// The object's area times how much areas grow, on average over samples of it.
double AnalyticShape::placed_area() const {
  constexpr int kSide = 8;
  double area = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const ShapeSample s = sample_area((i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide);
    area += transform_area(object_to_scene_, s.n.normalized()).length() / (s.pdf * kSide * kSide);
  }
  return area;
}

ShapeSample AnalyticShape::sample_from(const Vec3d& ref, double u0, double u1) const {
  const ShapeSample object = sample_area(u0, u1);
  ShapeSample s;
  s.p = transform_point(object_to_scene_, object.p);
  // An object area dA becomes |area| dA. Outward stays outward under a mirroring, so the determinant's sign goes.
  Vec3d area = transform_area(object_to_scene_, object.n.normalized());
  if (swaps_handedness(object_to_scene_)) area = -area;
  const double growth = area.length();
  s.n = area / (flips_ ? -growth : growth);
  const Vec3d to = s.p - ref;
  const double distance2 = to.length2();
  // pdf_omega = pdf_area d^2 / cos, cos = |n . to| / d.
  const double projected = std::abs(s.n.dot(to)) * growth;
  const double pdf = object.pdf * distance2 * std::sqrt(distance2) / projected;
  s.pdf = std::isfinite(pdf) && pdf > 0 ? pdf : 0;
  return s;
}

double AnalyticShape::density_from(const Vec3d& ref, const Vec3d& p) const {
  const SurfacePoint at = surface(transform_point(scene_to_object_, p));
  const Vec3d area = transform_area(object_to_scene_, at.dpdu.cross(at.dpdv).normalized()), to = p - ref;
  const double distance2 = to.length2(), projected = std::abs(area.dot(to));
  const double pdf = sample_area(0.5, 0.5).pdf * distance2 * std::sqrt(distance2) / projected;
  return std::isfinite(pdf) && pdf > 0 ? pdf : 0;
}

void set_sample(const ShapeSampleLanes& s, int i, const ShapeSample& sample) {
  const Vec3d to = sample.p - Vec3d(s.ref[i]);
  const double distance = to.length();
  const Vec3d wi = distance > 0 ? to / distance : Vec3d(0, 0, 1);
  s.wi.set(i, Vec3f(wi));
  s.distance[i] = static_cast<float>(distance);
  s.cosine[i] = static_cast<float>(-sample.n.dot(wi));
  s.pdf[i] = distance > 0 ? static_cast<float>(sample.pdf) : 0.0f;
}

void AnalyticShape::sample_lanes(const ShapeSampleLanes& s) const {
  for (int i = 0; i < s.n; ++i)
    set_sample(s, i, sample_from(Vec3d(s.ref[i]), static_cast<double>(s.u[i]), static_cast<double>(s.v[i])));
}

}  // namespace whit
