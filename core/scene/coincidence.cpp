#include "core/scene/coincidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "core/base/box.h"

namespace whit {
namespace {

constexpr size_t kMostTriangles = 256, kMostShapes = 20000;
/// Of triangles and of sampled points: about a quarter of a second. Only scenes with many copies in one place need more.
constexpr size_t kMostComparisons = 10'000'000;
/// Groups are about a hundred units wide: vertices are rounded to 4e-6 there, and analytic shapes are not rounded.
constexpr double kMeshTolerance = 2e-5, kAnalyticTolerance = 1e-9;

struct Triangle {
  Vec3d a, b, c;
  Vec3d normal() const { return (b - a).cross(c - a).normalized(); }
  Box3d bounds() const {
    Box3d box(a);
    box.extendBy(b), box.extendBy(c);
    return box;
  }
};

Triangle triangle_of(const Mesh& mesh, size_t prim) {
  const auto corner = [&](size_t k) { return Vec3d(mesh.position(mesh.indices[3 * prim + k])); };
  return {corner(0), corner(1), corner(2)};
}

/// How far inside of the triangle p lies when it is taken along the normal onto its plane; negative outside.
double depth_inside(const Triangle& t, const Vec3d& p) {
  const Vec3d n = t.normal();
  const auto inside = [&](const Vec3d& from, const Vec3d& to) {
    return n.cross((to - from).normalized()).dot(p - from);
  };
  return std::min({inside(t.a, t.b), inside(t.b, t.c), inside(t.c, t.a)});
}

bool in_plane(const Triangle& t, const Triangle& of) {
  const Vec3d n = of.normal();
  const auto near = [&](const Vec3d& p) { return std::abs(n.dot(p - of.a)) <= kMeshTolerance; };
  return near(t.a) && near(t.b) && near(t.c);
}

/// Whether an edge of a parts the triangles, which lie in one plane: no part of b reaches further inside than `reach`.
bool parted_by_an_edge(const Triangle& a, const Triangle& b, double reach) {
  const Vec3d n = a.normal();
  const auto parts = [&](const Vec3d& from, const Vec3d& to) {
    const Vec3d inward = n.cross((to - from).normalized());
    const auto outside = [&](const Vec3d& p) { return inward.dot(p - from) <= reach; };
    return outside(b.a) && outside(b.b) && outside(b.c);
  };
  return parts(a.a, a.b) || parts(a.b, a.c) || parts(a.c, a.a);
}

/// Whether triangles in one plane overlap by more than `reach`; when that is negative, whether they come so near.
bool overlap(const Triangle& a, const Triangle& b, double reach) {
  Box3d near = a.bounds();
  near.min -= Vec3d(4 * kMeshTolerance), near.max += Vec3d(4 * kMeshTolerance);
  return near.intersects(b.bounds()) && in_plane(a, b) && in_plane(b, a) && !parted_by_an_edge(a, b, reach) &&
         !parted_by_an_edge(b, a, reach);
}

bool coincide(const Triangle& a, const Triangle& b) { return overlap(a, b, 2 * kMeshTolerance); }
bool touch(const Triangle& a, const Triangle& b) { return overlap(a, b, -4 * kMeshTolerance); }

/// Whether the analytic shape has a surface at a point of its group's space, within a tolerance: looked for along the
/// shape's own normal there.
bool has_surface_at(const AnalyticShape& shape, const Vec3d& p, double tolerance) {
  const Vec3d o = transform_point(shape.scene_to_object(), p);
  const SurfacePoint at = shape.surface(o);
  const Vec3d normal = transform_vector(shape.scene_to_object().transposed(), at.dpdu.cross(at.dpdv)).normalized();
  const Vec3d d = transform_vector(shape.scene_to_object(), normal), from = o - d;
  const double t_min = 0;
  double t = 2;
  shape.intersect({1, &from.x, &from.y, &from.z, &d.x, &d.y, &d.z, &t_min, &t});
  return std::abs(t - 1) <= tolerance;
}

/// Points all over a shape, in its group's space.
std::vector<Vec3d> points_on(const AnalyticShape& shape) {
  std::vector<Vec3d> points;
  constexpr int kSide = 8;
  for (int i = 0; i < kSide * kSide; ++i) {
    const double u = (i % kSide + 0.5) / kSide, v = (i / kSide + 0.5) / kSide;
    points.push_back(transform_point(shape.object_to_scene(), shape.sample_area(u, v).p));
  }
  return points;
}

/// A flat analytic shape, a disk, in its group's space. What is curved can only touch a plane, and is not flat.
class FlatShape {
 public:
  explicit FlatShape(const AnalyticShape& shape) : shape_(shape) {
    const SurfacePoint any = shape.surface(shape.sample_area(0.5, 0.5).p);
    flat_ = any.dndu.length2() == 0 && any.dndv.length2() == 0;
    if (!flat_) return;
    const Mat4d& m = shape.object_to_scene();
    at_ = transform_point(m, any.p);
    normal_ = transform_vector(m, any.dpdu).cross(transform_vector(m, any.dpdv)).normalized();
    points_ = points_on(shape);
  }

  /// Whether it shares a part of its plane with a triangle.
  bool coincides(const Triangle& t) const {
    if (!flat_ || off_plane(t.a) || off_plane(t.b) || off_plane(t.c)) return false;
    return has_surface_at(shape_, (t.a + t.b + t.c) / 3, kMeshTolerance) ||
           std::any_of(points_.begin(), points_.end(), [&](const Vec3d& p) { return depth_inside(t, p) >= 0; });
  }

 private:
  bool off_plane(const Vec3d& p) const { return std::abs(normal_.dot(p - at_)) > kMeshTolerance; }

  const AnalyticShape& shape_;
  bool flat_;
  Vec3d at_, normal_;
  std::vector<Vec3d> points_;
};

/// Cuts a shape away where upper ones lie in it. Shadow rays are blocked by either.
class UnderOthers final : public AlphaTest {
 public:
  void add(size_t prim, const Triangle& upper) { triangles_[prim].push_back(upper); }
  void add(const AnalyticShape& upper) { analytic_.push_back(&upper); }
  void add_everywhere(const Triangle& upper) { everywhere_.push_back(upper); }

  bool cut(uint32_t prim, float, float, const Vec3f& hit, bool shadow_ray) const override {
    if (shadow_ray) return false;
    const Vec3d p(hit);
    const auto found = triangles_.find(prim);
    if (found != triangles_.end() && is_under(found->second, p)) return true;
    if (is_under(everywhere_, p)) return true;
    return std::any_of(analytic_.begin(), analytic_.end(),
                       [&](const AnalyticShape* s) { return has_surface_at(*s, p, kRim); });
  }

 private:
  /// Only where the upper surface is sure to be hit, well within a triangle or between two: at its rim either will do.
  static bool is_under(const std::vector<Triangle>& upper, const Vec3d& p) {
    int between = 0;
    for (const Triangle& t : upper) {
      const double depth = depth_inside(t, p);
      if (depth >= kRim || (depth >= -kRim && ++between == 2)) return true;
    }
    return false;
  }

  static constexpr double kRim = 3e-5;  ///< A hit's point is rounded by half of that in a group's hundred units.
  std::map<size_t, std::vector<Triangle>> triangles_;
  std::vector<Triangle> everywhere_;
  std::vector<const AnalyticShape*> analytic_;
};

/// True when every edge is also that of a neighbour, the other way round: a solid, whose faces are hidden where it stands
/// on something.
bool is_closed(const Mesh& mesh) {
  using Point = std::array<float, 3>;
  std::map<std::pair<Point, Point>, int> balance;
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    for (size_t k = 0; k < 3; ++k) {
      const Vec3f p = mesh.position(mesh.indices[i + k]), q = mesh.position(mesh.indices[i + (k + 1) % 3]);
      const Point a{p.x, p.y, p.z}, b{q.x, q.y, q.z};
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  return std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second == 0; });
}

bool coincide(const AnalyticShape& lower, const AnalyticShape& upper) {
  const std::vector<Vec3d> points = points_on(lower), others = points_on(upper);
  const auto lies_in = [](const AnalyticShape& shape) {
    return [&](const Vec3d& p) { return has_surface_at(shape, p, kAnalyticTolerance); };
  };
  return std::any_of(points.begin(), points.end(), lies_in(upper)) ||
         std::any_of(others.begin(), others.end(), lies_in(lower));
}

Box3d bounds_of(const SceneShape& shape) {
  Box3d box;
  if (shape.mesh) {
    for (size_t i = 0; i < shape.mesh->triangle_count(); ++i) box.extendBy(triangle_of(*shape.mesh, i).bounds());
  } else {
    box = transform_box(shape.analytic->object_to_scene(), shape.analytic->object_bounds());
  }
  box.min -= Vec3d(kMeshTolerance), box.max += Vec3d(kMeshTolerance);
  return box;
}

struct Candidate {
  int shape;
  Box3d bounds;
};

/// Calls f for each pair of shapes whose boxes meet: a sweep along x.
template <class F>
void for_neighbours(std::vector<Candidate>& candidates, const F& f) {
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::make_pair(a.bounds.min.x, a.shape) < std::make_pair(b.bounds.min.x, b.shape);
  });
  for (size_t i = 0; i < candidates.size(); ++i) {
    for (size_t j = i + 1; j < candidates.size() && candidates[j].bounds.min.x <= candidates[i].bounds.max.x; ++j) {
      if (!candidates[i].bounds.intersects(candidates[j].bounds)) continue;
      f(std::min(candidates[i].shape, candidates[j].shape), std::max(candidates[i].shape, candidates[j].shape));
    }
  }
}

/// Compares shapes and keeps what has to be cut away, and what has to be said.
class Finder {
 public:
  Finder(std::span<const SceneShape> shapes, const std::vector<bool>& has_alpha)
      : shapes_(shapes), has_alpha_(has_alpha) {}

  void compare(int lower, int upper) {
    const SceneShape &l = shapes_[static_cast<size_t>(lower)], &u = shapes_[static_cast<size_t>(upper)];
    comparisons_ += parts(l) * parts(u);
    if (comparisons_ > kMostComparisons) return;
    bool any = false;
    if (l.mesh && u.mesh) {
      any = compare_meshes(lower, upper);
    } else if (l.analytic && u.analytic) {
      any = coincide(*l.analytic, *u.analytic);
    } else {
      any = compare_with_mesh(lower, upper);
    }
    if (!any) return;
    found_.pairs.push_back({lower, upper});
    if (u.analytic && !has_alpha_[static_cast<size_t>(upper)]) cut(lower).add(*u.analytic);
  }

  Coincidences take() {
    for (auto& [shape, cut] : cuts_) found_.cuts.emplace_back(shape, std::move(cut));
    std::sort(found_.pairs.begin(), found_.pairs.end(), [](const Coincidence& a, const Coincidence& b) {
      return std::make_pair(a.lower, a.upper) < std::make_pair(b.lower, b.upper);
    });
    return std::move(found_);
  }

 private:
  static size_t parts(const SceneShape& shape) { return shape.mesh ? shape.mesh->triangle_count() : 40; }

  UnderOthers& cut(int shape) {
    auto& test = cuts_[shape];
    if (!test) test = std::make_unique<UnderOthers>();
    return *test;
  }

  /// Cuts a triangle of a shape away where another shape lies in it, also between the triangles of that.
  void cut_triangle(int shape, size_t prim, int other) {
    if (has_alpha_[static_cast<size_t>(other)] || !done_.insert({shape, prim, other}).second) return;
    const Mesh& mesh = *shapes_[static_cast<size_t>(other)].mesh;
    const Triangle a = triangle_of(*shapes_[static_cast<size_t>(shape)].mesh, prim);
    for (size_t j = 0; j < mesh.triangle_count(); ++j) {
      const Triangle b = triangle_of(mesh, j);
      if (touch(a, b)) cut(shape).add(prim, b);
    }
  }

  bool compare_meshes(int lower, int upper) {
    const Mesh &l = *shapes_[static_cast<size_t>(lower)].mesh, &u = *shapes_[static_cast<size_t>(upper)].mesh;
    bool any = false;
    for (size_t i = 0; i < l.triangle_count(); ++i) {
      const Triangle a = triangle_of(l, i);
      for (size_t j = 0; j < u.triangle_count(); ++j) {
        const Triangle b = triangle_of(u, j);
        if (!coincide(a, b)) continue;
        // A solid that stands on something: nothing to be said, and what it stands on is there, for it may be of glass.
        const bool back_to_back = a.normal().dot(b.normal()) < 0;
        const bool upper_stands = back_to_back && is_solid(upper), lower_stands = back_to_back && is_solid(lower);
        if (upper_stands && !lower_stands) cut_triangle(upper, j, lower);
        else cut_triangle(lower, i, upper);
        any |= !upper_stands && !lower_stands;
      }
    }
    return any;
  }

  bool compare_with_mesh(int lower, int upper) {
    const SceneShape &l = shapes_[static_cast<size_t>(lower)], &u = shapes_[static_cast<size_t>(upper)];
    const Mesh& mesh = l.mesh ? *l.mesh : *u.mesh;
    const FlatShape flat(l.analytic ? *l.analytic : *u.analytic);
    bool any = false;
    for (size_t i = 0; i < mesh.triangle_count(); ++i) {
      const Triangle t = triangle_of(mesh, i);
      if (!flat.coincides(t)) continue;
      any = true;
      if (l.analytic && !has_alpha_[static_cast<size_t>(upper)]) cut(lower).add_everywhere(t);
    }
    return any;
  }

  bool is_solid(int shape) {
    const auto [known, is_new] = solids_.try_emplace(shape, false);
    if (is_new) known->second = is_closed(*shapes_[static_cast<size_t>(shape)].mesh);
    return known->second;
  }

  std::span<const SceneShape> shapes_;
  const std::vector<bool>& has_alpha_;
  std::map<int, std::unique_ptr<UnderOthers>> cuts_;
  std::map<int, bool> solids_;
  size_t comparisons_ = 0;
  std::set<std::tuple<int, size_t, int>> done_;  ///< Triangles cut under a shape.
  Coincidences found_;
};

class BothTests final : public AlphaTest {
 public:
  BothTests(std::unique_ptr<AlphaTest> a, std::unique_ptr<AlphaTest> b) : a_(std::move(a)), b_(std::move(b)) {}
  bool cut(uint32_t prim, float u, float v, const Vec3f& p, bool shadow_ray) const override {
    return a_->cut(prim, u, v, p, shadow_ray) || b_->cut(prim, u, v, p, shadow_ray);
  }

 private:
  std::unique_ptr<AlphaTest> a_, b_;
};

}  // namespace

Coincidences find_coincidences(std::span<const SceneShape> shapes, const std::vector<bool>& has_alpha) {
  std::vector<Candidate> candidates;
  for (size_t i = 0; i < shapes.size(); ++i) {
    const SceneShape& shape = shapes[i];
    if (shape.analytic || (shape.mesh && shape.mesh->triangle_count() <= kMostTriangles)) {
      candidates.push_back({static_cast<int>(i), bounds_of(shape)});
    }
  }
  Finder finder(shapes, has_alpha);
  if (candidates.size() <= kMostShapes) {
    for_neighbours(candidates, [&](int lower, int upper) { finder.compare(lower, upper); });
  }
  return finder.take();
}

std::unique_ptr<AlphaTest> both(std::unique_ptr<AlphaTest> a, std::unique_ptr<AlphaTest> b) {
  if (!a) return b;
  if (!b) return a;
  return std::make_unique<BothTests>(std::move(a), std::move(b));
}

}  // namespace whit
