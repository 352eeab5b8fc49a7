// What holds of every type of lobe there is: each test goes over the rows of the table.
#include "core/lobe/table.h"

#include <cstdio>
#include <cstring>
#include <limits>
#include <set>
#include <string>

#include "core/lobe/formulas.h"
#include "core/lobe/fourier.h"
#include "tests/lobe/lobe_bench.h"

namespace whit {
namespace {

using test::Bench;
using test::chi_squared;
using test::direction;

/// A tabulated BSDF that scatters some light evenly to all directions.
const FourierTable& even_table() {
  static const FourierTable table = [] {
    std::string bytes("SCATFUN\x01", 8);
    const auto put = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
    // 3 x 3 cosines, all with the series of one coefficient that all share: f |cos| = 0.05.
    for (const int32_t v : {1, 3, 1, 1, 1, 1, 0, 0, 0}) put(v);
    put(1.0f);
    for (int i = 0; i < 4; ++i) put(int32_t{0});
    for (const float mu : {-1.0f, 0.0f, 1.0f}) put(mu);
    for (int k = 0; k < 9; ++k) put(0.0f);
    for (int k = 0; k < 9; ++k) put(int32_t{0}), put(int32_t{1});
    put(0.05f);
    FourierTable t;
    EXPECT_EQ(parse_fourier_table(bytes, t), "");
    return t;
  }();
  return table;
}

/// A lobe with parameters that suit every type.
void add_example(Bench& b, LobeType type, float a = 0.3f, float b_ = 0.3f, float eta = 1.5f) {
  Lobe& lobe = b.add(type, a, b_, eta);
  lobe.c = b.constant(0.4f), lobe.d = b.constant(0.03f);
  lobe.colour1 = {b.constant(0.2f), b.constant(0.3f), b.constant(0.4f)};
  lobe.colour2 = {b.constant(0.3f), b.constant(0.2f), b.constant(0.1f)};
  lobe.table = &even_table();
}

/// Calls test(name, type, b) for every type, and again with different alphas where that makes another lobe.
template <class Test>
void for_every_lobe(const Test& test) {
  const auto rows = all_rows();
  for (size_t k = 0; k < rows.size(); ++k) {
    const auto type = static_cast<LobeType>(k);
    test(std::string(rows[k]->name), type, 0.3f);
    if (rows[k]->needs_frame) test(std::string("anisotropic ") + rows[k]->name, type, 0.6f);
  }
}

constexpr double kCosines[] = {0.95, 0.4, -0.7};

/// Numbers in [0, 1) for a bench, different in every call.
struct Numbers {
  explicit Numbers(int n) : lobe(n), u(n), v(n) {}
  void draw() {
    for (std::vector<float>* to : {&lobe, &u, &v}) {
      for (float& x : *to) x = std::min(uniform(random), 0.99999994f);
    }
  }
  std::vector<float> lobe, u, v;
  std::mt19937 random{11};
  std::uniform_real_distribution<float> uniform{0, 1};
};

TEST(EveryLobe, HasANameOfItsOwn) {
  std::set<std::string> names;
  for (const LobeRow* row : all_rows()) {
    EXPECT_TRUE(names.insert(row->name).second) << row->name;
    EXPECT_TRUE(row->reflects || row->transmits) << row->name;
    EXPECT_EQ(row->specular, row->eval == nullptr) << row->name;
    EXPECT_NE(row->sample, nullptr) << row->name;
  }
  std::printf("%zu lobes\n", names.size());  // what follows the page on adding one looks for it
  EXPECT_STREQ(row_of(LobeType::OrenNayar).name, "Oren-Nayar");
  EXPECT_STREQ(row_of(LobeType::SpecularTransmission).name, "specular transmission");
}

TEST(EveryLobe, ScattersToTheSidesItNames) {
  // A lobe that does not name a side must give no light there: renderers leave lights out that are on it.
  for_every_lobe([](const std::string& name, LobeType type, float b) {
    const LobeRow& row = row_of(type);
    const int n = 4096;
    Bench bench(n);
    add_example(bench, type, 0.3f, b);
    Numbers numbers(n);
    numbers.draw();
    for (int i = 0; i < n; ++i) bench.s.wo.set(i, direction(2 * numbers.u[i] - 1, 6 * numbers.v[i]));
    numbers.draw();
    bench.sample(numbers.lobe.data(), numbers.u.data(), numbers.v.data(), LobeKinds::All);
    int sampled[2] = {0, 0}, lit[2] = {0, 0};
    const auto side = [&](int i) { return bench.wi.z[i] * bench.s.wo.z[i] > 0; };
    for (int i = 0; i < n; ++i) sampled[side(i)] += bench.pdf[i] > 0;
    numbers.draw();
    for (int i = 0; i < n; ++i) bench.wi.set(i, direction(2 * numbers.u[i] - 1, 6 * numbers.v[i]));
    bench.evaluate();
    for (int i = 0; i < n; ++i) lit[side(i)] += bench.f.g[i] > 0;
    EXPECT_EQ(sampled[1] > 0, row.reflects) << name;
    EXPECT_EQ(sampled[0] > 0, row.transmits) << name;
    EXPECT_EQ(lit[1] > 0, row.reflects && !row.specular) << name;
    EXPECT_EQ(lit[0] > 0, row.transmits && !row.specular) << name;
  });
}

TEST(EveryLobe, WeightTimesDensityIsTheValue) {
  for_every_lobe([](const std::string& name, LobeType type, float b) {
    if (row_of(type).specular) return;
    const int n = 4096;
    Bench bench(n);
    add_example(bench, type, 0.3f, b);
    Numbers numbers(n);
    numbers.draw();
    for (int i = 0; i < n; ++i) bench.s.wo.set(i, direction(2 * numbers.u[i] - 1, 6 * numbers.v[i]));
    numbers.draw();
    bench.sample(numbers.lobe.data(), numbers.u.data(), numbers.v.data());
    std::vector<RGB> value(n);
    std::vector<float> pdf(bench.pdf, bench.pdf + n);
    for (int i = 0; i < n; ++i) value[i] = bench.f[i] * pdf[i];
    bench.evaluate_with_density();
    int came = 0;
    for (int i = 0; i < n; ++i) {
      EXPECT_NEAR(length(bench.wi[i]), 1, 1e-6) << name;
      if (pdf[i] == 0) {
        EXPECT_EQ(bench.wi[i], -bench.s.wo[i]) << name;
        EXPECT_EQ(value[i], RGB(0, 0, 0)) << name;
        continue;
      }
      ++came;
      ASSERT_EQ(pdf[i], bench.pdf[i]) << name;
      // A quotient and a product: two roundings.
      EXPECT_NEAR(value[i].x, bench.f.r[i], 2e-7f * bench.f.r[i]) << name;
      EXPECT_NEAR(value[i].z, bench.f.b[i], 2e-7f * bench.f.b[i]) << name;
    }
    EXPECT_GT(came, n / 2) << name;
  });
}

TEST(EveryLobe, SamplingMatchesItsDensity) {
  for_every_lobe([](const std::string& name, LobeType type, float b) {
    if (row_of(type).specular) return;
    for (const double cosine : kCosines) {
      Bench bench(4096);
      add_example(bench, type, 0.3f, b);
      chi_squared(bench, direction(cosine, 2), name.c_str());
    }
  });
}

/// The integral of the density over the sphere, by a grid of equal solid angles.
double integral_of_density(Bench& bench, LobeKinds kinds) {
  const int side = 512, n = bench.s.n;
  double sum = 0;
  for (int first = 0; first < side * side; first += n) {
    for (int i = 0; i < n; ++i) {
      const int k = first + i;
      bench.wi.set(i, direction(-1 + 2 * (k / side + 0.5) / side, 2 * M_PI * (k % side + 0.5) / side));
    }
    bench.evaluate_with_density(kinds);
    for (int i = 0; i < n; ++i) sum += bench.pdf[i];
  }
  return sum * 4 * M_PI / (side * side);
}

/// The share of samples that are specular, and that are not; what is left came to nothing.
struct Came {
  double specular = 0, other = 0;
};
Came came(Bench& bench, LobeKinds kinds) {
  const int rounds = 64, n = bench.s.n;
  Numbers numbers(n);
  Came all;
  for (int r = 0; r < rounds; ++r) {
    numbers.draw();
    bench.sample(numbers.lobe.data(), numbers.u.data(), numbers.v.data(), kinds);
    for (int i = 0; i < n; ++i) {
      const bool delta = bench.pdf[i] == std::numeric_limits<float>::infinity();
      all.specular += delta, all.other += !delta && bench.pdf[i] > 0;
    }
  }
  return {all.specular / (rounds * n), all.other / (rounds * n)};
}

TEST(EveryLobe, DensitiesAddUpToTheChanceThatNoSpecularLobeIsChosen) {
  for_every_lobe([](const std::string& name, LobeType type, float b) {
    if (row_of(type).specular) return;
    for (const double cosine : kCosines) {
      Bench bench(4096);
      add_example(bench, type, 0.3f, b);
      add_example(bench, LobeType::SpecularReflection);
      add_example(bench, LobeType::SpecularTransmission);
      for (int i = 0; i < bench.s.n; ++i) bench.s.wo.set(i, direction(cosine, 2));
      const Came all = came(bench, LobeKinds::All), rough = came(bench, LobeKinds::NonSpecular);
      EXPECT_GT(all.specular, 0.1) << name;
      EXPECT_EQ(rough.specular, 0) << name;
      // 262144 samples: four standard deviations are 4 x 0.5 / 512. The grid is that good for these parameters.
      const double part = integral_of_density(bench, LobeKinds::All),
                   whole = integral_of_density(bench, LobeKinds::NonSpecular);
      EXPECT_NEAR(part, all.other, 0.004) << name << ' ' << cosine;
      EXPECT_NEAR(whole, rough.other, 0.004) << name << ' ' << cosine;
      // Where every sample of the lobe comes out, nothing is lost.
      EXPECT_NEAR(part, whole * (1 - all.specular), 0.004) << name << ' ' << cosine;
      EXPECT_LE(whole, 1.002) << name << ' ' << cosine;
    }
  });
}

TEST(EveryLobe, AnswersDoNotDependOnTheBatch) {
  // Every lane among others and alone: the same bits.
  for_every_lobe([](const std::string& name, LobeType type, float b) {
    const int n = 61;
    Bench bench(n);
    add_example(bench, LobeType::SpecularReflection), add_example(bench, type, 0.3f, b);
    Numbers numbers(n);
    numbers.draw();
    for (int i = 0; i < n; ++i) bench.s.wo.set(i, direction(2 * numbers.u[i] - 1, 6 * numbers.v[i]));
    numbers.draw();
    const auto answers = [&](int first, int count) {
      const ShadingBatch& all = bench.s;
      ShadingBatch s = all;
      s.n = count;
      for (Vec3Lanes ShadingBatch::*m : {&ShadingBatch::wo, &ShadingBatch::ng, &ShadingBatch::ns, &ShadingBatch::dpdu})
        s.*m = (all.*m).from(first);
      const ArenaScope scratch(bench.arena);
      // The parameters are the same in all lanes.
      sample_lobes(bench.set, s, prepare_frame(bench.set, s), &numbers.lobe[first], &numbers.u[first],
                   &numbers.v[first], LobeKinds::All, {bench.wi, bench.f, bench.pdf, bench.eta2});
      std::vector<float> out;
      for (int i = 0; i < count; ++i) {
        const Vec3f wi = bench.wi[i];
        const RGB w = bench.f[i];
        out.insert(out.end(), {wi.x, wi.y, wi.z, w.x, w.y, w.z, bench.pdf[i], bench.eta2[i]});
      }
      return out;
    };
    const std::vector<float> together = answers(0, n);
    std::vector<float> alone;
    for (int i = 0; i < n; ++i) {
      const std::vector<float> one = answers(i, 1);
      alone.insert(alone.end(), one.begin(), one.end());
    }
    EXPECT_EQ(std::memcmp(together.data(), alone.data(), together.size() * sizeof(float)), 0) << name;
  });
}

TEST(EveryLobe, BlackLanesSampleNothing) {
  for_every_lobe([](const std::string& name, LobeType type, float b) {
    Bench bench(3);
    add_example(bench, type, 0.3f, b);
    add_example(bench, LobeType::LambertReflection);
    for (int i = 0; i < 3; ++i) bench.s.wo.set(i, direction(0.8, i));
    // Lane 0 has no lobe at all, lane 1 lost the lobe, lane 2 the other.
    for (const int lane : {0, 1}) bench.set.lobes[0].weight.set(lane, {0, 0, 0});
    for (const int lane : {0, 2}) bench.set.lobes[1].weight.set(lane, {0, 0, 0});
    const float lobe[] = {0.1f, 0.0f, 0.9999f}, u[] = {0.6f, 0.6f, 0.6f}, v[] = {0.3f, 0.3f, 0.3f};
    bench.sample(lobe, u, v, LobeKinds::All);
    EXPECT_EQ(bench.pdf[0], 0) << name;
    EXPECT_EQ(bench.f[0], RGB(0, 0, 0)) << name;
    EXPECT_EQ(bench.wi[0], -bench.s.wo[0]) << name;
    EXPECT_NEAR(bench.pdf[1], bench.wi.z[1] * kInvPi, 1e-7) << name;
    EXPECT_NEAR(bench.f.r[1], 1, 1e-6) << name;
    EXPECT_GT(bench.pdf[2], 0) << name;
    bench.evaluate_with_density();
    EXPECT_EQ(bench.pdf[0], 0) << name;
  });
}

TEST(EveryLobe, DegenerateDirectionsGiveNoNan) {
  const std::vector<Vec3f> directions = {{0, 0, 1},        {0, 0, -1},       {1, 0, 0},      {-1, 0, 0},
                                         {1, 0, 1e-20f},   {1, 0, -1e-20f},  {-1, 0, 1e-7f}, {0, 1, 1e-4f},
                                         {0.6f, 0, -0.8f}, {-0.6f, 0, 0.8f}, {0.6f, 0, 0.8f}};
  constexpr float kNumbers[] = {0, 1e-8f, 0.5f, 0.25f, 0.99999994f};
  const int all = static_cast<int>(directions.size()), n = all * all * 5;
  for_every_lobe([&](const std::string& name, LobeType type, float b) {
    for (const float alpha : {kMinAlpha, 0.3f, 0.999f}) {
      for (const float eta : {1.0f, 1.5f, 1 / 1.5f, 1e-3f, 1e3f}) {
        Bench bench(n);
        add_example(bench, type, alpha, b == 0.3f ? alpha : 2 * alpha, eta);
        std::vector<float> u(n), v(n), lobe(n);
        for (int i = 0; i < n; ++i) {
          bench.s.wo.set(i, directions[i % all]), bench.wi.set(i, directions[i / all % all]);
          bench.s.dpdu.set(i, {0, 0, 0});
          u[i] = kNumbers[i / all % 5], v[i] = kNumbers[i / all / 5 % 5], lobe[i] = kNumbers[i % 5];
        }
        const auto are_numbers = [&](bool specular) {
          for (int i = 0; i < n; ++i) {
            const RGB f = bench.f[i];
            const bool infinite = specular && bench.pdf[i] == std::numeric_limits<float>::infinity();
            ASSERT_TRUE(std::isfinite(f.x + f.y + f.z) && f.x >= 0 && (std::isfinite(bench.pdf[i]) || infinite) &&
                        bench.pdf[i] >= 0)
                << name << " alpha " << alpha << " eta " << eta << " wo " << bench.s.wo[i] << " wi " << bench.wi[i];
          }
        };
        bench.evaluate_with_density();
        are_numbers(false);
        bench.sample(lobe.data(), u.data(), v.data(), LobeKinds::All);
        are_numbers(row_of(type).specular);
        for (int i = 0; i < n; ++i) ASSERT_NEAR(length(bench.wi[i]), 1, 1e-5) << name;
      }
    }
  });
}

TEST(SampleLobes, GlassReflectsAsOftenAsItReflectsLight) {
  // Of n equally spaced choices the nearest whole number to n F reflect; their weight is 1, that of the others the
  // scaling of radiance, so that the mean is R + T whatever F is.
  const int n = 1000;
  for (const double cosine : {0.9, 0.2, 0.01, -0.9, -0.75, -0.3}) {
    Bench bench(n);
    bench.add(LobeType::SpecularReflection), bench.add(LobeType::SpecularTransmission);
    std::vector<float> lobe(n), zero(n);
    for (int i = 0; i < n; ++i) bench.s.wo.set(i, direction(cosine, 1)), lobe[i] = (static_cast<float>(i) + 0.5f) / n;
    bench.sample(lobe.data(), zero.data(), zero.data(), LobeKinds::All);
    const double m = cosine > 0 ? 1.5 : 1 / 1.5;
    int reflected = 0;
    for (int i = 0; i < n; ++i) {
      EXPECT_EQ(bench.pdf[i], std::numeric_limits<float>::infinity());
      const bool reflects = bench.wi.z[i] * cosine > 0;
      reflected += reflects;
      EXPECT_NEAR(bench.f.r[i], reflects ? 1 : 1 / (m * m), 1e-6);
      EXPECT_NEAR(bench.eta2[i], reflects ? 1 : m * m, 1e-6);
      // Snell's law.
      EXPECT_NEAR(bench.wi.x[i] * (reflects ? 1 : m), -bench.s.wo.x[i], 1e-6);
    }
    EXPECT_NEAR(reflected, n * fresnel_dielectric(static_cast<float>(cosine), 1.5f), 1) << cosine;
    bench.sample(lobe.data(), zero.data(), zero.data(), LobeKinds::NonSpecular);
    for (int i = 0; i < n; ++i) EXPECT_EQ(bench.pdf[i], 0);
  }
}

TEST(SampleLobes, ALobeThatReflectsNothingIsNotThere) {
  // An index of 1 has no mirror image: alone, nothing comes out; with refraction, all goes through and straight on.
  Bench alone(1), both(1);
  for (Bench* bench : {&alone, &both}) {
    bench->add(LobeType::SpecularReflection, 0, 0, 1), bench->s.wo.set(0, direction(0.5, 1));
  }
  both.add(LobeType::SpecularTransmission, 0, 0, 1);
  const float zero = 0;
  alone.sample(&zero, &zero, &zero, LobeKinds::All), both.sample(&zero, &zero, &zero, LobeKinds::All);
  EXPECT_EQ(alone.pdf[0], 0);
  EXPECT_EQ(alone.f[0], RGB(0, 0, 0));
  EXPECT_EQ(both.pdf[0], std::numeric_limits<float>::infinity());
  EXPECT_EQ(both.f[0], RGB(1, 1, 1));
  for (const Bench* bench : {&alone, &both}) EXPECT_EQ(bench->wi[0], -bench->s.wo[0]);
}

TEST(SampleLobes, MixedLobesKeepTheirSum) {
  // The mean weight of all lobes together is the sum of those of each alone; different weights, colours and Fresnel
  // factors only move the choice. With 262144 samples of weights that differ by less than 2, four standard deviations
  // are below 0.016.
  const auto rows = all_rows();
  for (const double cosine : kCosines) {
    const auto mean = [&](const auto& takes) {
      Bench bench(4096);
      for (size_t k = 0; k < rows.size(); ++k) {
        const auto type = static_cast<LobeType>(k);
        if (!takes(type)) continue;
        add_example(bench, type);
        // Of unequal strength, and coloured.
        const float weight = 0.05f * static_cast<float>(1 + k % 3);
        bench.set.lobes[bench.set.count - 1].weight = {bench.constant(weight), bench.constant(0.1f), bench.constant(0)};
      }
      for (int i = 0; i < bench.s.n; ++i) bench.s.wo.set(i, direction(cosine, 2));
      Numbers numbers(bench.s.n);
      Vec3d sum(0);
      for (int r = 0; r < 64; ++r) {
        numbers.draw();
        bench.sample(numbers.lobe.data(), numbers.u.data(), numbers.v.data(), LobeKinds::All);
        for (int i = 0; i < bench.s.n; ++i) sum += Vec3d(bench.f.r[i], bench.f.g[i], bench.f.b[i]);
      }
      return sum / (64.0 * bench.s.n);
    };
    const Vec3d together = mean([](LobeType) { return true; });
    Vec3d apart(0);
    for (size_t k = 0; k < rows.size(); ++k) apart += mean([&](LobeType t) { return static_cast<size_t>(t) == k; });
    EXPECT_NEAR(together.x, apart.x, 0.01) << cosine;
    EXPECT_NEAR(together.y, apart.y, 0.01) << cosine;
    EXPECT_EQ(together.z, 0);
  }
}

}  // namespace
}  // namespace whit
