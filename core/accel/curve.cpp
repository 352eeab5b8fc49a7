// A ray meets a curve where it passes the centre line within half the width, measured across the ray (Pharr, Jakob,
// Humphreys, PBR 3e, section 3.7). The curve is seen along the ray and halved until it is straight for its width;
// each part is a line between the perpendiculars to the curve at its ends. All in double, relative to the ray: hair is
// thin and far away.

#include "core/accel/curve.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/batch/lanes.h"

namespace whit {
namespace {

using Bezier = std::array<Vec3d, 4>;

Vec3d mix(const Vec3d& a, const Vec3d& b, double t) { return a * (1 - t) + b * t; }

/// The blossom of a cubic: its control points between r and s are those of (r r r), (r r s), (r s s), (s s s).
Vec3d blossom(const Bezier& p, double r, double s, double t) {
  const Vec3d a[3] = {mix(p[0], p[1], r), mix(p[1], p[2], r), mix(p[2], p[3], r)};
  return mix(mix(a[0], a[1], s), mix(a[1], a[2], s), t);
}

std::array<Bezier, 2> halves(const Bezier& p) {
  const Vec3d a = (p[0] + p[1]) / 2, b = (p[1] + p[2]) / 2, c = (p[2] + p[3]) / 2;
  const Vec3d ab = (a + b) / 2, bc = (b + c) / 2, middle = (ab + bc) / 2;
  return {Bezier{p[0], a, ab, middle}, Bezier{middle, bc, c, p[3]}};
}

/// A part of a segment in the curves' own space.
struct Piece {
  Bezier p;
  double u0, u1;
  double width0, width1;  ///< Of the whole segment.
  const float* normals;   ///< Of a ribbon, else null.

  Piece(const CurveView& curves, size_t piece) {
    const size_t segment = curves.segment_of(piece), part = piece - (segment << curves.split_depth);
    const float* c = curves.control_points + 16 * segment;
    const Bezier whole{Vec3d(c[0], c[1], c[2]), Vec3d(c[4], c[5], c[6]), Vec3d(c[8], c[9], c[10]),
                       Vec3d(c[12], c[13], c[14])};
    u0 = std::ldexp(static_cast<double>(part), -curves.split_depth);
    u1 = std::ldexp(static_cast<double>(part + 1), -curves.split_depth);
    p = {blossom(whole, u0, u0, u0), blossom(whole, u0, u0, u1), blossom(whole, u0, u1, u1),
         blossom(whole, u1, u1, u1)};
    width0 = 2 * static_cast<double>(c[3]), width1 = 2 * static_cast<double>(c[15]);
    normals = curves.normals ? curves.normals + 12 * segment : nullptr;
  }
  double width(double u) const { return width0 * (1 - u) + width1 * u; }
  double half_width() const { return std::max(width(u0), width(u1)) / 2; }
};

/// Any unit vector across the unit vector d.
Vec3d across(const Vec3d& d) { return d.cross(std::abs(d.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)).normalized(); }

/// One ray against one piece, in coordinates that have the ray as z axis and the piece's chord along x.
class SeenCurve {
 public:
  SeenCurve(const Piece& piece, const Vec3d& o, const Vec3d& d, double t_min, double t_max)
      : piece_(piece), t_min_(t_min), t_max_(t_max), length_(d.length()), z_(d / length_) {
    const Vec3d side = z_.cross(piece.p[3] - piece.p[0]);
    const Vec3d y = side.length2() > 0 ? side.normalized() : across(z_), x = y.cross(z_);
    for (size_t i = 0; i < 4; ++i) {
      const Vec3d r = piece.p[i] - o;
      seen_[i] = {r.dot(x), r.dot(y), r.dot(z_)};
    }
  }

  bool intersect(CurveHit& hit) {
    if (piece_.half_width() > 0 && may_hit(seen_, piece_.u0, piece_.u1)) {
      descend(seen_, piece_.u0, piece_.u1, depth_needed());
    }
    hit = hit_;
    return found_;
  }

 private:
  /// Whether the ray passes the box of the control points, as wide as the curve is there.
  bool may_hit(const Bezier& p, double u0, double u1) const {
    const double r = std::max(piece_.width(u0), piece_.width(u1)) / 2;
    const auto [y0, y1] = std::minmax({p[0].y, p[1].y, p[2].y, p[3].y});
    if (y1 < -r || y0 > r) return false;
    const auto [x0, x1] = std::minmax({p[0].x, p[1].x, p[2].x, p[3].x});
    if (x1 < -r || x0 > r) return false;
    const auto [z0, z1] = std::minmax({p[0].z, p[1].z, p[2].z, p[3].z});
    return z1 + r >= t_min_ * length_ && z0 - r <= t_max_ * length_;
  }

  /// How often to halve the curve until it deviates from its chords by a twentieth of the width or so, from its
  /// second differences (Wang 1984), rounded as pbrt-v3 rounds: its pictures show the facets.
  int depth_needed() const {
    double bend = 0;
    for (size_t i = 0; i < 2; ++i) {
      const Vec3d b = seen_[i] - 2.0 * seen_[i + 1] + seen_[i + 2];
      bend = std::max({bend, std::abs(b.x), std::abs(b.y), std::abs(b.z)});
    }
    const double ratio = std::sqrt(2.0) * 6 * bend / (8 * 0.05 * std::max(piece_.width0, piece_.width1));
    if (!(ratio >= 1)) return 0;
    const int exponent = std::ilogb(std::min(ratio, 1e9));
    const int rounded = exponent + (ratio >= std::ldexp(1.5, exponent) ? 1 : 0);
    return std::clamp(rounded / 2, 0, 10);
  }

  void descend(const Bezier& p, double u0, double u1, int depth) {
    if (depth == 0) return test(p, u0, u1);
    const auto parts = halves(p);
    const double middle = (u0 + u1) / 2;
    if (may_hit(parts[0], u0, middle)) descend(parts[0], u0, middle, depth - 1);
    if (may_hit(parts[1], middle, u1)) descend(parts[1], middle, u1, depth - 1);
  }

  /// A part that is as good as straight.
  void test(const Bezier& p, double u0, double u1) {
    const auto beyond = [](const Vec3d& end, const Vec3d& inside) {
      return (inside.x - end.x) * -end.x + (inside.y - end.y) * -end.y < 0;
    };
    if (beyond(p[0], p[1]) || beyond(p[3], p[2])) return;
    const double cx = p[3].x - p[0].x, cy = p[3].y - p[0].y, chord2 = cx * cx + cy * cy;
    if (!(chord2 > 0)) return;
    const double along = -(p[0].x * cx + p[0].y * cy) / chord2, w = std::clamp(along, 0.0, 1.0);
    const double u = u0 + w * (u1 - u0);
    double width = piece_.width(u);
    if (piece_.normals) width *= std::abs(ribbon_normal(piece_.normals, u).dot(z_));
    const Vec3d a = mix(mix(p[0], p[1], w), mix(p[1], p[2], w), w), b = mix(mix(p[1], p[2], w), mix(p[2], p[3], w), w);
    const Vec3d c = mix(a, b, w), slope = b - a;
    const double distance2 = c.x * c.x + c.y * c.y;
    if (!(width > 0 && distance2 <= width * width / 4)) return;
    const double t = c.z / length_;
    if (!(t >= t_min_ && t < t_max_)) return;
    // v grows to the left of the curve as the ray sees it.
    const double off = std::sqrt(distance2) / width;
    const bool left = c.x * slope.y - c.y * slope.x > 0;
    hit_ = {t, static_cast<float>(u), static_cast<float>(left ? 0.5 + off : 0.5 - off)};
    t_max_ = t;
    found_ = true;
  }

  const Piece& piece_;
  double t_min_, t_max_, length_;
  Vec3d z_;
  Bezier seen_;
  CurveHit hit_{};
  bool found_ = false;
};

/// Rays in the curves' own space, and whether each passes within the width of the control points' hull as seen
/// across the chord. That turns most of them away, for all lanes at once.
struct Candidates {
  alignas(64) double ox[kMaxCurveRays], oy[kMaxCurveRays], oz[kMaxCurveRays];
  alignas(64) double dx[kMaxCurveRays], dy[kMaxCurveRays], dz[kMaxCurveRays];
  alignas(64) int near[kMaxCurveRays];

  Candidates(const Mat4d& m, const Piece& piece, const CurveRays& rays) {
    const Bezier& p = piece.p;
    const Vec3d chord = p[3] - p[0];
    const double r = piece.half_width(), r2 = r * r;
    for_lanes(rays.n, [&](int i) {
      const double px = rays.ox[i], py = rays.oy[i], pz = rays.oz[i], vx = rays.dx[i], vy = rays.dy[i], vz = rays.dz[i];
      const double o0 = px * m[0][0] + py * m[1][0] + pz * m[2][0] + m[3][0];
      const double o1 = px * m[0][1] + py * m[1][1] + pz * m[2][1] + m[3][1];
      const double o2 = px * m[0][2] + py * m[1][2] + pz * m[2][2] + m[3][2];
      const double d0 = vx * m[0][0] + vy * m[1][0] + vz * m[2][0];
      const double d1 = vx * m[0][1] + vy * m[1][1] + vz * m[2][1];
      const double d2 = vx * m[0][2] + vy * m[1][2] + vz * m[2][2];
      ox[i] = o0, oy[i] = o1, oz[i] = o2, dx[i] = d0, dy[i] = d1, dz[i] = d2;
      const double s0 = d1 * chord.z - d2 * chord.y, s1 = d2 * chord.x - d0 * chord.z, s2 = d0 * chord.y - d1 * chord.x;
      const auto off = [&](const Vec3d& q) { return (q.x - o0) * s0 + (q.y - o1) * s1 + (q.z - o2) * s2; };
      const double a = off(p[0]), b = off(p[1]), c = off(p[2]), e = off(p[3]);
      const double ab0 = a < b ? a : b, ab1 = a < b ? b : a, ce0 = c < e ? c : e, ce1 = c < e ? e : c;
      const double low = ab0 < ce0 ? ab0 : ce0, high = ab1 < ce1 ? ce1 : ab1;
      const double gap = low > 0 ? low : high < 0 ? high : 0.0;
      // A little wider than the curve, for rounding.
      near[i] = gap * gap <= 1.0001 * r2 * (s0 * s0 + s1 * s1 + s2 * s2) ? 1 : 0;
    });
  }
};

}  // namespace

Vec3d ribbon_normal(const float* n, double u) {
  const Vec3d from(n[0], n[1], n[2]), handle(n[3], n[4], n[5]), to(n[9], n[10], n[11]);
  Vec3d turn = handle - from;
  turn -= from * from.dot(turn);
  if (!(turn.length2() > 0)) return from;
  const double angle = std::atan2(from.cross(to).length(), from.dot(to)) * u;
  return from * std::cos(angle) + turn.normalized() * std::sin(angle);
}

Box3d curve_bounds(const CurveView& curves, size_t piece) {
  const Piece part(curves, piece);
  Box3d box;
  for (const Vec3d& p : part.p) box.extendBy(transform_point(curves.to_group, p));
  // A ball of the half width becomes an ellipsoid, whose box this is.
  const Mat4d& m = curves.to_group;
  for (int c = 0; c < 3; ++c) {
    const double r = part.half_width() * Vec3d(m[0][c], m[1][c], m[2][c]).length();
    box.min[c] -= r, box.max[c] += r;
  }
  return box;
}

uint32_t intersect_curve(const CurveView& curves, size_t piece, const CurveRays& rays, CurveHit* hits) {
  const Piece part(curves, piece);
  const Candidates c(curves.from_group, part, rays);
  uint32_t found = 0;
  for (int i = 0; i < rays.n; ++i) {
    if (!rays.valid[i] || !c.near[i]) continue;
    SeenCurve seen(part, {c.ox[i], c.oy[i], c.oz[i]}, {c.dx[i], c.dy[i], c.dz[i]}, rays.t_min[i], rays.t_max[i]);
    if (seen.intersect(hits[i])) found |= 1u << i;
  }
  return found;
}

}  // namespace whit
