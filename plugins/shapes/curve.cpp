// Hair and grass: cubic Bezier segments with a width, made of Bezier or uniform B-spline control points of degree 2
// or 3 as in pbrt-v3; u runs from 0 to 1 over every segment, and widths change linearly over the whole curve.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/quadratic.h"
#include "core/plugin/memory_need.h"
#include "core/plugin/registry.h"
#include "core/plugin/shape.h"

namespace whit {

/// An integer that may be written as a float, which pbrt-v3 truncates; the integer is taken where both are given.
struct SplitDepth {
  int value = 0;
  bool is_integer = false;
};

template <>
struct detail::Binding<SplitDepth> {
  static std::vector<ParamType> accepts() { return {ParamType::Integer, ParamType::Float}; }
  static std::string to_text(const SplitDepth& depth) { return std::to_string(depth.value); }
  static bool read(const Parameter& p, const BindContext& ctx, const Range& range, SplitDepth& out) {
    if (p.type == ParamType::Integer) {
      // Only one value is a value, here and there.
      out.is_integer = p.integers().size() == 1;
      return Binding<int>::read(p, ctx, range, out.value);
    }
    auto number = static_cast<float>(out.value);
    if (!Binding<float>::read(p, ctx, range, number)) return false;
    if (!out.is_integer) out.value = static_cast<int>(std::clamp(number, -1e9f, 1e9f));
    return true;
  }
};

namespace {

using Bezier = std::array<Vec3d, 4>;

Vec3d mix(double t, const Vec3d& a, const Vec3d& b) { return a * (1 - t) + b * t; }

/// The cubic equal to a quadratic Bezier curve.
Bezier elevate(const Vec3d& a, const Vec3d& b, const Vec3d& c) { return {a, mix(2. / 3, a, b), mix(1. / 3, b, c), c}; }

/// The Bezier control points of a uniform B-spline's segment, by blossoming.
Bezier from_bspline(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return elevate(mix(0.5, a, b), b, mix(0.5, b, c));
}
Bezier from_bspline(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const Vec3d p1 = mix(1. / 3, b, c), p2 = mix(2. / 3, b, c);
  return {mix(0.5, mix(2. / 3, a, b), p1), p1, p2, mix(0.5, p2, mix(1. / 3, c, d))};
}

/// Any unit vector across n, which has a length.
Vec3d across(const Vec3d& n) {
  return n.cross(std::abs(n.x) < 0.6 * n.length() ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)).normalized();
}

/// Control points of normals that turn from a to b on the shortest way. Of opposite normals, which have none, the
/// way around the segment's direction is taken.
Bezier turning_normals(const Vec3d& a, const Vec3d& b, const Vec3d& along) {
  const double angle = std::atan2(a.cross(b).length(), a.dot(b));
  if (angle < 1e-9) return {a, a, b, b};
  Vec3d axis = a.cross(b);
  if (angle > kPiD - 1e-6) {
    axis = along - a * along.dot(a);
    if (!(axis.length() > 1e-9 * along.length())) axis = across(a);
  }
  axis.normalize();
  // The handles that make a cubic an arc of a circle.
  const double handle = 4. / 3 * std::tan(angle / 4);
  return {a, a + axis.cross(a) * handle, b - axis.cross(b) * handle, b};
}

struct Curve final : CurveShape, NeedsMemory {
  Point3List P;
  NormalList N;
  float width;
  std::optional<float> width0, width1;
  int degree;
  SplitDepth splitdepth;
  Choice type, basis;

  void check(Diagnostics& diagnostics, SourcePos statement) override {
    if (P.size() == 0) return diagnostics.warning(statement, "curve has no \"P\"", "it is left out");
    const int n = static_cast<int>(P.size() / 3);
    const bool fits = is_bspline() ? n >= degree + 1 : n >= degree + 1 && (n - 1) % degree == 0;
    if (!fits) {
      return diagnostics.error(
          P.where, fmt::format("number of control points does not fit: degree {} {} needs {}{}, not {}", degree,
                               is_bspline() ? "bspline" : "bezier", degree + 1,
                               is_bspline() ? " or more" : fmt::format(" + n * {}", degree), n));
    }
    check_normals(diagnostics, statement);
  }

  MemoryNeed memory_need(const MeshAttributes&) const override {
    if (P.size() == 0) return {};
    return {
        .segments = segments(), .pieces = uint64_t{1} << split_depth(), .ribbon = kind() == CurveData::Kind::Ribbon};
  }

  bool build_curves(const PrepareContext&, CurveData& out) override {
    if (P.size() == 0) return true;
    out.kind = kind();
    out.split_depth = split_depth();
    const size_t n = segments();
    for (size_t s = 0; s < n; ++s) {
      const Bezier b = segment(s);
      for (const Vec3d& p : b) out.control_points.insert(out.control_points.end(), {p.x, p.y, p.z});
      for (size_t i = 0; i < 4; ++i)
        out.widths.push_back(width_at((static_cast<double>(s) + static_cast<double>(i) / 3) / static_cast<double>(n)));
      if (out.kind == CurveData::Kind::Ribbon) {
        for (const Vec3d& v : turning_normals(normal(s), normal(s + 1), b[3] - b[0]))
          for (int c = 0; c < 3; ++c) out.normals.push_back(static_cast<float>(v[c]));
      }
      out.u_range.insert(out.u_range.end(), {0.0f, 1.0f});
    }
    return true;
  }

 private:
  bool is_bspline() const { return basis.index == 1; }
  CurveData::Kind kind() const {
    constexpr CurveData::Kind kKinds[] = {CurveData::Kind::Flat, CurveData::Kind::Ribbon, CurveData::Kind::Cylinder};
    return kKinds[type.index];
  }
  /// 32 pieces bound any curve well; more only cost memory.
  int split_depth() const { return std::clamp(splitdepth.value, 0, 5); }
  size_t segments() const {
    const size_t n = P.size() / 3, d = static_cast<size_t>(degree);
    return is_bspline() ? n - d : (n - 1) / d;
  }
  Vec3d point(size_t i) const { return {P.values[3 * i], P.values[3 * i + 1], P.values[3 * i + 2]}; }
  Vec3d normal(size_t i) const { return Vec3d(N.values[3 * i], N.values[3 * i + 1], N.values[3 * i + 2]).normalized(); }

  Bezier segment(size_t s) const {
    const size_t i = is_bspline() ? s : s * static_cast<size_t>(degree);
    const Vec3d a = point(i), b = point(i + 1), c = point(i + 2);
    if (degree == 2) return is_bspline() ? from_bspline(a, b, c) : elevate(a, b, c);
    const Vec3d d = point(i + 3);
    return is_bspline() ? from_bspline(a, b, c, d) : Bezier{a, b, c, d};
  }

  float width_at(double t) const {
    const double a = static_cast<double>(width0.value_or(width)), b = static_cast<double>(width1.value_or(width));
    return static_cast<float>(a * (1 - t) + b * t);
  }

  void check_normals(Diagnostics& diagnostics, SourcePos statement) const {
    if (kind() != CurveData::Kind::Ribbon) {
      if (N.given)
        diagnostics.warning(N.where, "normals of a curve matter only to the type \"ribbon\"", "they are not used");
      return;
    }
    if (!N.given) return diagnostics.error(statement, "a curve of type \"ribbon\" needs normals \"N\"");
    if (N.size() != 3 * (segments() + 1)) {
      return diagnostics.error(N.where, fmt::format("curve has {} segments, which need {} normals, not {}", segments(),
                                                    segments() + 1, N.size() / 3));
    }
    for (size_t i = 0; i + 2 < N.size(); i += 3) {
      if (N.values[i] == 0 && N.values[i + 1] == 0 && N.values[i + 2] == 0) {
        return diagnostics.error(N.where, fmt::format("normal {} of the curve is zero", i / 3));
      }
    }
  }
};

const Register<Curve> curve{
    "curve",
    "A curve with a width: hair, grass, ribbons.",
    param(&Curve::P, "P", Unit::Length,
          "Control points: of degree d, d + 1 and d more for every further Bezier segment. Required.", kCoordinates),
    choice(&Curve::type, "type", {"flat", "ribbon", "cylinder"},
           "Flat curves face the ray, cylinders too but are shaded as tubes, ribbons are turned by normals."),
    choice(&Curve::basis, "basis", {"bezier", "bspline"},
           "Control points of Bezier segments end to end, or of one uniform B-spline."),
    param(&Curve::degree, "degree", 3, Unit::None, "Degree of the polynomial.", Range{2.0, 3.0}),
    param(&Curve::width, "width", 1.0f, Unit::Length, "Full width.", kNonNegative),
    param(&Curve::width0, "width0", Unit::Length, "Width at the start; width by default.", kNonNegative),
    param(&Curve::width1, "width1", Unit::Length, "Width at the end; width by default.", kNonNegative),
    param(&Curve::N, "N", Unit::None, "Normals of a ribbon, one at each end of every segment.", kCoordinates),
    param(&Curve::splitdepth, "splitdepth", SplitDepth{3}, Unit::None,
          "Segments are bounded in 2^splitdepth pieces, at most 32: faster for long curves, at the cost of memory.")};

}  // namespace
}  // namespace whit
