// Choosing one light for a point: as often as is said, never without a chance, and by what may arrive.
#include "core/scene/light_choice.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "core/scene/light_tree.h"
#include "tests/scene/scene_text.h"

namespace whit {
namespace {

constexpr auto kStrategies = {LightStrategy::Uniform, LightStrategy::Power, LightStrategy::Spatial};
constexpr double kEven = 1.0 / 16;  // the share of the choice that is even
constexpr double kRadius = 100;

/// A light of which only is known what choosing asks for.
class Lamp final : public Light {
 public:
  explicit Lamp(double power, bool environment = false) : power_(power), environment_(environment) {}
  void sample(const LightSamples&) const override {}
  double power(double) const override { return power_; }
  bool is_environment() const override { return environment_; }

 private:
  double power_;
  bool environment_;
};

/// Lights without a scene.
class Lamps {
 public:
  /// Of some radiant intensity, which is power by 4 pi.
  void add_point(const Vec3f& p, double intensity) {
    SceneLight l;
    l.reach.from = LightReach::From::Box, l.reach.low = l.reach.high = p;
    add(l, 4 * M_PI * intensity);
  }
  /// A surface with a box, radiance times area being given, that shines into the half-space of n alone.
  void add_surface(const Vec3f& low, const Vec3f& high, const Vec3f& n, double intensity) {
    SceneLight l;
    l.shape = 0, l.reach.from = LightReach::From::Box, l.reach.low = low, l.reach.high = high;
    l.reach.one_sided = true, l.reach.normal = n;
    add(l, M_PI * intensity);
  }
  /// Parallel light of some irradiance, which is power by the scene's disk.
  void add_far(double irradiance, bool environment = false) {
    add(SceneLight(), M_PI * kRadius * kRadius * irradiance, environment);
  }
  std::unique_ptr<LightChoice> choice(LightStrategy strategy = LightStrategy::Spatial) const {
    return make_light_choice(lights, strategy, kRadius);
  }

  std::vector<SceneLight> lights;

 private:
  void add(SceneLight l, double power, bool environment = false) {
    owned_.push_back(std::make_unique<Lamp>(power, environment));
    l.light = owned_.back().get();
    lights.push_back(l);
  }
  std::vector<std::unique_ptr<Lamp>> owned_;
};

struct Chosen {
  int32_t light;
  float probability;
};

std::vector<Chosen> choose(const LightChoice& choice, const Vec3f& p, const std::vector<float>& u) {
  const size_t n = u.size();
  std::vector<float> lanes(4 * n);
  float *x = lanes.data(), *y = x + n, *z = y + n, *probability = z + n;
  std::fill_n(x, n, p.x), std::fill_n(y, n, p.y), std::fill_n(z, n, p.z);
  std::vector<int32_t> light(n);
  choice.choose(static_cast<int>(n), {x, y, z}, u.data(), light.data(), probability);
  std::vector<Chosen> out(n);
  for (size_t i = 0; i < n; ++i) out[i] = {light[i], probability[i]};
  return out;
}

/// Numbers as samplers have them, multiples of 2^-24, and the ends of their range.
std::vector<float> numbers(size_t n, uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::vector<float> u(n);
  for (float& x : u) x = static_cast<float>(random() >> 8) * 0x1p-24f;
  u.front() = 0, u.back() = 0x1.fffffep-1f;
  return u;
}

/// Probabilities add up to 1, and choosing tells the same ones.
void expect_consistent(const LightChoice& choice, size_t count, const Vec3f& p, const std::string& what) {
  double sum = 0;
  for (size_t l = 0; l < count; ++l) {
    const float probability = choice.probability(static_cast<int>(l), p);
    ASSERT_GT(probability, 0) << what << ", light " << l;
    sum += static_cast<double>(probability);
  }
  EXPECT_NEAR(sum, 1, 1e-5) << what;
  for (const Chosen& c : choose(choice, p, numbers(300))) {
    ASSERT_GE(c.light, 0) << what;
    ASSERT_LT(c.light, static_cast<int>(count)) << what;
    ASSERT_EQ(c.probability, choice.probability(c.light, p)) << what;
  }
}

/// Pearson's sum over what was chosen is within 6 deviations of its mean, the number of cells. Lights that are expected
/// less than 10 times are counted together.
void expect_frequencies(const LightChoice& choice, size_t count, const Vec3f& p, const std::string& what) {
  constexpr size_t kDraws = 400000;
  std::vector<double> seen(count);
  for (const Chosen& c : choose(choice, p, numbers(kDraws))) ++seen[static_cast<size_t>(c.light)];
  double sum = 0, rest_seen = 0, rest_expected = 0;
  int cells = 0;
  const auto add = [&](double found, double expected) {
    sum += (found - expected) * (found - expected) / expected, ++cells;
  };
  for (size_t l = 0; l < count; ++l) {
    const double expected = kDraws * static_cast<double>(choice.probability(static_cast<int>(l), p));
    if (expected >= 10) add(seen[l], expected);
    else rest_seen += seen[l], rest_expected += expected;
    if (rest_expected >= 10) add(rest_seen, rest_expected), rest_seen = rest_expected = 0;
  }
  EXPECT_LT(sum, cells + 6 * std::sqrt(2.0 * cells)) << what << ", " << cells << " cells";
}

/// Lamps all over a cube of side 20, some of them a thousand times brighter, half of them one-sided surfaces.
Lamps lamps_in_cube(size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(-10, 10), size(0.01f, 0.5f);
  std::normal_distribution<float> normal;
  Lamps lamps;
  for (size_t i = 0; i < count; ++i) {
    const Vec3f p(place(random), place(random), place(random));
    const Vec3f n = Vec3f(normal(random), normal(random), normal(random)).normalized();
    const double intensity = i % 10 == 0 ? 1000 : 1;
    if (i % 2 == 0) lamps.add_point(p, intensity);
    else lamps.add_surface(p, p + Vec3f(size(random), size(random), size(random)), n, intensity);
  }
  return lamps;
}

TEST(LightChoice, NothingToChooseFrom) {
  EXPECT_EQ(make_light_choice({}, LightStrategy::Spatial, 1), nullptr);
  Lamps lamps;
  lamps.add_point({0, 0, 0}, 0);
  for (const LightStrategy strategy : kStrategies) {
    const auto choice = lamps.choice(strategy);
    EXPECT_EQ(choice->probability(0, {1, 2, 3}), 1);
    expect_consistent(*choice, 1, {1, 2, 3}, "one light");
  }
}

TEST(LightChoice, ProbabilitiesAddUpAndAreThoseChosen) {
  for (const size_t count : {2, 3, 16, 17, 40, 1000}) {
    for (const bool with_far : {false, true}) {
      Lamps lamps = lamps_in_cube(count);
      if (with_far) lamps.add_far(2), lamps.add_far(0.1, true);
      for (const LightStrategy strategy : kStrategies) {
        const auto choice = lamps.choice(strategy);
        const std::string what =
            fmt::format("{} lights, strategy {}, far {}", count, static_cast<int>(strategy), with_far);
        for (const Vec3f& p : {Vec3f(0, 0, 0), Vec3f(-9, 3, 2), Vec3f(500, 1, 1), lamps.lights[0].reach.low}) {
          expect_consistent(*choice, lamps.lights.size(), p, what);
        }
        expect_frequencies(*choice, lamps.lights.size(), {1, 2, 3}, what);
      }
    }
  }
}

TEST(LightChoice, UniformAndPowerAreWhatTheySay) {
  Lamps lamps;
  lamps.add_point({0, 0, 0}, 1), lamps.add_point({1, 0, 0}, 2), lamps.add_point({2, 0, 0}, 5);
  const auto uniform = lamps.choice(LightStrategy::Uniform), power = lamps.choice(LightStrategy::Power);
  for (int l = 0; l < 3; ++l) EXPECT_FLOAT_EQ(uniform->probability(l, {5, 5, 5}), 1 / 3.0f);
  EXPECT_FLOAT_EQ(power->probability(0, {5, 5, 5}), 0.125f);
  EXPECT_FLOAT_EQ(power->probability(1, {5, 5, 5}), 0.25f);
  EXPECT_FLOAT_EQ(power->probability(2, {5, 5, 5}), 0.625f);
}

TEST(LightChoice, EveryLightCanBeChosenHoweverManyThereAre) {
  // 40,000 dark lamps and a bright one: a dark one has a thousandth of the mean, 2.5e-8 of all, and the next number of a
  // sampler is 6e-8 away, so that two or three lamps share it.
  Lamps lamps;
  for (int i = 0; i < 40000; ++i) lamps.add_point({0, 0, 0}, 0);
  lamps.add_point({0, 0, 0}, 1);
  const auto power = lamps.choice(LightStrategy::Power);
  std::set<int32_t> chosen;
  for (int i = 0; i < 1000; ++i) {
    chosen.insert(choose(*power, {static_cast<float>(i), 0, 0}, {1000 * 0x1p-24f})[0].light);
  }
  EXPECT_GE(chosen.size(), 2u);
  EXPECT_LE(chosen.size(), 4u);
}

/// A probability without the even share.
double uneven(double probability, size_t count) {
  return (probability - kEven / static_cast<double>(count)) / (1 - kEven);
}

TEST(LightChoice, SpatialGoesByIntensityOverDistanceSquared) {
  Lamps lamps;
  lamps.add_point({0, 0, 1}, 1), lamps.add_point({0, 0, -3}, 1), lamps.add_point({2, 0, 0}, 4);
  const auto choice = lamps.choice();
  // 1, 1/9 and 1.
  const double sum = 2 + 1 / 9.0;
  const auto at = [&](int l) { return uneven(static_cast<double>(choice->probability(l, {0, 0, 0})), 3); };
  EXPECT_NEAR(at(0), 1 / sum, 1e-6);
  EXPECT_NEAR(at(1), 1 / 9.0 / sum, 1e-6);
  EXPECT_NEAR(at(2), 1 / sum, 1e-6);
}

TEST(LightChoice, SpatialWeighsTheSunByItsIrradiance) {
  Lamps lamps;
  lamps.add_far(2), lamps.add_point({0, 0, 1}, 2), lamps.add_far(4 / M_PI, true);
  const auto choice = lamps.choice();
  // Irradiances at most: 2, 2 / 1 and, of light from everywhere, pi times the radiance, which is 4.
  const auto at = [&](int l) { return uneven(static_cast<double>(choice->probability(l, {0, 0, 0})), 3); };
  EXPECT_NEAR(at(0), 0.25, 1e-6);
  EXPECT_NEAR(at(1), 0.25, 1e-6);
  EXPECT_NEAR(at(2), 0.5, 1e-6);
}

TEST(LightChoice, SurfacesThatFaceAwayAreLeftToTheEvenShare) {
  // 2, and in a tree 20 of either kind: of a distance of 10, the balls of radius 0.7 look 8 degrees large at most.
  for (const int pairs : {1, 20}) {
    Lamps lamps;
    for (int i = 0; i < pairs; ++i) {
      const Vec3f low(-0.5f, -0.5f, 10 + static_cast<float>(i)), high = low + Vec3f(1, 1, 0);
      lamps.add_surface(low, high, {0, 0, -1}, 1), lamps.add_surface(low, high, {0, 0, 1}, 1);
    }
    const auto choice = lamps.choice();
    double away = 0;
    for (int i = 0; i < pairs; ++i) away += static_cast<double>(choice->probability(2 * i + 1, {0, 0, 0}));
    // What faces away keeps 1e-4 of its weight, so that rounding leaves nothing out.
    EXPECT_NEAR(away, 0.5 * kEven, 2e-4) << pairs;
  }
}

TEST(LightChoice, SurfacesWithTwoFrontsShineLittleAlongTheirPlane) {
  Lamps lamps;
  lamps.add_point({0, 0, 10}, 1);
  lamps.add_surface({-0.5f, 0, 9.5f}, {0.5f, 0, 10.5f}, {0, 1, 0}, 1);
  lamps.lights[1].reach.one_sided = false;
  const auto choice = lamps.choice();
  // Nothing comes to a point of the plane; a share of 1e-4 is kept.
  EXPECT_NEAR(uneven(static_cast<double>(choice->probability(1, {0, 0, 0})), 2), 1e-4 / (1 + 1e-4), 1e-6);
  // Straight ahead of either front the two are alike.
  for (const float y : {-100.0f, 100.0f}) EXPECT_NEAR(choice->probability(1, {0, y, 10}), 0.5f, 1e-5f);
}

TEST(LightChoice, FlatLightsDoNotLightThemselves) {
  // As seen from a point of the light, which is in its ball, it looks 1e4 times brighter than the other one.
  for (const bool one_sided : {true, false}) {
    Lamps lamps;
    lamps.add_surface({-0.5f, 0, -0.5f}, {0.5f, 0, 0.5f}, {0, 1, 0}, 1);
    lamps.lights[0].reach.one_sided = one_sided;
    lamps.add_point({0, 20, 0}, 1);
    const auto choice = lamps.choice();
    const auto own = [&](float y) { return uneven(static_cast<double>(choice->probability(0, {0.3f, y, 0.2f})), 2); };
    // The square of the distance to the ball's middle, at least a sixth of 1/2; a share of 1e-4; and 1 / 400.
    EXPECT_NEAR(own(1e-7f), 1e-4 / 0.13 / (1e-4 / 0.13 + 1 / 400.0), 2e-2);
    EXPECT_GT(own(0.1f), 0.99);
    if (one_sided) EXPECT_LT(own(-0.1f), 0.3);
    else EXPECT_GT(own(-0.1f), 0.99);
  }
}

/// Pairs of a point and a surface that is turned anyhow, near and far from each other.
TEST(LightChoice, WhatMayArriveIsAtLeastWhatDoes) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> normal;
  const auto direction = [&] { return Vec3d(normal(random), normal(random), normal(random)).normalized(); };
  for (int i = 0; i < 20000; ++i) {
    // 1 to 6 little surfaces around a place, all turned about the same way or not, as one cluster of a tree.
    std::vector<LightCluster> lights;
    struct Front {
      Vec3d q, n;
      bool two;
    };
    std::vector<Front> points;
    const Vec3d main = direction();
    const double scatter = std::pow(10, -3 * uniform(random)), extent = std::pow(10, 2 - 4 * uniform(random));
    for (int k = 0; k < 1 + i % 6; ++k) {
      LightCluster c;
      const Vec3d middle = direction() * extent;
      c.axis = (main + direction() * scatter).normalized();
      if (k == 1 && i % 7 == 0) c.axis = -lights[0].axis;
      c.spread = 0, c.edge = 0.5 * M_PI, c.strength = 1, c.two_fronts = i % 5 == 0 && k % 2 == 0;
      for (int v = 0; v < 3; ++v) {
        const Vec3d corner = middle + direction().cross(c.axis) * extent * 0.3;
        c.box.extendBy(corner), points.push_back({corner, c.axis, c.two_fronts});
      }
      lights.push_back(c);
    }
    LightCluster all = lights[0];
    for (const LightCluster& c : lights) add_to(all, c);
    const LightBall ball = ball_around(all, all.strength);
    const Vec3d p = direction() * (1 + 10 * uniform(random));
    const double squared = std::max((Vec3d(ball.center) - p).length2(), all.box.size().length2() / 24);
    const double share = static_cast<double>(irradiance_from(ball, Vec3f(p))) * squared;
    for (const auto& [q, n, two] : points) {
      const double along = n.dot((p - q).normalized()), cosine = two ? std::abs(along) : along;
      EXPECT_GE(share, cosine - 1e-3) << i;  // floats tell angles near 0 to 4e-4
    }
  }
}

TEST(LightChoice, NumbersOutOfTheOrdinary) {
  constexpr double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  constexpr float far = 1e17f, finf = std::numeric_limits<float>::infinity();
  // Few lights and a tree of them: all at one point, on a line of powers of two, without and with too much power, lights
  // as large as can be, lights that nobody knows where they are.
  for (const int more : {0, 100}) {
    std::vector<Lamps> all(6);
    for (int i = 0; i < 5 + more; ++i) {
      const auto x = static_cast<float>(i);
      all[0].add_point({1, 2, 3}, 1);
      all[1].add_point({std::ldexp(1.0f, 50 - i), 0, 0}, 1);
      all[2].add_point({x, 0, 0}, i % 4 == 0 ? 0 : i % 4 == 1 ? inf : i % 4 == 2 ? nan : -1);
      all[3].add_surface({-far, -far, x}, {far, far, x}, {0, 0, 1}, 1e30);
      all[4].add_point({finf, 0, 0}, 1);
      all[5].add_point({far * x, 0, 0}, i % 2 == 0 ? 1e30 : 1e-30);
    }
    all[3].add_far(1e-30), all[5].add_far(1e30), all[2].add_far(nan);
    for (size_t k = 0; k < all.size(); ++k) {
      for (const LightStrategy strategy : kStrategies) {
        const auto choice = all[k].choice(strategy);
        const std::string what = fmt::format("case {}, {} more, strategy {}", k, more, static_cast<int>(strategy));
        for (const Vec3f& p : {Vec3f(1, 2, 3), Vec3f(0, 0, 0), Vec3f(-far, 0, 2), Vec3f(3, 0, 0), Vec3f(1e-20f, 0, 0),
                               Vec3f(finf, 0, 0), Vec3f(std::nanf(""), 0, 0)}) {
          expect_consistent(*choice, all[k].lights.size(), p, what);
        }
        expect_frequencies(*choice, all[k].lights.size(), {1, 2, 3}, what);
      }
    }
  }
}

TEST(LightChoice, LightsEverCloserToOneAnother) {
  // Three axes of distances that halve 200 times, and as many lights at one point: deep, but not as deep as many.
  Lamps lamps;
  for (int i = 0; i < 200; ++i) {
    const float x = std::ldexp(1.0f, 60 - i);
    lamps.add_point({x, 0, 0}, 1), lamps.add_point({0, x, 0}, 1), lamps.add_point({0, 0, x}, 1);
    for (int k = 0; k < 100; ++k) lamps.add_point({0, 0, 0}, 1);
  }
  const auto choice = lamps.choice();
  for (const Vec3f& p : {Vec3f(0, 0, 0), Vec3f(1, 1, 1), Vec3f(1e10f, 0, 0)}) {
    expect_consistent(*choice, lamps.lights.size(), p, "halving");
  }
}

/// Relative variance of the sum over all lights of intensity over distance squared, estimated by one of them.
double variance_of(const LightChoice& choice, const Lamps& lamps, const Vec3f& p) {
  double sum = 0, square = 0;
  for (size_t l = 0; l < lamps.lights.size(); ++l) {
    const SceneLight& light = lamps.lights[l];
    const double intensity = light.light->power(1) / (4 * M_PI);
    const double arrives = intensity / Vec3d(light.reach.low - p).length2();
    sum += arrives, square += arrives * arrives / static_cast<double>(choice.probability(static_cast<int>(l), p));
  }
  return square / (sum * sum) - 1;
}

TEST(LightChoice, TheTreeFindsTheLightsThatMatter) {
  // 10,000 bulbs in a hall of 100 x 100 x 5. What arrives at a point is mostly that of a few.
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(0, 1);
  Lamps lamps;
  for (int i = 0; i < 10000; ++i) {
    lamps.add_point({100 * uniform(random), 100 * uniform(random), 5 * uniform(random)}, 0.1 + uniform(random));
  }
  const auto tree = lamps.choice(), power = lamps.choice(LightStrategy::Power);
  double by_tree = 0, by_power = 0;
  for (int i = 0; i < 50; ++i) {
    const Vec3f p(100 * uniform(random), 100 * uniform(random), 0);
    by_tree += variance_of(*tree, lamps, p) / 50, by_power += variance_of(*power, lamps, p) / 50;
  }
  RecordProperty("tree", fmt::format("{}", by_tree));
  RecordProperty("power", fmt::format("{}", by_power));
  // 0.27 and 90. With the power alone, what arrives from the nearest bulb is one of 10,000 and worth as many.
  EXPECT_LT(by_tree, 0.4);
  EXPECT_GT(by_power, 100 * by_tree);
}

TEST(LightChoice, ClustersOfSurfacesCountWhatTheirCosinesAreOnAverage) {
  // Normals around an axis, the less alike the larger the scatter, seen from far away in all directions. The average of
  // positive cosines is what arrives of all, and what the formula says as if cosines were normally distributed: over a
  // whole ball 0.231 and not 1/4, and never more than 0.05 off.
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  const auto direction = [&] { return Vec3d(normal(random), normal(random), normal(random)).normalized(); };
  for (const double scatter : {0.0, 0.1, 0.3, 1.0, 3.0, 100.0}) {
    std::vector<LightCluster> lights;
    for (int k = 0; k < 2000; ++k) {
      LightCluster c;
      c.axis = c.mean = (Vec3d(0, 0, 1) + direction() * scatter).normalized();
      c.spread = 0, c.edge = 0.5 * M_PI, c.strength = 1, c.flat = true;
      c.box = {Vec3d(-0.01), Vec3d(0.01)};
      lights.push_back(c);
    }
    LightCluster all = lights[0];
    for (size_t k = 1; k < lights.size(); ++k) add_to(all, lights[k]);
    const LightBall ball = ball_around(all, all.strength);
    for (int i = 0; i < 50; ++i) {
      const Vec3d to = direction();
      double average = 0;
      for (const LightCluster& c : lights) average += std::max(0.0, c.axis.dot(to)) / 2000;
      EXPECT_NEAR(static_cast<double>(irradiance_from(ball, Vec3f(to * 100.0))) * 1e4, average, 0.05) << scatter;
    }
  }
}

TEST(LightChoice, TheTreeKnowsHowMuchOfABumpyBallFacesAPoint) {
  // 6,240 pieces of a ball whose normals are off by up to 40 degrees, as bumps are, seen from the walls of a room.
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  const auto direction = [&] { return Vec3d(normal(random), normal(random), normal(random)).normalized(); };
  Lamps lamps;
  struct Piece {
    Vec3d q, n;
  };
  std::vector<Piece> pieces;
  for (int i = 0; i < 6240; ++i) {
    const double polar = std::acos(1 - 2 * (i + 0.5) / 6240), around = i * M_PI * (3 - std::sqrt(5.0));
    const Vec3d q(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around), std::cos(polar));
    const Vec3d bump(0.8 * std::cos(7 * polar) * std::sin(8 * around), 0.8 * std::sin(7 * polar) * std::cos(8 * around),
                     0);
    pieces.push_back({q, (q + bump * 0.8).normalized()});
    lamps.add_surface(Vec3f(q - Vec3d(0.01)), Vec3f(q + Vec3d(0.01)), Vec3f(pieces.back().n), 1);
  }
  const auto choice = lamps.choice();
  double variance = 0;
  for (int i = 0; i < 30; ++i) {
    const Vec3f p(direction() * 5);
    double sum = 0, square = 0;
    for (size_t l = 0; l < pieces.size(); ++l) {
      const Vec3d to = Vec3d(p) - pieces[l].q;
      const double arrives = std::max(0.0, pieces[l].n.dot(to.normalized())) / to.length2();
      const auto probability = static_cast<double>(choice->probability(static_cast<int>(l), p));
      sum += arrives, square += arrives * arrives / probability;
    }
    variance += (square / (sum * sum) - 1) / 30;
  }
  RecordProperty("variance", fmt::format("{}", variance));
  // 0.096, of which the even share makes 1 / 15; 1.2 by the most that cosines can be.
  EXPECT_LT(variance, 0.15);
}

/// A bumpy sheet of triangles that emit, side x side x 2 of them.
std::string emitting_sheet(int side) {
  std::string points, indices;
  for (int y = 0; y <= side; ++y) {
    for (int x = 0; x <= side; ++x)
      points += fmt::format("{} {} {} ", x * 0.1, y * 0.1, 5 + 0.1 * std::sin(x * 1.7 + y));
  }
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const int a = y * (side + 1) + x, b = a + side + 1;
      indices += fmt::format("{} {} {} {} {} {} ", a, a + 1, b, b, a + 1, b + 1);
    }
  }
  return "AreaLightSource \"diffuse\" \"rgb L\" [1 2 3] Shape \"trianglemesh\" \"integer indices\" [" + indices +
         "] \"point P\" [" + points + "]\n";
}

TEST(LightChoice, LightsOfAScene) {
  const test::BuiltScene built(
      "WorldBegin\nLightSource \"distant\" LightSource \"infinite\" \"rgb L\" [0.1 0.1 0.1] LightSource \"spot\" "
      "LightSource \"point\" AttributeBegin\n" +
      emitting_sheet(100) +
      "AttributeEnd AttributeBegin AreaLightSource \"diffuse\" Translate 0 0 -3 Shape \"sphere\" " +
      "Shape \"disk\" AttributeEnd WorldEnd\n");
  const std::vector<SceneLight>& lights = built.scene->lights;
  ASSERT_EQ(lights.size(), 4u + 20000 + 2);
  for (const LightStrategy strategy : kStrategies) {
    const auto choice = make_light_choice(lights, strategy, kRadius);
    for (const Vec3d& world : {Vec3d(0, 0, 0), Vec3d(5, 5, 5), Vec3d(5, 5, 5.2), Vec3d(0, 0, -3), Vec3d(1e6, 0, 0)}) {
      const Vec3f p((world - built.scene->space.origin) * built.scene->space.scale);
      const std::string what =
          fmt::format("strategy {} at x = {}, z = {}", static_cast<int>(strategy), world.x, world.z);
      expect_consistent(*choice, lights.size(), p, what);
      expect_frequencies(*choice, lights.size(), p, what);
    }
  }
}

TEST(LightChoice, SpotsAreChosenInsideOfTheirCones) {
  // Two spots of 30 degrees at z = 4, one of which shines down on the origin, the other one up; turned and scaled alike.
  for (const std::string transform : {"", "Rotate 90 1 0 0 Scale 3 3 3 "}) {
    const test::BuiltScene built("WorldBegin\nShape \"sphere\" " + transform +
                                 "LightSource \"spot\" \"point from\" [0 0 4] \"point to\" [0 0 0] "
                                 "LightSource \"spot\" \"point from\" [0 0 4] \"point to\" [0 0 8]\nWorldEnd\n");
    const Vec3f origin(-built.scene->space.origin * built.scene->space.scale);
    const auto choice = make_light_choice(built.scene->lights, LightStrategy::Spatial, kRadius);
    EXPECT_NEAR(static_cast<double>(choice->probability(1, origin)), 0.5 * kEven, 2e-4) << transform;
  }
}

}  // namespace
}  // namespace whit
