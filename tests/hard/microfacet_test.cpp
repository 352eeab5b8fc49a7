// Case 11: microfacets from nearly a mirror to as rough as can be.
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "core/lobe/formulas.h"
#include "tests/hard/glass.h"
#include "tests/hard/hard_case.h"
#include "tests/lobe/lobe_bench.h"

namespace whit {
namespace {

using namespace test;

constexpr float kAlphas[] = {1e-6f, 1e-5f, 1e-4f, 1e-3f, 0.01f, 0.1f, 0.3f, 0.6f, 1.0f};
constexpr double kCosines[] = {1, 0.5, 0.1, 0.01, 1e-3, -0.01, -0.5};

/// A surface of microfacets by name.
struct Surface {
  const char* name;
  std::function<void(Bench&, float alpha)> add;
};
const std::vector<Surface>& surfaces() {
  static const std::vector<Surface> all = {
      {"mirror", [](Bench& b, float a) { b.add(LobeType::MicrofacetReflection, a, a, 1.5f, FresnelType::One); }},
      {"reflection", [](Bench& b, float a) { b.add(LobeType::MicrofacetReflection, a, a); }},
      {"anisotropic",
       [](Bench& b, float a) {
         b.add(LobeType::MicrofacetReflection, a, std::min(1.0f, 10 * a), 1.5f, FresnelType::One);
       }},
      {"metal", [](Bench& b, float a) { b.add_metal(a, a); }},
      {"transmission", [](Bench& b, float a) { b.add(LobeType::MicrofacetTransmission, a, a); }}};
  return all;
}

TEST(Hard, MicrofacetEnergy) {
  // No light from nowhere: the directional albedo, 512 x 512 samples by the lobe's density, is at most 1; of transmission
  // with the scaling of radiance taken back. Where the density is that of the lobe the samples' weights hardly differ.
  HardCase energy({11, "albedo of microfacets", "alpha 1e-6 to 1, cosines 1 to 1e-3, both sides; five kinds",
                   "how far it exceeds 1", 0.01, ""});
  for (const Surface& surface : surfaces()) {
    for (const float alpha : kAlphas) {
      for (const double cosine : kCosines) {
        Bench bench(4096);
        surface.add(bench, alpha);
        const double n = cosine > 0 ? 1.5 : 1 / 1.5;
        const double scale = surface.name == std::string("transmission") ? n * n : 1;
        const double a = albedo(bench, direction(cosine, 0.3)) * scale;
        const std::string at = fmt::format("{} alpha {} cosine {}", surface.name, alpha, cosine);
        energy.see(std::isfinite(a) ? std::max(0.0, a - 1) : INFINITY, at);
      }
    }
  }
}

TEST(Hard, MicrofacetSpecularLimit) {
  // Facets this smooth are the flat boundary: its reflectance R, and 1 - R for what goes through. Facets tilted by alpha
  // change the cosine by as much to both sides: no difference to first order, and R's curvature is below 100 here, so
  // alpha^2 x 100 is what tails leave, 1e-4; tails that end below the surface as much again. Refracted directions are
  // floats: their half vector, a sum of about 0.5, is known to some 1e-7, a tenth of an alpha of 1e-6, which the density
  // of facets takes for part of the tilt. But it does so in the value and in the density of the sample, and cancels.
  HardCase limit({11, "albedo of smooth microfacets against Fresnel's equations",
                  "alpha 1e-6 to 1e-3, cosines 1 to 0.1", "difference", 0.0005, ""});
  for (const float alpha : {1e-6f, 1e-5f, 1e-4f, 1e-3f}) {
    for (const double cosine : {1.0, 0.9, 0.5, 0.1, -0.9, -0.5, -1.0}) {
      const double n = cosine > 0 ? 1.5 : 1 / 1.5, r = reflectance(std::abs(cosine), n);
      Bench mirror(4096), reflecting(4096), refracting(4096);
      mirror.add(LobeType::MicrofacetReflection, alpha, alpha, 1.5f, FresnelType::One);
      reflecting.add(LobeType::MicrofacetReflection, alpha, alpha);
      refracting.add(LobeType::MicrofacetTransmission, alpha, alpha);
      const Vec3f wo = direction(cosine, 0.3);
      const std::string at = fmt::format("alpha {} cosine {}", alpha, cosine);
      const double m = albedo(mirror, wo), a = albedo(reflecting, wo), t = albedo(refracting, wo) * n * n;
      limit.see(std::abs(m - 1), at);
      limit.see(std::abs(a - r), at);
      limit.see(std::abs(t - (1 - r)), at);
    }
  }
}

/// Pearson's statistic of the facets that reflect wo's samples, in standard deviations above its mean. Slopes of facets
/// over alpha have the distribution r^2 / (1 + r^2) of their length r and any azimuth. That is the whole of it where wo
/// is the normal; for oblique ones a facet is seen by 1 + alpha r tan(theta) cos(azimuth), which hardly differs from 1
/// where alpha is small.
double chi_squared_of_facets(float alpha, double cosine) {
  constexpr int kCells = 16, kSamples = 1 << 16;
  Bench bench(4096);
  bench.add(LobeType::MicrofacetReflection, alpha, alpha, 1.5f, FresnelType::One);
  const int n = bench.s.n;
  const Vec3f wo = direction(cosine, 0.3);
  for (int i = 0; i < n; ++i) bench.s.wo.set(i, wo);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<float> zero(n), u(n), v(n);
  std::vector<double> seen(kCells * kCells);
  for (int first = 0; first < kSamples; first += n) {
    for (int i = 0; i < n; ++i)
      u[i] = std::min(uniform(random), 0.99999994f), v[i] = std::min(uniform(random), 0.99999994f);
    bench.sample(zero.data(), u.data(), v.data());
    for (int i = 0; i < n; ++i) {
      if (!(bench.pdf[i] > 0)) continue;
      const Vec3d h = Vec3d(wo) + Vec3d(bench.wi[i]);
      const double x = h.x / h.z / static_cast<double>(alpha), y = h.y / h.z / static_cast<double>(alpha);
      const double share = (x * x + y * y) / (1 + x * x + y * y), turn = std::atan2(y, x) / (2 * M_PI) + 0.5;
      const int row = std::min(kCells - 1, static_cast<int>(share * kCells));
      seen[row * kCells + std::min(kCells - 1, static_cast<int>(turn * kCells))] += 1;
    }
  }
  // Seen along the normal, facets steeper than 45 degrees send light below the surface: slopes up to 1 are counted.
  const double steepest = 1 / (1 + static_cast<double>(alpha) * static_cast<double>(alpha));
  const double expected = static_cast<double>(kSamples) / (kCells * kCells);
  double chi2 = 0;
  int freedom = 0;
  for (int row = 0; row < kCells && (row + 1.0) / kCells <= steepest; ++row) {
    for (int k = 0; k < kCells; ++k, ++freedom) {
      const double d = seen[row * kCells + k] - expected;
      chi2 += d * d / expected;
    }
  }
  return (chi2 - freedom) / std::sqrt(2.0 * freedom);
}

TEST(Hard, MicrofacetSamples) {
  // Normal for so many degrees of freedom (256, half of them at alpha 1): five standard deviations. Directions are floats,
  // so a half vector is known to 6e-8 / (2 cosine) or so: the oblique ones stop where that is a hundredth of alpha.
  HardCase chi({11, "chi-square of sampled facets",
                "alpha 1e-6 to 1 along the normal, 1e-5 to 1e-3 at cosine 0.5; 65536 samples in 256 cells",
                "standard deviations above the mean", 5, ""});
  for (const float alpha : kAlphas) chi.see(chi_squared_of_facets(alpha, 1), fmt::format("alpha {} cosine 1", alpha));
  for (const float alpha : {1e-5f, 1e-4f, 1e-3f}) {
    chi.see(chi_squared_of_facets(alpha, 0.5), fmt::format("alpha {} cosine 0.5", alpha));
  }
  // Of rough facets, reflecting and refracting, the whole density: chi_squared() makes its own checks.
  for (const float alpha : {0.15f, 0.6f, 1.0f}) {
    for (const double cosine : {0.7, 0.1, -0.8}) {
      Bench bench(4096);
      bench.add(LobeType::MicrofacetReflection, alpha, alpha),
          bench.add(LobeType::MicrofacetTransmission, alpha, alpha);
      chi_squared(bench, direction(cosine, 2), "rough glass");
    }
  }
}

TEST(Hard, MicrofacetsAreNumbers) {
  // Mirror directions, grazing ones, opposite ones and such from behind: values are finite and not negative.
  HardCase numbers({11, "values and densities that are NaN, infinite or negative",
                    "alpha 1e-6 to 1, five kinds, indices 0.001 to 1000, 441 pairs of directions", "how many", 0, ""});
  std::vector<Vec3f> directions = {{1, 0, 0}};
  for (const double c : {1.0, 0.6, 0.01, 1e-7, 1e-20}) {
    for (const double phi : {0.0, M_PI})
      directions.push_back(direction(c, phi)), directions.push_back(direction(-c, phi));
  }
  const int count = static_cast<int>(directions.size()), n = count * count;
  for (const Surface& surface : surfaces()) {
    for (const float alpha : kAlphas) {
      for (const float eta : {1e-3f, 0.5f, 1.0f, 1.5f, 1e3f}) {
        Bench bench(n);
        surface.add(bench, alpha);
        bench.set.lobes[0].eta = bench.constant(eta);
        for (int i = 0; i < n; ++i) bench.s.wo.set(i, directions[i / count]), bench.wi.set(i, directions[i % count]);
        bench.evaluate_with_density();
        int wrong = 0;
        for (int i = 0; i < n; ++i) {
          const float values[] = {bench.f.r[i], bench.f.g[i], bench.f.b[i], bench.pdf[i]};
          for (const float v : values) wrong += !(v >= 0 && v < std::numeric_limits<float>::infinity());
        }
        numbers.see(wrong, fmt::format("{} alpha {} eta {}", surface.name, alpha, eta));
      }
    }
  }
}

}  // namespace
}  // namespace whit
