#include "core/scene/coincidence.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "core/base/box.h"

namespace whit {
namespace {

/// Shapes that are compared with all their neighbours come first; larger ones share what is left of the budget.
constexpr size_t kSmallMesh = 256, kMostShapes = 20000;
/// Of triangles and of sampled points: about a quarter of a second. Only scenes with many copies in one place need more.
constexpr size_t kMostComparisons = 10'000'000;
/// Vertices are rounded to 6e-8 of their distance from the group's origin, and analytic shapes are not rounded. Groups
/// are about a hundred units wide, and huge triangles, whose corners are in double, are compared as if they were, too.
constexpr double kMeshTolerance = 2e-7, kExactTolerance = 2e-5, kAnalyticTolerance = 1e-11;
/// A hit's point is rounded by half of that.
constexpr double kRimTolerance = 1.5;

struct Triangle {
  Vec3d a, b, c;
  double tolerance;  ///< How far rounding may have moved its plane.
  Vec3d normal() const { return (b - a).cross(c - a).normalized(); }
  Box3d bounds() const { return triangle_box(a, b, c); }
};

/// Without what a Triangle knows beside its corners: most triangles are only asked where they are.
Box3d box_of(const Mesh& mesh, size_t prim) {
  return triangle_box(mesh.corner(prim, 0), mesh.corner(prim, 1), mesh.corner(prim, 2));
}

Triangle triangle_of(const Mesh& mesh, size_t prim) {
  Triangle t{mesh.corner(prim, 0), mesh.corner(prim, 1), mesh.corner(prim, 2), kExactTolerance};
  if (mesh.exact.empty()) t.tolerance = kMeshTolerance * std::max({t.a.length(), t.b.length(), t.c.length()});
  return t;
}

/// Of a triangle in double and one in floats, the latter decides where they may meet.
double tolerance_of(const Triangle& a, bool a_is_exact, const Triangle& b, bool b_is_exact) {
  if (a_is_exact != b_is_exact) return a_is_exact ? b.tolerance : a.tolerance;
  return std::max(a.tolerance, b.tolerance);
}

/// How far inside of the triangle p lies when it is taken along the normal onto its plane; negative outside.
double depth_inside(const Triangle& t, const Vec3d& p) {
  const Vec3d n = t.normal();
  const auto inside = [&](const Vec3d& from, const Vec3d& to) {
    return n.cross((to - from).normalized()).dot(p - from);
  };
  return std::min({inside(t.a, t.b), inside(t.b, t.c), inside(t.c, t.a)});
}

bool in_plane(const Triangle& t, const Triangle& of, double tolerance) {
  const Vec3d n = of.normal();
  const auto near = [&](const Vec3d& p) { return std::abs(n.dot(p - of.a)) <= tolerance; };
  return near(t.a) && near(t.b) && near(t.c);
}

/// Whether triangles lie in one plane, as far as the plane of the larger tells: beyond the smaller its own plane would be
/// too far off.
bool in_one_plane(const Triangle& a, const Triangle& b, double tolerance) {
  constexpr double kParallel = 0.99;
  const bool a_is_larger = a.bounds().size().length2() > b.bounds().size().length2();
  return std::abs(a.normal().dot(b.normal())) > kParallel &&
         (a_is_larger ? in_plane(b, a, tolerance) : in_plane(a, b, tolerance));
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

/// Whether triangles lie in one plane and overlap by more than `reach`; when that is negative, whether they come so near.
bool overlap(const Triangle& a, const Triangle& b, double tolerance, double reach) {
  Box3d near = a.bounds();
  near.min -= Vec3d(4 * tolerance), near.max += Vec3d(4 * tolerance);
  return near.intersects(b.bounds()) && in_one_plane(a, b, tolerance) && !parted_by_an_edge(a, b, reach) &&
         !parted_by_an_edge(b, a, reach);
}

bool coincide(const Triangle& a, const Triangle& b, double tolerance) {
  return overlap(a, b, tolerance, 2 * tolerance);
}
bool touch(const Triangle& a, const Triangle& b, double tolerance) { return overlap(a, b, tolerance, -4 * tolerance); }

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

/// Points all over a shape, in its group's space: in the middles of 8 x 8 parts, or on the corners of 15 x 15.
std::vector<Vec3d> points_on(const AnalyticShape& shape, bool to_the_rim = false) {
  std::vector<Vec3d> points;
  const int side = to_the_rim ? 16 : 8;
  const auto at = [&](int i) {
    constexpr double kBelowOne = 1 - 1e-9;
    return to_the_rim ? kBelowOne * i / (side - 1) : (i + 0.5) / side;
  };
  for (int i = 0; i < side * side; ++i) {
    points.push_back(transform_point(shape.object_to_scene(), shape.sample_area(at(i % side), at(i / side)).p));
  }
  return points;
}

/// A flat analytic shape, a disk, in its group's space. What is curved can only touch a plane, and is not flat.
class FlatShape {
 public:
  explicit FlatShape(const AnalyticShape& shape) : shape_(shape), points_(points_on(shape, true)) {
    const SurfacePoint any = shape.surface(shape.sample_area(0.5, 0.5).p);
    const Mat4d& m = shape.object_to_scene();
    at_ = transform_point(m, any.p);
    normal_ = transform_vector(m, any.dpdu).cross(transform_vector(m, any.dpdv)).normalized();
  }

  static bool is_flat(const AnalyticShape& shape) {
    const SurfacePoint any = shape.surface(shape.sample_area(0.5, 0.5).p);
    return any.dndu.length2() == 0 && any.dndv.length2() == 0;
  }

  /// Whether it shares a part of its plane with a triangle.
  bool coincides(const Triangle& t) const {
    if (off_plane(t, t.a) || off_plane(t, t.b) || off_plane(t, t.c)) return false;
    return any_point_on(t) || std::any_of(points_.begin(), points_.end(),
                                          [&](const Vec3d& p) { return depth_inside(t, p) > 2 * t.tolerance; });
  }
  Vec3d normal() const { return normal_; }

 private:
  bool off_plane(const Triangle& t, const Vec3d& p) const { return std::abs(normal_.dot(p - at_)) > t.tolerance; }

  /// Whether one of 28 points all over the triangle is on the shape.
  bool any_point_on(const Triangle& t) const {
    constexpr int kRows = 7;
    for (int i = 0; i < kRows; ++i) {
      for (int j = 0; i + j < kRows; ++j) {
        const double u = (i + 1.0 / 3) / kRows, v = (j + 1.0 / 3) / kRows;
        if (has_surface_at(shape_, t.a + u * (t.b - t.a) + v * (t.c - t.a), t.tolerance)) return true;
      }
    }
    return false;
  }

  const AnalyticShape& shape_;
  Vec3d at_, normal_;
  std::vector<Vec3d> points_;
};

/// Cuts a shape away where upper ones lie in it. Shadow rays are blocked by either.
class UnderOthers final : public AlphaTest {
 public:
  void add(size_t prim, const Triangle& upper, double tolerance) {
    triangles_[prim].push_back({upper, kRimTolerance * tolerance});
  }
  void add(const AnalyticShape& upper) { analytic_.push_back(&upper); }
  void add_everywhere(const Triangle& upper) { everywhere_.push_back({upper, kRimTolerance * upper.tolerance}); }

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
  struct Upper {
    Triangle triangle;
    double rim;
  };

  /// Only where the upper surface is sure to be hit, well within a triangle or between two: at its rim either will do.
  static bool is_under(const std::vector<Upper>& upper, const Vec3d& p) {
    int between = 0;
    for (const Upper& u : upper) {
      const double depth = depth_inside(u.triangle, p);
      if (depth >= u.rim || (depth >= -u.rim && ++between == 2)) return true;
    }
    return false;
  }

  static constexpr double kRim = kRimTolerance * kExactTolerance;
  std::map<size_t, std::vector<Upper>> triangles_;
  std::vector<Upper> everywhere_;
  std::vector<const AnalyticShape*> analytic_;
};

/// Spreads a number over 64 bits (the finaliser of splitmix64).
uint64_t mix_bits(uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// A number for an edge, with the other sign for the same edge the other way round.
uint64_t hash_of_edge(const Vec3f& from, const Vec3f& to) {
  const auto hash = [](uint64_t h, const Vec3f& p) {
    for (const float v : {p.x, p.y, p.z}) h = mix_bits(h ^ std::bit_cast<uint32_t>(v + 0.0f));  // -0 is 0
    return h;
  };
  const auto key = [](const Vec3f& p) { return std::make_tuple(p.x, p.y, p.z); };
  return key(from) < key(to) ? hash(hash(1, from), to) : uint64_t{0} - hash(hash(1, to), from);
}

/// 0 when not every edge is also that of a neighbour, the other way round. Else it is a solid, whose faces are hidden
/// where it stands on something, and its sides are where its triangles' normals point (1) or away from there (-1).
int solid_side(const Mesh& mesh) {
  uint64_t balance = 0;
  double volume = 0;
  const Vec3d middle = mesh.corner(0, 0);
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    for (size_t k = 0; k < 3; ++k) {
      balance += hash_of_edge(mesh.position(mesh.indices[3 * t + k]), mesh.position(mesh.indices[3 * t + (k + 1) % 3]));
    }
    volume += (mesh.corner(t, 0) - middle).dot((mesh.corner(t, 1) - middle).cross(mesh.corner(t, 2) - middle));
  }
  if (balance != 0 || volume == 0) return 0;
  return volume > 0 ? 1 : -1;
}

bool coincide(const AnalyticShape& lower, const AnalyticShape& upper) {
  const std::vector<Vec3d> points = points_on(lower), others = points_on(upper);
  const auto lies_in = [](const AnalyticShape& shape) {
    const Box3d box = transform_box(shape.object_to_scene(), shape.object_bounds());
    const double tolerance = kAnalyticTolerance * std::max(100.0, box.size().length());
    return [&shape, tolerance](const Vec3d& p) { return has_surface_at(shape, p, tolerance); };
  };
  return std::any_of(points.begin(), points.end(), lies_in(upper)) ||
         std::any_of(others.begin(), others.end(), lies_in(lower));
}

Box3d bounds_of(const SceneShape& shape) {
  Box3d box;
  if (shape.mesh) {
    for (size_t i = 0; i < shape.mesh->triangle_count(); ++i) box.extendBy(box_of(*shape.mesh, i));
  } else {
    box = transform_box(shape.analytic->object_to_scene(), shape.analytic->object_bounds());
  }
  box.min -= Vec3d(kExactTolerance), box.max += Vec3d(kExactTolerance);
  return box;
}

struct Candidate {
  int shape;
  Box3d bounds;
};

/// Calls f for each pair of shapes whose boxes meet, with the box they share: a sweep along x.
template <class F>
void for_neighbours(std::vector<Candidate>& candidates, const F& f) {
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::make_pair(a.bounds.min.x, a.shape) < std::make_pair(b.bounds.min.x, b.shape);
  });
  for (size_t i = 0; i < candidates.size(); ++i) {
    for (size_t j = i + 1; j < candidates.size() && candidates[j].bounds.min.x <= candidates[i].bounds.max.x; ++j) {
      if (candidates[i].bounds.intersects(candidates[j].bounds)) f(candidates[i], candidates[j]);
    }
  }
}

/// Compares shapes and keeps what has to be cut away, and what has to be said.
class Finder {
 public:
  Finder(std::span<const SceneShape> shapes, const std::vector<bool>& has_alpha, const std::optional<Vec3d>& eye)
      : shapes_(shapes), has_alpha_(has_alpha), eye_(eye) {}

  void compare(int lower, int upper, const Box3d& where) {
    const SceneShape &l = shapes_[static_cast<size_t>(lower)], &u = shapes_[static_cast<size_t>(upper)];
    if (l.where.file == u.where.file && l.where.offset == u.where.offset) return;  // Two parts of one shape.
    if (l.analytic && u.mesh && !FlatShape::is_flat(*l.analytic)) return;
    if (u.analytic && l.mesh && !FlatShape::is_flat(*u.analytic)) return;
    comparisons_ += parts(l) + parts(u);
    if (comparisons_ > kMostComparisons) return;
    bool any = false;
    if (l.mesh && u.mesh) {
      any = compare_meshes(lower, upper, where);
    } else if (l.analytic && u.analytic) {
      any = coincide(*l.analytic, *u.analytic);
    } else {
      any = compare_with_mesh(lower, upper);
    }
    if (!any) return;
    found_.pairs.push_back({lower, upper});
    if (l.analytic && u.analytic && !has_alpha(upper)) cut(lower).add(*u.analytic);
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

  /// The triangles of a shape that reach into a box, by where they begin in x.
  std::vector<size_t> triangles_in(int shape, const Box3d& box) const {
    const Mesh& mesh = mesh_of(shape);
    std::vector<std::pair<double, size_t>> found;
    for (size_t t = 0; t < mesh.triangle_count(); ++t) {
      const Box3d bounds = box_of(mesh, t);
      if (bounds.intersects(box)) found.emplace_back(bounds.min.x, t);
    }
    std::sort(found.begin(), found.end());
    std::vector<size_t> triangles;
    for (const auto& [x, t] : found) triangles.push_back(t);
    return triangles;
  }

  const Mesh& mesh_of(int shape) const { return *shapes_[static_cast<size_t>(shape)].mesh; }
  bool has_alpha(int shape) const { return has_alpha_[static_cast<size_t>(shape)]; }

  /// The triangles of one mesh that another mesh cuts away where it lies in them.
  using Prims = std::set<size_t>;

  /// Cuts triangles of a shape away where another shape lies in them, also between the triangles of that.
  void cut_triangles(int shape, const std::vector<size_t>& own, const Prims& prims, int other,
                     const std::vector<size_t>& others) {
    if (prims.empty() || has_alpha(other)) return;
    for_near(shape, own, other, others, [&](size_t i, size_t j) {
      if (prims.count(i) == 0) return;
      const Triangle a = triangle_of(mesh_of(shape), i), b = triangle_of(mesh_of(other), j);
      const double tolerance = tolerance_of(a, is_exact(shape), b, is_exact(other));
      if (touch(a, b, tolerance)) cut(shape).add(i, b, tolerance);
    });
  }

  /// Where a large mesh stands on something nothing is cut away: a test at every hit of it would cost more than it mends.
  bool is_large(int shape) const { return parts(shapes_[static_cast<size_t>(shape)]) > kSmallMesh; }

  bool is_exact(int shape) const { return !mesh_of(shape).exact.empty(); }

  /// Whether a solid's face lies in `other` without being seen: its outer side is away from who looks, or where that is
  /// not known, from the other's. Nothing is hidden where one of them may have holes.
  bool stands(int shape, const Triangle& face, int other, const Vec3d& other_normal, bool back_to_back_solids) {
    const int side = side_of(shape);
    if (side == 0 || has_alpha(shape) || has_alpha(other)) return false;
    if (back_to_back_solids) return true;
    if (!eye_) return face.normal().dot(other_normal) < 0;
    return side * face.normal().dot(*eye_ - face.a) < 0;
  }

  /// Calls f(i, j) for triangles of two meshes whose boxes come near each other: a sweep along x.
  template <class F>
  void for_near(int lower, const std::vector<size_t>& ls, int upper, const std::vector<size_t>& us, const F& f) {
    size_t begin = 0;
    double widest = 0;
    for (const size_t j : us) {
      const Box3d box = box_of(mesh_of(upper), j);
      widest = std::max(widest, box.max.x - box.min.x);
    }
    for (const size_t i : ls) {
      const Box3d box = box_of(mesh_of(lower), i);
      const double from = box.min.x - widest - 4 * kExactTolerance, to = box.max.x + 4 * kExactTolerance;
      const auto start = [&](size_t k) { return box_of(mesh_of(upper), us[k]).min.x; };
      while (begin < us.size() && start(begin) < from) ++begin;
      for (size_t k = begin; k < us.size() && start(k) <= to; ++k) {
        if (++comparisons_ > kMostComparisons) return;
        f(i, us[k]);
      }
    }
  }

  bool compare_meshes(int lower, int upper, const Box3d& where) {
    const std::vector<size_t> ls = triangles_in(lower, where), us = triangles_in(upper, where);
    bool any = false;
    Prims of_lower, of_upper;
    for_near(lower, ls, upper, us, [&](size_t i, size_t j) {
      const Triangle a = triangle_of(mesh_of(lower), i), b = triangle_of(mesh_of(upper), j);
      if (!coincide(a, b, tolerance_of(a, is_exact(lower), b, is_exact(upper)))) return;
      // A solid that stands on something: nothing to be said, and what it stands on is there, for it may be of glass.
      const double facing = side_of(lower) * side_of(upper) * a.normal().dot(b.normal());
      const bool upper_stands = stands(upper, b, lower, a.normal(), facing < 0);
      const bool lower_stands = stands(lower, a, upper, b.normal(), facing < 0);
      if (upper_stands && !lower_stands) of_upper.insert(j);
      else of_lower.insert(i);
      any |= !upper_stands && !lower_stands;
    });
    if (!any && (is_large(lower) || is_large(upper))) return false;
    cut_triangles(upper, us, of_upper, lower, ls);
    cut_triangles(lower, ls, of_lower, upper, us);
    return any;
  }

  bool compare_with_mesh(int lower, int upper) {
    const SceneShape &l = shapes_[static_cast<size_t>(lower)], &u = shapes_[static_cast<size_t>(upper)];
    const int of_mesh = l.mesh ? lower : upper, other = l.mesh ? upper : lower;
    const AnalyticShape& analytic = l.mesh ? *u.analytic : *l.analytic;
    const FlatShape flat(analytic);
    bool any = false;
    for (size_t i = 0; i < mesh_of(of_mesh).triangle_count(); ++i) {
      const Triangle t = triangle_of(mesh_of(of_mesh), i);
      if (!flat.coincides(t)) continue;
      const bool on_it = stands(of_mesh, t, other, flat.normal(), false);
      any |= !on_it;
      if (on_it ? !is_large(of_mesh) && !has_alpha(other) : l.mesh && !has_alpha(other)) cut(of_mesh).add(analytic);
      else if (l.analytic && !has_alpha(of_mesh)) cut(lower).add_everywhere(t);
    }
    return any;
  }

  int side_of(int shape) {
    const auto [known, is_new] = sides_.try_emplace(shape, 0);
    if (is_new) known->second = solid_side(mesh_of(shape));
    return known->second;
  }

  std::span<const SceneShape> shapes_;
  const std::vector<bool>& has_alpha_;
  const std::optional<Vec3d> eye_;
  std::map<int, std::unique_ptr<UnderOthers>> cuts_;
  std::map<int, int> sides_;
  size_t comparisons_ = 0;
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

Coincidences find_coincidences(std::span<const SceneShape> shapes, const std::vector<bool>& has_alpha,
                               const std::optional<Vec3d>& eye) {
  std::vector<Candidate> candidates;
  for (size_t i = 0; i < shapes.size(); ++i) {
    if (shapes[i].analytic || shapes[i].mesh) candidates.push_back({static_cast<int>(i), {}});
  }
  Finder finder(shapes, has_alpha, eye);
  if (candidates.size() > kMostShapes || candidates.size() < 2) return finder.take();
  tbb::parallel_for(size_t{0}, candidates.size(), [&](size_t i) {
    candidates[i].bounds = bounds_of(shapes[static_cast<size_t>(candidates[i].shape)]);
  });
  const auto is_large = [&](const Candidate& c) {
    const Mesh* mesh = shapes[static_cast<size_t>(c.shape)].mesh;
    return mesh && mesh->triangle_count() > kSmallMesh;
  };
  for (const bool large : {false, true}) {
    for_neighbours(candidates, [&](const Candidate& a, const Candidate& b) {
      if ((is_large(a) || is_large(b)) != large) return;
      Box3d shared = a.bounds;
      for (int c = 0; c < 3; ++c) {
        shared.min[c] = std::max(a.bounds.min[c], b.bounds.min[c]);
        shared.max[c] = std::min(a.bounds.max[c], b.bounds.max[c]);
      }
      finder.compare(std::min(a.shape, b.shape), std::max(a.shape, b.shape), shared);
    });
  }
  return finder.take();
}

std::unique_ptr<AlphaTest> both(std::unique_ptr<AlphaTest> a, std::unique_ptr<AlphaTest> b) {
  if (!a) return b;
  if (!b) return a;
  return std::make_unique<BothTests>(std::move(a), std::move(b));
}

}  // namespace whit
