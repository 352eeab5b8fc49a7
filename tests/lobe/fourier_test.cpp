// Tabulated BSDFs: the file reader and its errors, interpolation, colour, scaling of radiance, densities.
#include "core/lobe/fourier.h"

#include <algorithm>
#include <cstring>

#include "tests/lobe/lobe_bench.h"

namespace whit {
namespace {

using test::albedo;
using test::Bench;
using test::chi_squared;
using test::direction;

constexpr int kNodes = 17, kOrder = 3;

/// The tabulated function: smooth and positive, so that splines follow it closely.
double smooth_mean(double mu_o, double mu_i) { return (1.2 + 0.5 * mu_o * mu_i + 0.3 * mu_i) / (6 * M_PI); }
double smooth(double mu_o, double mu_i, double phi) {
  return smooth_mean(mu_o, mu_i) * (1 + 0.5 * std::cos(phi) + 0.2 * std::cos(2 * phi));
}

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::vector<double> even_nodes() {
  std::vector<double> mu;
  for (int i = 0; i < kNodes; ++i) mu.push_back(-1 + 2.0 * i / (kNodes - 1));
  return mu;
}

/// The content of a file that holds `smooth`, in all channels.
std::string make_file(int channels = 1, float eta = 1, const std::vector<double>& mu = even_nodes()) {
  std::string bytes("SCATFUN\x01", 8);
  const int nodes = static_cast<int>(mu.size()), pairs = nodes * nodes;
  for (const int32_t v : {1, nodes, pairs * kOrder * channels, kOrder, channels, 1, 0, 0, 0}) put(bytes, v);
  put(bytes, eta);
  for (int i = 0; i < 4; ++i) put(bytes, int32_t{0});
  for (const double m : mu) put(bytes, static_cast<float>(m));
  for (int k = 0; k < pairs; ++k) put(bytes, 0.0f);  // the integrals, which are not used
  for (int k = 0; k < pairs; ++k) put(bytes, int32_t{k * kOrder * channels}), put(bytes, int32_t{kOrder});
  for (int k = 0; k < pairs; ++k) {
    const double mean = smooth_mean(mu[static_cast<size_t>(k / nodes)], mu[static_cast<size_t>(k % nodes)]);
    for (int c = 0; c < channels; ++c) {
      for (const double a : {mean, 0.5 * mean, 0.2 * mean}) put(bytes, static_cast<float>(a * (1 - 0.25 * c)));
    }
  }
  return bytes;
}

FourierTable make_table(int channels = 1, float eta = 1) {
  FourierTable table;
  EXPECT_EQ(parse_fourier_table(make_file(channels, eta), table), "");
  return table;
}

void add_table(Bench& b, const FourierTable& table) { b.add(LobeType::Fourier).table = &table; }

TEST(Fourier, InterpolatesItsTable) {
  const FourierTable table = make_table();
  const int n = 500;
  Bench bench(n);
  add_table(bench, table);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < n; ++i) {
    bench.s.wo.set(i, direction(u(random), 3 * u(random))), bench.wi.set(i, direction(u(random), 3 * u(random)));
  }
  bench.evaluate();
  for (int i = 0; i < n; ++i) {
    const Vec3f o = bench.s.wo[i], w = -bench.wi[i];
    const double phi = std::atan2(o.y, o.x) - std::atan2(w.y, w.x);
    EXPECT_NEAR(bench.f.r[i], smooth(o.z, w.z, phi), 1e-6);
    EXPECT_EQ(bench.f.r[i], bench.f.g[i]);
  }
}

TEST(Fourier, ThreeChannelsAreLuminanceRedBlue) {
  const FourierTable table = make_table(3);
  Bench bench(1);
  add_table(bench, table);
  bench.s.wo.set(0, direction(0.5, 1)), bench.wi.set(0, direction(0.7, 2));
  bench.evaluate();
  const double y = smooth(0.5, -0.7, 1 - 2 + M_PI), r = 0.75 * y, b = 0.5 * y;
  EXPECT_NEAR(bench.f.r[0], r, 1e-6);
  EXPECT_NEAR(bench.f.g[0], 1.39829 * y - 0.100913 * b - 0.297375 * r, 1e-6);
  EXPECT_NEAR(bench.f.b[0], b, 1e-6);
}

TEST(Fourier, RadianceIsScaledThroughTheBoundary) {
  const FourierTable plain = make_table(1, 1), glass = make_table(1, 1.5f);
  Bench a(3), b(3);
  add_table(a, plain), add_table(b, glass);
  for (Bench* bench : {&a, &b}) {
    for (int i = 0; i < 3; ++i) bench->s.wo.set(i, direction(i == 1 ? -0.6 : 0.6, 1));
    // Seen from outside, light from inside; from inside, light from outside; reflection.
    bench->wi.set(0, direction(-0.4, 2)), bench->wi.set(1, direction(0.4, 2)), bench->wi.set(2, direction(0.4, 2));
    bench->evaluate();
  }
  EXPECT_NEAR(b.f.r[0] / a.f.r[0], 1 / 2.25, 1e-6);
  EXPECT_NEAR(b.f.r[1] / a.f.r[1], 2.25, 1e-5);
  EXPECT_EQ(b.f.r[2], a.f.r[2]);
}

TEST(Fourier, AlbedoIsThatOfTheTable) {
  const FourierTable table = make_table();
  Bench bench(1024);
  add_table(bench, table);
  // The integral over mu_i and phi of (1.2 + 0.5 mu_o mu_i + 0.3 mu_i) / (6 pi): 1.2 * 4 pi / (6 pi).
  EXPECT_NEAR(albedo(bench, direction(0.4, 1)), 0.8, 1e-3);
  EXPECT_NEAR(albedo(bench, direction(-0.9, 1)), 0.8, 1e-3);
}

TEST(Fourier, SamplingMatchesItsDensity) {
  const FourierTable table = make_table();
  for (const double cosine : {0.95, 0.3, -0.6}) {
    Bench bench(4096);
    add_table(bench, table);
    chi_squared(bench, direction(cosine, 2), "fourier");
  }
}

TEST(Fourier, DirectionsBeyondTheTableScatterNothing) {
  FourierTable table = make_table();
  for (float& mu : table.mu) mu *= 0.5f;
  Bench bench(2);
  add_table(bench, table);
  bench.s.wo.set(0, direction(0.9, 0)), bench.wi.set(0, direction(0.3, 0));
  bench.s.wo.set(1, direction(0.3, 0)), bench.wi.set(1, direction(-0.9, 0));
  bench.evaluate_with_density();
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(bench.f.r[i], 0);
    EXPECT_EQ(bench.pdf[i], 0);
  }
}

TEST(Fourier, CosinesMayStandTwice) {
  // All files of layerlab's have -0 and 0 in the middle. The function is linear in both cosines, which splines follow
  // exactly over any nodes; an interval without width is never looked up, and holds nothing to be sampled.
  std::vector<double> nodes = even_nodes();
  nodes[kNodes / 2] = -0.0;
  for (const double again : {-1.0, 0.0, 0.0, 0.5, 1.0, 1.0}) {
    nodes.insert(std::upper_bound(nodes.begin(), nodes.end(), again), again);
  }
  FourierTable table;
  ASSERT_EQ(parse_fourier_table(make_file(1, 1, nodes), table), "");
  std::vector<double> cosines = nodes;
  for (int i = 0; i < 40; ++i) cosines.push_back(std::sin(0.7 * i));
  for (const double o : cosines) {
    for (const double i : cosines) {
      Bench bench(1);
      add_table(bench, table);
      bench.s.wo.set(0, direction(o, 1)), bench.wi.set(0, direction(i, 2));
      bench.evaluate();
      const bool grazing = bench.s.wo.z[0] == 0 || bench.wi.z[0] == 0;
      // Along the normal there is no azimuth, and pbrt-v3 takes its cosine to be 1.
      const double phi = std::abs(o) == 1 || std::abs(i) == 1 ? 0 : 1 - 2 + M_PI;
      EXPECT_NEAR(bench.f.r[0], grazing ? 0 : smooth(o, -i, phi), 1e-6) << o << ' ' << i;
    }
  }
  for (const double cosine : {0.95, 0.02}) {
    Bench bench(4096);
    add_table(bench, table);
    chi_squared(bench, direction(cosine, 2), "fourier");
  }
}

TEST(Fourier, EqualCosinesAreAJump) {
  // 0.2 up to the first 0, 0.4 from the second on: two nodes off the jump the splines do not see it any more, and near it
  // they do not overshoot by more than 4/27 of it to either side, the extreme of t (1 - t)^2, whose factor is the slope
  // that the value on the other side makes.
  std::vector<double> nodes = even_nodes();
  nodes.insert(nodes.begin() + kNodes / 2, -0.0);
  FourierTable table;
  ASSERT_EQ(parse_fourier_table(make_file(1, 1, nodes), table), "");
  for (size_t k = 0; k < table.a.size(); ++k) {
    const size_t pair = k / kOrder, o = pair / nodes.size();
    table.a[k] = k % kOrder != 0 ? 0.0f : (o <= kNodes / 2 ? 0.2f : 0.4f);
  }
  for (const double o : {-0.9, -0.126, -0.1, -1e-3, -1e-7, 1e-7, 1e-3, 0.1, 0.126, 0.9}) {
    Bench bench(1);
    add_table(bench, table);
    bench.s.wo.set(0, direction(o, 1)), bench.wi.set(0, direction(0.3, 2));
    bench.evaluate();
    const double side = o < 0 ? 0.2 : 0.4;
    EXPECT_NEAR(bench.f.r[0], side, std::abs(o) > 0.125 ? 1e-6 : 0.2 * 4 / 27 + 1e-6) << o;
  }
}

TEST(Fourier, BrokenFilesAreRefusedWithAReason) {
  const std::string good = make_file();
  const auto problem = [](const std::string& bytes) {
    FourierTable table;
    return parse_fourier_table(bytes, table);
  };
  const auto with = [&](size_t offset, auto value) {
    std::string bytes = good;
    std::memcpy(bytes.data() + offset, &value, sizeof value);
    return problem(bytes);
  };
  EXPECT_EQ(problem(good), "");
  EXPECT_EQ(problem(""), "is not a bsdf file of version 1");
  EXPECT_EQ(with(0, 'X'), "is not a bsdf file of version 1");
  EXPECT_EQ(with(7, '\x02'), "is not a bsdf file of version 1");
  EXPECT_EQ(problem(good.substr(0, good.size() - 1)), "ends too early");
  EXPECT_EQ(with(12, int32_t{2000000000}), "ends too early") << "a hostile number of nodes";
  EXPECT_EQ(with(12, int32_t{-1}), "has a broken header");
  EXPECT_EQ(with(44, -1.0f), "has a broken header") << "an index of refraction below 0";
  EXPECT_NE(with(24, int32_t{2}).find("not supported"), std::string::npos) << "two channels";
  EXPECT_NE(with(8, int32_t{0}).find("not supported"), std::string::npos);
  EXPECT_EQ(with(64 + 4, -0.5f), "has cosines that decrease");
  EXPECT_EQ(problem(make_file(1, 1, std::vector<double>(3, 0.5))), "has but one cosine");
  EXPECT_EQ(with(64, -1.5f), "has a cosine outside [-1, 1]");
  const size_t series = 64 + 4 * (kNodes + kNodes * kNodes);
  EXPECT_EQ(with(series, int32_t{1000000}), "has a series that is longer than its coefficients");
  EXPECT_EQ(with(series, int32_t{-1}), "has a series that is longer than its coefficients");
  EXPECT_EQ(with(series + 4, int32_t{kOrder + 1}), "has a series that is longer than its coefficients");
  EXPECT_EQ(with(good.size() - 4, std::nanf("")), "holds numbers that are not finite");
}

}  // namespace
}  // namespace whit
