// A NURBS surface, diced into 30 x 30 points with exact normals as in pbrt-v3; evaluated by de Boor's algorithm
// (1972). Knots must not decrease and weights must be positive.

#include <Imath/ImathVec.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/plugin/memory_need.h"
#include "core/plugin/registry.h"
#include "core/plugin/shape.h"

namespace whit {
namespace {

using Vec4d = Imath::V4d;

Vec3d xyz(const Vec4d& v) { return {v.x, v.y, v.z}; }

/// A homogeneous point and its derivative by the parameter.
struct Jet {
  Vec4d value, slope;
  Vec3d point() const { return xyz(value) / value.w; }
  Vec3d derivative() const { return (xyz(slope) - point() * slope.w) / value.w; }
};

/// One of the two directions of the surface.
struct Axis {
  int points = 0, order = 0;
  std::span<const double> knots;
  double from = 0, to = 1;  ///< The diced interval.

  double domain_begin() const { return knots[static_cast<size_t>(order - 1)]; }
  double domain_end() const { return knots[static_cast<size_t>(points)]; }
  double at(double fraction) const { return std::clamp(from + fraction * (to - from), domain_begin(), domain_end()); }

  /// The knot interval (t_k, t_k+1] that holds t, the first that is not empty at the lower end.
  int span_of(double t) const {
    int k = order - 1;
    while (k < points - 1 && (t > knot(k + 1) || knot(k) == knot(k + 1))) ++k;
    // An empty last interval: the nearest one below that is not.
    while (k > order - 1 && knot(k) == knot(k + 1)) --k;
    return k;
  }

  /// The spline with control points control(0), ... at t.
  template <class Control>
  Jet evaluate(double t, const Control& control) const {
    const int k = span_of(t), p = order - 1;
    std::vector<Vec4d> d(static_cast<size_t>(order));
    const auto at = [&](int j) -> Vec4d& { return d[static_cast<size_t>(j)]; };
    for (int j = 0; j <= p; ++j) at(j) = control(k - p + j);
    for (int r = 1; r < p; ++r) {
      for (int j = p; j >= r; --j) {
        const int i = k - p + j;
        const double alpha = (t - knot(i)) / (knot(i + p - r + 1) - knot(i));
        at(j) = at(j - 1) * (1 - alpha) + at(j) * alpha;
      }
    }
    const double length = knot(k + 1) - knot(k), alpha = (t - knot(k)) / length;
    return {at(p - 1) * (1 - alpha) + at(p) * alpha, (at(p) - at(p - 1)) * (p / length)};
  }

 private:
  double knot(int i) const { return knots[static_cast<size_t>(i)]; }
};

struct Nurbs final : MeshShape, NeedsMemory {
  int nu, nv, uorder, vorder;
  FloatList uknots, vknots, Pw;
  std::optional<float> u0, u1, v0, v1;
  Point3List P;

  void check(Diagnostics& diagnostics, SourcePos statement) override {
    if (is_empty()) return diagnostics.warning(statement, "nurbs has no control points", "it is left out");
    const bool u_ok = check_axis(diagnostics, statement, 'u', nu, uorder, uknots, u0, u1, u_);
    const bool v_ok = check_axis(diagnostics, statement, 'v', nv, vorder, vknots, v0, v1, v_);
    if (u_ok && v_ok) check_points(diagnostics, statement);
  }

  MemoryNeed memory_need(const MeshAttributes&) const override {
    return {.vertices = kDice * kDice, .triangles = 2 * (kDice - 1) * (kDice - 1), .floats = 5};
  }

  bool build_mesh(const PrepareContext& ctx, MeshData& out) override {
    if (is_empty()) return true;
    for (int j = 0; j < kDice; ++j) {
      for (int i = 0; i < kDice; ++i) {
        const double u = u_.at(i / (kDice - 1.0)), v = v_.at(j / (kDice - 1.0));
        const Vec3d p = in_u(u, v).point(), n = normal(u, v);
        out.owned_positions.insert(out.owned_positions.end(), {p.x, p.y, p.z});
        for (int c = 0; c < 3; ++c) out.normals.push_back(static_cast<float>(n[c]));
        out.uvs.insert(out.uvs.end(), {static_cast<float>(u), static_cast<float>(v)});
      }
    }
    out.positions = out.owned_positions;
    for (uint32_t j = 0; j + 1 < kDice; ++j) {
      for (uint32_t i = 0; i + 1 < kDice; ++i) {
        const uint32_t a = j * kDice + i, b = a + 1, c = b + kDice, d = a + kDice;
        out.indices.insert(out.indices.end(), {a, b, c, a, c, d});
      }
    }
    // Where a side is drawn together into a point triangles without area are to be expected.
    remove_degenerate_triangles(out);
    if (out.indices.empty()) ctx.diagnostics->warning(ctx.statement, "nurbs has no area", "it is left out");
    return true;
  }

 private:
  static constexpr int kDice = 30;

  bool is_empty() const { return nu == 0 && nv == 0 && P.size() == 0 && Pw.size() == 0; }
  Vec4d control(int i, int j) const {
    const size_t k = static_cast<size_t>(j) * static_cast<size_t>(nu) + static_cast<size_t>(i);
    if (P.given) return {P.values[3 * k], P.values[3 * k + 1], P.values[3 * k + 2], 1};
    return {Pw.values[4 * k], Pw.values[4 * k + 1], Pw.values[4 * k + 2], Pw.values[4 * k + 3]};
  }
  /// The point with its derivative by u, or by v.
  Jet in_u(double u, double v) const {
    return u_.evaluate(u, [&](int i) { return v_.evaluate(v, [&](int j) { return control(i, j); }).value; });
  }
  Jet in_v(double u, double v) const {
    return v_.evaluate(v, [&](int j) { return u_.evaluate(u, [&](int i) { return control(i, j); }).value; });
  }

  /// The unit normal. Where a derivative vanishes (a side drawn together into a point) it is the limit from the
  /// inside of the surface; a surface without area gets z.
  Vec3d normal(double u, double v) const {
    const double mid_u = u_.at(0.5), mid_v = v_.at(0.5);
    for (const double step : {0.0, 1e-6, 1e-3}) {
      const double us = u + (mid_u - u) * step, vs = v + (mid_v - v) * step;
      const Vec3d du = in_u(us, vs).derivative(), dv = in_v(us, vs).derivative(), n = du.cross(dv);
      // Parallel but for rounding is parallel.
      if (n.length() > 1e-12 * du.length() * dv.length()) return n.normalized();
    }
    return {0, 0, 1};
  }

  static bool check_axis(Diagnostics& diagnostics, SourcePos statement, char name, int points, int order,
                         const FloatList& knots, const std::optional<float>& begin, const std::optional<float>& end,
                         Axis& axis) {
    const auto fail = [&](SourcePos where, std::string text) {
      diagnostics.error(where, "nurbs: " + std::move(text));
      return false;
    };
    if (order < 2) return fail(statement, fmt::format("\"{}order\" must be given, and at least 2", name));
    if (points < order) {
      return fail(statement, fmt::format("\"n{0}\" is {1}, but \"{0}order\" {2} needs at least as many points", name,
                                         points, order));
    }
    const int64_t wanted = int64_t{points} + order;
    if (!knots.given) return fail(statement, fmt::format("\"{}knots\" is missing", name));
    if (static_cast<int64_t>(knots.size()) != wanted) {
      return fail(knots.where,
                  fmt::format("number of knots does not match: \"{0}knots\" has {1}, expected {2} (n{0} {3} "
                              "plus {0}order {4})",
                              name, knots.size(), wanted, points, order));
    }
    if (!std::is_sorted(knots.values.begin(), knots.values.end())) {
      return fail(knots.where, fmt::format("\"{}knots\" must not decrease", name));
    }
    axis = {points, order, knots.values, 0, 1};
    const double low = axis.domain_begin(), high = axis.domain_end();
    if (!(low < high)) return fail(knots.where, fmt::format("\"{}knots\" span no interval", name));
    axis.from = begin ? static_cast<double>(*begin) : low, axis.to = end ? static_cast<double>(*end) : high;
    // The ends are floats, the knots doubles: an end may miss its knot by a rounding.
    const double slack = 1e-6 * (high - low);
    if (std::min(axis.from, axis.to) < low - slack || std::max(axis.from, axis.to) > high + slack) {
      return fail(statement,
                  fmt::format("\"{0}0\" and \"{0}1\" must lie between the knots {1} and {2}", name, low, high));
    }
    return true;
  }

  void check_points(Diagnostics& diagnostics, SourcePos statement) const {
    if (!P.given && !Pw.given) return diagnostics.error(statement, "nurbs has neither \"P\" nor \"Pw\"");
    const char* name = P.given ? "P" : "Pw";
    const size_t each = P.given ? 3 : 4, found = P.given ? P.size() : Pw.size();
    const SourcePos where = P.given ? P.where : Pw.where;
    const uint64_t wanted = static_cast<uint64_t>(nu) * static_cast<uint64_t>(nv);
    if (found != each * wanted) {
      return diagnostics.error(where, fmt::format("nurbs: \"{}\" has {} numbers, expected {} ({} for each of {} x {} "
                                                  "control points)",
                                                  name, found, each * wanted, each, nu, nv));
    }
    for (size_t i = 3; !P.given && i < found; i += 4) {
      if (!(Pw.values[i] > 0))
        return diagnostics.error(where, "nurbs: weights (every fourth of \"Pw\") must be above 0");
    }
  }

  Axis u_, v_;
};

const Register<Nurbs> nurbs{
    "nurbs",
    "A NURBS surface, diced into triangles.",
    param(&Nurbs::nu, "nu", Unit::None, "Number of control points in u. Required.", kNonNegative),
    param(&Nurbs::uorder, "uorder", Unit::None, "Order in u: degree plus one. Required.", kNonNegative),
    param(&Nurbs::uknots, "uknots", Unit::None, "Knots in u, nu plus uorder of them. Required.", kCoordinates),
    param(&Nurbs::u0, "u0", Unit::None, "Where the surface begins in u; by default where the knots let it."),
    param(&Nurbs::u1, "u1", Unit::None, "Where the surface ends in u; by default where the knots let it."),
    param(&Nurbs::nv, "nv", Unit::None, "Number of control points in v. Required.", kNonNegative),
    param(&Nurbs::vorder, "vorder", Unit::None, "Order in v: degree plus one. Required.", kNonNegative),
    param(&Nurbs::vknots, "vknots", Unit::None, "Knots in v, nv plus vorder of them. Required.", kCoordinates),
    param(&Nurbs::v0, "v0", Unit::None, "Where the surface begins in v; by default where the knots let it."),
    param(&Nurbs::v1, "v1", Unit::None, "Where the surface ends in v; by default where the knots let it."),
    param(&Nurbs::P, "P", Unit::Length, "Control points, u running fastest; or else Pw. Required.", kCoordinates),
    param(&Nurbs::Pw, "Pw", Unit::None, "Homogeneous control points x y z w, used when P is absent.", kCoordinates)};

}  // namespace
}  // namespace whit
