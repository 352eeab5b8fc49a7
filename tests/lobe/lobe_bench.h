// Points with lobes for tests, and what every lobe is tested for: albedo, and samples that fit their density.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/base/fastmath.h"
#include "core/lobe/eval.h"

namespace whit::test {

/// n points of a surface z = 0 seen from given directions, with lobes of weight 1.
class Bench {
 public:
  explicit Bench(int n) {
    s.n = n, s.arena = &arena;
    s.wo = arena.vec3(n), s.ng = arena.vec3(n), s.ns = arena.vec3(n), s.dpdu = arena.vec3(n);
    wi = arena.vec3(n), f = arena.rgb(n), pdf = arena.floats(n), eta2 = arena.floats(n);
    for (int i = 0; i < n; ++i) {
      s.ng.set(i, {0, 0, 1}), s.ns.set(i, {0, 0, 1});
      s.dpdu.set(i, normalize(Vec3f(0.6f, 0.8f, 0)) * 3.0f);
    }
  }
  float* constant(float v) {
    float* const a = arena.floats(s.n);
    for (int i = 0; i < s.n; ++i) a[i] = v;
    return a;
  }
  Lobe& add(LobeType type, float a = 0, float b = 0, float eta = 1.5f, FresnelType fresnel = FresnelType::Dielectric) {
    Lobe lobe;
    lobe.type = type, lobe.fresnel = fresnel;
    lobe.weight = {constant(1), constant(1), constant(1)};
    lobe.a = constant(a), lobe.eta = constant(eta);
    lobe.b = a == b ? lobe.a : constant(b);
    set.add(lobe);
    return set.lobes[set.count - 1];
  }
  /// A metal whose red, green and blue have different indices: copper's, about.
  Lobe& add_metal(float a, float b) {
    Lobe& lobe = add(LobeType::MicrofacetReflection, a, b, 1, FresnelType::Conductor);
    lobe.colour1 = {constant(0.2f), constant(0.92f), constant(1.1f)};
    lobe.colour2 = {constant(3.9f), constant(2.45f), constant(2.14f)};
    return lobe;
  }
  Lobe& add_blend(float rd, float rs, float a, float b) {
    Lobe& lobe = add(LobeType::FresnelBlend, a, b);
    lobe.colour1 = {constant(rd), constant(rd), constant(rd)};
    lobe.colour2 = {constant(rs), constant(rs), constant(rs)};
    return lobe;
  }
  void evaluate() { eval_lobes(set, s, prepare_frame(set, s), wi, f); }
  /// Values and densities of wi.
  void evaluate_with_density(LobeKinds kinds = LobeKinds::NonSpecular) {
    const ArenaScope scratch(arena);
    eval_lobes(set, s, prepare_frame(set, s), wi, f, pdf, kinds);
  }
  /// Directions in wi, their weights in f.
  void sample(const float* lobe_u, const float* u, const float* v, LobeKinds kinds = LobeKinds::NonSpecular) {
    const ArenaScope scratch(arena);
    sample_lobes(set, s, prepare_frame(set, s), lobe_u, u, v, kinds, {wi, f, pdf, eta2});
  }

  Arena arena;
  ShadingBatch s;
  LobeSet set{arena};
  Vec3Lanes wi;
  RGBLanes f;
  float *pdf, *eta2;
};

inline Vec3f direction(double cosine, double phi) {
  const double r = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return Vec3f(static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
               static_cast<float>(cosine));
}

/// The directional albedo: the integral of f |cos| over the sphere, by the lobe's own samples, 512 x 512 stratified.
inline double albedo(Bench& bench, const Vec3f& wo) {
  const int side = 512;
  const int n = bench.s.n;
  std::vector<float> lobe_u(n), u(n), v(n);
  for (int i = 0; i < n; ++i) bench.s.wo.set(i, wo);
  double sum = 0;
  for (int first = 0; first < side * side; first += n) {
    for (int i = 0; i < n; ++i) {
      const int k = first + i;
      lobe_u[i] = std::fmod(static_cast<float>(k) * 0.61803399f, 1.0f);
      u[i] = (static_cast<float>(k / side) + 0.5f) / side;
      v[i] = (static_cast<float>(k % side) + 0.5f) / side;
    }
    bench.sample(lobe_u.data(), u.data(), v.data());
    for (int i = 0; i < n; ++i) sum += bench.f.r[i];
  }
  return sum / (side * side);
}

/// Pearson's test of sampled directions against the integral of the density over a grid of solid angles.
inline void chi_squared(Bench& bench, const Vec3f& wo, const char* what) {
  constexpr int kCos = 20, kPhi = 20, kSub = 24, kSamples = 1 << 18;
  const int n = bench.s.n;
  for (int i = 0; i < n; ++i) bench.s.wo.set(i, wo);

  // Rows equal in cosine, so that every cell has the same solid angle.
  std::vector<double> expected(kCos * kPhi), seen(kCos * kPhi);
  const double cell = 4 * M_PI / (kCos * kPhi);
  std::vector<Vec3f> points;
  for (int k = 0; k < kCos * kPhi * kSub * kSub; ++k) {
    const int c = k / (kSub * kSub), r = k % (kSub * kSub);
    const double z = -1 + 2 * (c / kPhi + (r / kSub + 0.5) / kSub) / kCos;
    points.push_back(direction(z, 2 * M_PI * (c % kPhi + (r % kSub + 0.5) / kSub) / kPhi));
  }
  for (size_t first = 0; first < points.size(); first += n) {
    const int count = std::min<int>(n, static_cast<int>(points.size() - first));
    for (int i = 0; i < n; ++i) bench.wi.set(i, i < count ? points[first + i] : wo);
    bench.evaluate_with_density();
    for (int i = 0; i < count; ++i)
      expected[(first + i) / (kSub * kSub)] += bench.pdf[i] * cell / (kSub * kSub) * kSamples;
  }

  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(0, 1);
  const auto number = [&] { return std::min(uniform(random), 0.99999994f); };
  std::vector<float> lobe_u(n), u(n), v(n);
  for (int first = 0; first < kSamples; first += n) {
    for (int i = 0; i < n; ++i) lobe_u[i] = number(), u[i] = number(), v[i] = number();
    bench.sample(lobe_u.data(), u.data(), v.data());
    for (int i = 0; i < n; ++i) {
      if (bench.pdf[i] <= 0) continue;
      const int row = std::min(kCos - 1, static_cast<int>((bench.wi.z[i] + 1) / 2 * kCos));
      const double phi = std::atan2(bench.wi.y[i], bench.wi.x[i]);
      const int column = std::min(kPhi - 1, static_cast<int>((phi < 0 ? phi + 2 * M_PI : phi) / (2 * M_PI) * kPhi));
      seen[row * kPhi + column] += 1;
    }
  }

  double chi2 = 0, rest_expected = 0, rest_seen = 0;
  int freedom = 0;
  const auto add = [&](double s, double e) { chi2 += (s - e) * (s - e) / e, ++freedom; };
  for (size_t i = 0; i < expected.size(); ++i) {
    if (expected[i] < 5) rest_expected += expected[i], rest_seen += seen[i];
    else add(seen[i], expected[i]);
  }
  if (rest_expected >= 5) add(rest_seen, rest_expected);
  else EXPECT_LT(rest_seen, 30) << what << ": samples where the density is 0";
  // For many degrees of freedom chi^2 is normal with variance 2 k: five sigmas.
  EXPECT_LT(chi2, freedom + 5 * std::sqrt(2.0 * freedom)) << what << " wo " << wo;
}

}  // namespace whit::test
