#include "core/scene/light_choice.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/hash.h"
#include "core/scene/light_tree.h"
#include "core/scene/scene.h"

namespace whit {
namespace {

/// So much of the choice is even. What may arrive knows nothing of what is in between, nor of the surface at the point:
/// however wrong it is there, no light is chosen more rarely than by this share of all alike.
constexpr double kEvenShare = 1.0 / 16;

/// A number in [0,1) with more digits than a sampler's, which are multiples of 2^-24: a light that is chosen more rarely
/// than that would be always or never. The others are a hash of what there is.
double with_more_digits(float u, const Vec3f& p) {
  uint32_t h = std::bit_cast<uint32_t>(u);
  for (const float x : {p.x, p.y, p.z}) h = hash_combine(h, std::bit_cast<uint32_t>(x));
  return static_cast<double>(u) + static_cast<double>(h) * 0x1p-56;
}

/// One of n, all alike, for a number in [0,1).
int32_t one_of(size_t n, double u) {
  return static_cast<int32_t>(std::min(static_cast<size_t>(u * static_cast<double>(n)), n - 1));
}

/// Makes of some strengths what to choose by: numbers above 0 that are finite. What is not finite counts as the greatest
/// that is, and nothing as less than a thousandth of the mean: a power is an estimate, and may be 0 of what does shine.
void make_sound(std::vector<double>& strengths) {
  constexpr double kLeastOfMean = 1e-3;
  double greatest = 0, sum = 0;
  for (const double s : strengths) greatest = std::isfinite(s) ? std::max(greatest, s) : greatest;
  for (double& s : strengths) sum += s = std::isfinite(s) ? std::max(s, 0.0) : greatest;
  const double least = sum > 0 ? kLeastOfMean * sum / static_cast<double>(strengths.size()) : 1;
  for (double& s : strengths) s = std::max(s, least);
}

/// Numbers 0 .. n-1 in proportion to weights above 0. (Not build_cell_cdf(), whose steps of 2^-24 are too coarse for
/// millions.)
class Shares {
 public:
  Shares() = default;
  explicit Shares(const std::vector<double>& weights) {
    double sum = 0;
    for (const double w : weights) sum += w;
    double running = 0;
    for (const double w : weights) {
      shares_.push_back(w / sum);
      ends_.push_back((running += w) / sum);
    }
  }
  bool empty() const { return shares_.empty(); }
  size_t pick(double u) const {
    const auto end = std::upper_bound(ends_.begin(), ends_.end() - 1, u);
    return static_cast<size_t>(end - ends_.begin());
  }
  double share(size_t i) const { return shares_[i]; }

 private:
  std::vector<double> shares_, ends_;
};

class OnlyLight final : public LightChoice {
 public:
  void choose(int n, const Vec3Lanes&, const float*, int32_t* light, float* probability) const override {
    for_lanes(n, [=](int i) { light[i] = 0, probability[i] = 1; });
  }
  float probability(int, const Vec3f&) const override { return 1; }
};

class UniformChoice final : public LightChoice {
 public:
  explicit UniformChoice(size_t count) : count_(count), each_(static_cast<float>(1 / static_cast<double>(count))) {}
  void choose(int n, const Vec3Lanes& p, const float* u, int32_t* light, float* probability) const override {
    for (int i = 0; i < n; ++i) light[i] = one_of(count_, with_more_digits(u[i], p[i])), probability[i] = each_;
  }
  float probability(int, const Vec3f&) const override { return each_; }

 private:
  size_t count_;
  float each_;
};

class PowerChoice final : public LightChoice {
 public:
  explicit PowerChoice(const std::vector<double>& powers) : shares_(powers) {}
  void choose(int n, const Vec3Lanes& p, const float* u, int32_t* light, float* probability) const override {
    for (int i = 0; i < n; ++i) {
      const size_t chosen = shares_.pick(with_more_digits(u[i], p[i]));
      light[i] = static_cast<int32_t>(chosen), probability[i] = static_cast<float>(shares_.share(chosen));
    }
  }
  float probability(int light, const Vec3f&) const override {
    return static_cast<float>(shares_.share(static_cast<size_t>(light)));
  }

 private:
  Shares shares_;
};

/// The direction of a cone's axis in render space, and whether the cone is round there.
bool turn_axis(const LightCone& cone, Vec3d& axis) {
  constexpr double kRound = 1e-4;
  const Vec3d x(cone.x), y(cone.y), z(cone.z);
  const double size = x.length2(), off = kRound * size;
  if (!(std::abs(y.length2() - size) < off && std::abs(z.length2() - size) < off)) return false;
  if (!(std::abs(x.dot(y)) < off && std::abs(y.dot(z)) < off && std::abs(z.dot(x)) < off)) return false;
  axis = (x * cone.axis.x + y * cone.axis.y + z * cone.axis.z).normalized();
  return true;
}

bool is_finite(const Vec3f& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Whether a light has a place from which it comes, so that it is the stronger the nearer.
bool has_place(const SceneLight& l) {
  const bool somewhere = l.shape >= 0 || l.light->position() || l.reach.from == LightReach::From::Box;
  return somewhere && is_finite(l.reach.low) && is_finite(l.reach.high);
}

/// A light with a place; of its power, what goes in the direction of the most.
LightCluster cluster_of(const SceneLight& l, double scene_radius) {
  LightCluster c;
  c.box = {Vec3d(l.reach.low), Vec3d(l.reach.high)};
  c.spread = detail::kPiD, c.edge = 0.5 * detail::kPiD;
  const double power = l.light->power(scene_radius);
  if (l.shape >= 0) {
    // Of a surface, radiance times area.
    c.strength = power / (detail::kPiD * (l.light->is_two_sided() ? 2 : 1));
    const Vec3d normal = Vec3d(l.reach.normal).normalized();
    if (normal.length2() > 0.5)
      c.axis = c.mean = normal, c.spread = 0, c.flat = true, c.two_fronts = !l.reach.one_sided;
    return c;
  }
  const LightCone* cone = l.reach.cone;
  const double solid_angle = 2 * detail::kPiD * (cone ? 1 - cone->cosine : 2);
  c.strength = power / solid_angle;
  Vec3d axis;
  if (cone && turn_axis(*cone, axis)) c.axis = axis, c.spread = std::atan2(cone->sine, cone->cosine), c.edge = 0;
  return c;
}

/// Of a light without a place, the most that arrives at a surface.
double irradiance_of(const SceneLight& l, double scene_radius) {
  const double disk = detail::kPiD * scene_radius * scene_radius;
  return l.light->power(scene_radius) / disk * (l.light->is_environment() ? detail::kPiD : 1);
}

/// All lights, by whether they have a place, with sound strengths.
struct Sorted {
  std::vector<LightCluster> clusters;
  std::vector<int32_t> near, far;  ///< Numbers of the lights: of the clusters, and of those without a place.
  std::vector<double> irradiance;  ///< Of the far ones.
  double unit = 1;                 ///< Of strengths, so that floats can hold them.

  Sorted(std::span<const SceneLight> lights, double scene_radius) {
    std::vector<double> strengths;
    for (size_t i = 0; i < lights.size(); ++i) {
      const bool placed = has_place(lights[i]);
      (placed ? near : far).push_back(static_cast<int32_t>(i));
      if (!placed) {
        irradiance.push_back(irradiance_of(lights[i], scene_radius));
        continue;
      }
      clusters.push_back(cluster_of(lights[i], scene_radius));
      strengths.push_back(clusters.back().strength);
    }
    make_sound(strengths), make_sound(irradiance);
    for (size_t i = 0; i < strengths.size(); ++i) clusters[i].strength = strengths[i];
    const std::vector<double>& measured = strengths.empty() ? irradiance : strengths;
    unit = *std::max_element(measured.begin(), measured.end());
  }
};

/// Each of few lights weighed at every point.
class FewLights final : public LightChoice {
 public:
  static constexpr size_t kMost = 16;

  explicit FewLights(const Sorted& sorted) : count_(sorted.near.size() + sorted.far.size()) {
    for (size_t k = 0; k < sorted.near.size(); ++k) {
      const auto number = static_cast<size_t>(sorted.near[k]);
      balls_.set(number, ball_around(sorted.clusters[k], sorted.unit)), has_place_[number] = true;
    }
    for (size_t k = 0; k < sorted.far.size(); ++k) {
      // Beside what has a place and is this bright, that has no say; but its square must be a float.
      constexpr double kBrightest = 1e15;
      const double relative = sorted.irradiance[k] / sorted.unit;
      irradiance_[static_cast<size_t>(sorted.far[k])] =
          static_cast<float>(clamp_to(relative, 1 / kBrightest, kBrightest));
    }
  }

  void choose(int n, const Vec3Lanes& p, const float* u, int32_t* light, float* probability) const override {
    Block b;
    for (int first = 0; first < n; first += kBlock) {
      const int count = std::min(kBlock, n - first);
      weigh(count, p.from(first), b);
      pick(count, u + first, b, light + first, probability + first);
    }
  }

  float probability(int light, const Vec3f& p) const override {
    alignas(32) LightBalls<kMost>::Lanes weight;
    balls_.weigh(p, weight);
    float sum = 0;
    for (size_t k = 0; k < count_; ++k) sum += weight[k] = has_place_[k] ? weight[k] : irradiance_[k];
    return weight[static_cast<size_t>(light)] * (uneven() / sum) + even();
  }

 private:
  static constexpr int kBlock = 64;
  struct Block {
    alignas(64) float chance[kMost][kBlock];
  };

  float uneven() const { return static_cast<float>(1 - kEvenShare); }
  float even() const { return static_cast<float>(kEvenShare / static_cast<double>(count_)); }

  /// The chances of all lights at n points, which add up to 1.
  void weigh(int n, const Vec3Lanes& p, Block& b) const {
    alignas(64) float sum[kBlock];
    for_lanes(n, [&](int i) { sum[i] = 0; });
    for (size_t k = 0; k < count_; ++k) {
      float* const weight = b.chance[k];
      const LightBall ball = balls_[k];
      const float irradiance = irradiance_[k];
      if (has_place_[k]) for_lanes(n, [=](int i) { weight[i] = irradiance_from(ball, p[i]); });
      else for_lanes(n, [=](int i) { weight[i] = irradiance; });
      for_lanes(n, [&](int i) { sum[i] += weight[i]; });
    }
    const float uneven = this->uneven(), even = this->even();
    for_lanes(n, [&](int i) { sum[i] = uneven / sum[i]; });
    for (size_t k = 0; k < count_; ++k) {
      float* const weight = b.chance[k];
      for_lanes(n, [&](int i) { weight[i] = weight[i] * sum[i] + even; });
    }
  }

  void pick(int n, const float* u, const Block& b, int32_t* light, float* probability) const {
    alignas(64) float end[kBlock];
    for_lanes(n, [&](int i) { end[i] = 0, light[i] = 0, probability[i] = b.chance[0][i]; });
    for (size_t k = 1; k < count_; ++k) {
      const float *before = b.chance[k - 1], *chance = b.chance[k];
      const auto number = static_cast<int32_t>(k);
      for_lanes(n, [=, &end](int i) {
        end[i] += before[i];
        const bool beyond = u[i] >= end[i];
        light[i] = beyond ? number : light[i], probability[i] = beyond ? chance[i] : probability[i];
      });
    }
  }

  size_t count_;
  LightBalls<kMost> balls_;
  std::array<bool, kMost> has_place_{};
  std::array<float, kMost> irradiance_{};  ///< Of those without.
};

/// A tree of the lights with a place, and beside it those without.
class ManyLights final : public LightChoice {
 public:
  explicit ManyLights(const Sorted& sorted)
      : near_(sorted.near), far_(sorted.far), places_(near_.size() + far_.size()), tree_(sorted.clusters, sorted.unit) {
    for (size_t k = 0; k < near_.size(); ++k) places_[static_cast<size_t>(near_[k])] = static_cast<int32_t>(k);
    for (size_t k = 0; k < far_.size(); ++k) places_[static_cast<size_t>(far_[k])] = ~static_cast<int32_t>(k);
    if (far_.empty()) return;
    far_shares_ = Shares(sorted.irradiance);
    for (const double e : sorted.irradiance) far_irradiance_ += e / sorted.unit;
  }

  void choose(int n, const Vec3Lanes& p, const float* u, int32_t* light, float* probability) const override {
    for (int i = 0; i < n; ++i) {
      const double number = with_more_digits(u[i], p[i]);
      if (number < kEvenShare) {
        light[i] = one_of(places_.size(), number / kEvenShare);
        probability[i] = this->probability(light[i], p[i]);
      } else {
        const LightTree::Leaf chosen = take(p[i], (number - kEvenShare) / (1 - kEvenShare));
        light[i] = chosen.cluster, probability[i] = with_even_share(chosen.probability);
      }
    }
  }

  float probability(int light, const Vec3f& p) const override {
    const int32_t place = places_[static_cast<size_t>(light)];
    LightTree::Weights root;
    const double far = weigh(p, root);
    if (place < 0) return with_even_share(far * far_shares_.share(static_cast<size_t>(~place)));
    return with_even_share((1 - far) * tree_.probability(place, p, root));
  }

 private:
  float with_even_share(double probability) const {
    return static_cast<float>((1 - kEvenShare) * probability + kEvenShare / static_cast<double>(places_.size()));
  }

  /// The share of the lights without a place. What the root's children let arrive is a rough guess, and walls may keep
  /// either kind away, so that neither gets all.
  double weigh(const Vec3f& p, LightTree::Weights& root) const {
    constexpr double kLeast = 0.2;
    if (tree_.empty()) return 1;
    root = tree_.weigh_root(p);
    if (far_.empty()) return 0;
    return clamp_to(far_irradiance_ / (far_irradiance_ + root.total), kLeast, 1 - kLeast);
  }

  /// A light and its probability, but for the even share.
  LightTree::Leaf take(const Vec3f& p, double u) const {
    LightTree::Weights root;
    const double far = weigh(p, root);
    if (u < far) {
      const size_t k = far_shares_.pick(u / far);
      return {far_[k], far * far_shares_.share(k)};
    }
    const LightTree::Leaf leaf = tree_.take(p, (u - far) / (1 - far), root);
    return {near_[static_cast<size_t>(leaf.cluster)], (1 - far) * leaf.probability};
  }

  std::vector<int32_t> near_, far_;  ///< As in Sorted.
  std::vector<int32_t> places_;      ///< Of every light, where it stands in near_, or ~ where in far_.
  LightTree tree_;
  Shares far_shares_;
  double far_irradiance_ = 0;
};

std::vector<double> powers_of(std::span<const SceneLight> lights, double scene_radius) {
  std::vector<double> powers;
  for (const SceneLight& l : lights) powers.push_back(l.light->power(scene_radius));
  make_sound(powers);
  return powers;
}

}  // namespace

std::unique_ptr<LightChoice> make_light_choice(std::span<const SceneLight> lights, LightStrategy strategy,
                                               double scene_radius) {
  if (lights.empty()) return nullptr;
  if (lights.size() == 1) return std::make_unique<OnlyLight>();
  if (strategy == LightStrategy::Uniform) return std::make_unique<UniformChoice>(lights.size());
  const double radius = std::isfinite(scene_radius) && scene_radius > 0 ? scene_radius : 1;
  if (strategy == LightStrategy::Power) return std::make_unique<PowerChoice>(powers_of(lights, radius));
  const Sorted sorted(lights, radius);
  if (lights.size() <= FewLights::kMost) return std::make_unique<FewLights>(sorted);
  return std::make_unique<ManyLights>(sorted);
}

}  // namespace whit
