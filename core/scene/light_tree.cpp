#include "core/scene/light_tree.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace whit {
namespace {

/// Adds the cone of `b` to that of `a`: the narrowest around both, or all directions.
void add_cone(LightCluster& a, const LightCluster& b) {
  const LightCluster &wide = a.spread >= b.spread ? a : b, &narrow = a.spread >= b.spread ? b : a;
  const double between = std::atan2(wide.axis.cross(narrow.axis).length(), wide.axis.dot(narrow.axis));
  Vec3d axis = wide.axis;
  double spread = wide.spread;
  if (between + narrow.spread > wide.spread) {
    spread = 0.5 * (wide.spread + between + narrow.spread);
    // From the wider one's axis towards the other's; opposite ones leave no way to turn, and go everywhere.
    constexpr double kOpposite = 1e-6;
    const Vec3d side = (narrow.axis - wide.axis * wide.axis.dot(narrow.axis)).normalized();
    const double turn = spread - wide.spread;
    if (between > detail::kPiD - kOpposite) spread = detail::kPiD;
    else axis = (wide.axis * std::cos(turn) + side * std::sin(turn)).normalized();
  }
  if (spread >= detail::kPiD) spread = detail::kPiD, axis = wide.axis;
  a.axis = axis, a.spread = spread;
}

/// How wrong it may be to take the lights of a cluster for one: strength by what the ball leaves open.
double vagueness(const LightCluster& c) { return c.strength * c.box.size().length2(); }

}  // namespace

void add_to(LightCluster& a, const LightCluster& b) {
  const Vec3d other = b.mean * ((a.two_fronts || b.two_fronts) && a.mean.dot(b.mean) < 0 ? -1 : 1);
  const double both = a.strength + b.strength;
  if (both > 0) a.mean = (a.mean * a.strength + other * b.strength) / both;
  a.several = a.of_surfaces() && b.of_surfaces();
  a.two_fronts |= b.two_fronts, a.flat = false;
  // Of two fronts it does not matter which is called the first.
  if (a.two_fronts && a.axis.dot(b.axis) < 0) a.axis = -a.axis;
  add_cone(a, b);
  a.box.extendBy(b.box);
  a.edge = std::max(a.edge, b.edge);
  a.strength += b.strength;
}

LightBall ball_around(const LightCluster& c, double unit) {
  // Of floats near 1 the next angle is some 3e-4 away.
  constexpr double kEdgeRounding = 1e-3;
  LightBall b;
  b.center = Vec3f(c.box.center());
  b.radius = static_cast<float>(0.5 * c.box.size().length());
  b.axis = Vec3f(c.axis);
  b.cos_spread = static_cast<float>(std::cos(c.spread)), b.sin_spread = static_cast<float>(std::sin(c.spread));
  if (c.spread >= detail::kPiD) b.cos_spread = -1, b.sin_spread = 0;
  b.cos_edge = static_cast<float>(std::cos(std::min(c.edge + kEdgeRounding, 0.5 * detail::kPiD)));
  b.strength = static_cast<float>(c.strength / unit);
  b.fronts = c.two_fronts ? 2 : 1;
  constexpr float kSlab = 0.01f;  // of the radius
  b.slab = c.flat && b.radius > 0 ? 1 / (kSlab * b.radius) : 0;
  b.mean = Vec3f(c.mean);
  b.vary = c.several ? static_cast<float>((1 - std::min(c.mean.length2(), 1.0)) / 3) : -1;
  return b;
}

/// Splits clusters in two until each is alone, and then makes nodes of several splits.
class LightTree::Builder {
 public:
  Builder(LightTree& tree, const std::vector<LightCluster>& lights, double unit)
      : tree_(tree), lights_(lights), unit_(unit) {
    std::vector<int32_t> order(lights.size());
    std::iota(order.begin(), order.end(), 0);
    splits_.resize(2 * lights.size() - 1);
    tree_.places_.resize(lights.size());
    split(order, 0, 0);
    make_node(0, -1, 0);
  }

 private:
  /// A cluster and the two that it consists of, or the only light of it.
  struct Split {
    LightCluster cluster;
    int32_t first = -1, second = -1, light = -1;
  };
  /// The lights of some that lie in one of the slices along an axis.
  struct Slice {
    Box3d box;
    Vec3d axes{0, 0, 0};  ///< Sum of strength times axis; of what shines everywhere 0.
    double strength = 0;
    void add(const Slice& s) {
      if (!s.box.isEmpty()) box.extendBy(s.box);
      axes += s.axes, strength += s.strength;
    }
    /// What a cluster of these lights costs: how vague it is, twice that if it shines everywhere.
    double cost() const {
      if (box.isEmpty()) return 0;
      return (2 * strength - axes.length()) * box.size().length2();
    }
  };
  struct Cut {
    int axis = -1;  ///< -1: none that makes sense.
    double at = 0, cost = 0;
  };
  static constexpr int kSlices = 16;

  using Slices = std::array<Slice, kSlices>;

  const LightCluster& light(int32_t i) const { return lights_[static_cast<size_t>(i)]; }
  Vec3d middle(int32_t i) const { return (light(i).box.min + light(i).box.max) * 0.5; }
  static size_t slice_of(double x, double low, double high) {
    return static_cast<size_t>(std::clamp(static_cast<int>((x - low) / (high - low) * kSlices), 0, kSlices - 1));
  }

  Cut best_cut(std::span<const int32_t> lights) const;
  static void improve(Cut& best, const Slices& slices, int axis, double low, double high);
  size_t partition(std::span<int32_t> lights, int depth) const;
  void split(std::span<int32_t> lights, int depth, int32_t me);
  int32_t make_node(int32_t root, int32_t parent, int32_t slot);

  LightTree& tree_;
  const std::vector<LightCluster>& lights_;
  double unit_;
  std::vector<Split> splits_;
};

/// The cheapest cut of those between slices.
LightTree::Builder::Cut LightTree::Builder::best_cut(std::span<const int32_t> lights) const {
  Box3d middles;
  for (const int32_t i : lights) middles.extendBy(middle(i));
  std::array<Slices, 3> slices;
  for (const int32_t i : lights) {
    const LightCluster& c = light(i);
    const bool aims = c.spread < 0.5 * detail::kPiD && !c.two_fronts;
    const Slice alone{c.box, c.axis * (aims ? c.strength : 0.0), c.strength};
    const Vec3d at = middle(i);
    for (int axis = 0; axis < 3; ++axis) {
      const double low = middles.min[axis], high = middles.max[axis];
      if (high > low) slices[static_cast<size_t>(axis)][slice_of(at[axis], low, high)].add(alone);
    }
  }
  Cut best;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = middles.min[axis], high = middles.max[axis];
    if (high > low) improve(best, slices[static_cast<size_t>(axis)], axis, low, high);
  }
  return best;
}

/// Takes a cut across an axis if it is cheaper.
void LightTree::Builder::improve(Cut& best, const Slices& slices, int axis, double low, double high) {
  std::array<double, kSlices> cost_above{};
  Slice above, below;
  for (size_t k = kSlices - 1; k > 0; --k) above.add(slices[k]), cost_above[k] = above.cost();
  for (size_t k = 1; k < kSlices; ++k) {
    below.add(slices[k - 1]);
    const double cost = below.cost() + cost_above[k];
    if (best.axis >= 0 && !(cost < best.cost)) continue;
    best = {axis, low + (high - low) * static_cast<double>(k) / kSlices, cost};
  }
}

/// Puts the lights in two groups, neither of them empty; returns the size of the first.
size_t LightTree::Builder::partition(std::span<int32_t> lights, int depth) const {
  // From here on by halves: lights ever closer to one another could make it as deep as they are many.
  constexpr int kDeepestByCost = 40;
  const Cut best = depth < kDeepestByCost && lights.size() > 2 ? best_cut(lights) : Cut();
  if (best.axis < 0) return lights.size() / 2;
  const auto end =
      std::partition(lights.begin(), lights.end(), [&](int32_t i) { return middle(i)[best.axis] < best.at; });
  const auto count = static_cast<size_t>(end - lights.begin());
  return count > 0 && count < lights.size() ? count : lights.size() / 2;
}

/// Fills in split number `me` and those after it, of which there are two fewer than twice as many as lights.
void LightTree::Builder::split(std::span<int32_t> lights, int depth, int32_t me) {
  constexpr size_t kWorthATask = 4096;
  Split& made = splits_[static_cast<size_t>(me)];
  if (lights.size() == 1) {
    made.cluster = light(lights[0]), made.light = lights[0];
    return;
  }
  const size_t count = partition(lights, depth);
  made.first = me + 1, made.second = me + 2 * static_cast<int32_t>(count);
  const auto first = [&] { split(lights.first(count), depth + 1, made.first); };
  const auto second = [&] { split(lights.subspan(count), depth + 1, made.second); };
  if (lights.size() > kWorthATask) tbb::parallel_invoke(first, second);
  else first(), second();
  made.cluster = splits_[static_cast<size_t>(made.first)].cluster;
  add_to(made.cluster, splits_[static_cast<size_t>(made.second)].cluster);
}

/// A node of the clusters that are left when the vaguest is split as often as there is room.
int32_t LightTree::Builder::make_node(int32_t root, int32_t parent, int32_t slot) {
  const auto at = [&](int32_t i) -> const Split& { return splits_[static_cast<size_t>(i)]; };
  std::vector<int32_t> open{root};
  while (open.size() < static_cast<size_t>(kWidth)) {
    int32_t* vaguest = nullptr;
    for (int32_t& i : open) {
      if (at(i).light >= 0) continue;
      if (!vaguest || vagueness(at(i).cluster) > vagueness(at(*vaguest).cluster)) vaguest = &i;
    }
    if (!vaguest) break;
    const Split& s = at(*vaguest);
    *vaguest = s.first, open.push_back(s.second);
  }
  const auto me = static_cast<int32_t>(tree_.nodes_.size());
  tree_.nodes_.emplace_back();
  Node node;
  node.count = static_cast<int32_t>(open.size()), node.parent = parent, node.slot = slot;
  for (int32_t k = 0; k < node.count; ++k) {
    const Split& s = at(open[static_cast<size_t>(k)]);
    node.balls.set(static_cast<size_t>(k), ball_around(s.cluster, unit_));
    if (s.light >= 0) tree_.places_[static_cast<size_t>(s.light)] = {me, k};
    node.child[static_cast<size_t>(k)] = s.light >= 0 ? ~s.light : make_node(open[static_cast<size_t>(k)], me, k);
  }
  tree_.nodes_[static_cast<size_t>(me)] = node;
  return me;
}

LightTree::LightTree(const std::vector<LightCluster>& clusters, double unit) {
  if (!clusters.empty()) Builder(*this, clusters, unit);
}

LightTree::Weights LightTree::weigh(const Node& node, const Vec3f& p) {
  Weights w;
  node.balls.weigh(p, w.each);
  w.total = 0;
  for (int i = 0; i < node.count; ++i) w.total += static_cast<double>(w.each[static_cast<size_t>(i)]);
  return w;
}

LightTree::Leaf LightTree::take(const Vec3f& p, double u, const Weights& root) const {
  const Node* node = nodes_.data();
  Weights w = root;
  for (double probability = 1;;) {
    double rest = u * w.total;
    size_t k = 0;
    const auto last = static_cast<size_t>(node->count) - 1;
    for (; k < last && rest >= static_cast<double>(w.each[k]); ++k) rest -= static_cast<double>(w.each[k]);
    const auto weight = static_cast<double>(w.each[k]);
    probability *= weight / w.total;
    if (node->child[k] < 0) return {~node->child[k], probability};
    // Rounding may leave the last one with more than its weight.
    u = clamp_to(rest / weight, 0.0, 1.0);
    node = &nodes_[static_cast<size_t>(node->child[k])];
    w = weigh(*node, p);
  }
}

double LightTree::probability(int cluster, const Vec3f& p, const Weights& root) const {
  // The way up, and then the same products as on the way down.
  std::array<Place, kDeepest> way;
  size_t steps = 0;
  for (Place at = places_[static_cast<size_t>(cluster)]; at.node >= 0;) {
    way[steps++] = at;
    const Node& node = nodes_[static_cast<size_t>(at.node)];
    at = {node.parent, node.slot};
  }
  Weights w = root;
  double probability = 1;
  for (size_t i = steps; i-- > 0;) {
    if (i + 1 < steps) w = weigh(nodes_[static_cast<size_t>(way[i].node)], p);
    probability *= static_cast<double>(w.each[static_cast<size_t>(way[i].slot)]) / w.total;
  }
  return probability;
}

}  // namespace whit
