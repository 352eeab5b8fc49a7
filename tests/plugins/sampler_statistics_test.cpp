// Samplers: stateless, uniform, and (halton) evenly spread, with the error of integrals to show for it.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "core/plugin/sampler.h"
#include "tests/plugins/make_plugin.h"

namespace whit {
namespace {

using namespace test;

Made<Sampler> make_sampler(const char* name, int samples, ParameterList parameters = {}) {
  parameters.push_back(integer("pixelsamples", samples));
  Made<Sampler> s = make_plugin<Sampler>("sampler", name, std::move(parameters));
  EXPECT_TRUE(s.silent());
  EXPECT_TRUE(s.prepare());
  return s;
}

/// All samples of one pixel.
struct Keys {
  Keys(int n, int x, int y, uint32_t branch = 0) : px(n, x), py(n, y), index(n), stream(n, branch), u(n), v(n) {
    for (int i = 0; i < n; ++i) index[i] = static_cast<uint32_t>(i);
  }
  SampleKeys keys(int first = 0, int count = -1) const {
    return {count < 0 ? static_cast<int>(px.size()) : count, px.data() + first, py.data() + first, index.data() + first,
            stream.data() + first};
  }
  Keys& draw(const Sampler& s, int dimension) {
    s.get_2d(keys(), dimension, u.data(), v.data());
    return *this;
  }
  std::vector<int32_t> px, py;
  std::vector<uint32_t> index, stream;
  std::vector<float> u, v;
};

class AllSamplers : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Samplers, AllSamplers, testing::Values("random", "halton"));

TEST_P(AllSamplers, AreStateless) {
  // A batch of mixed keys equals its lanes one by one, in any order, for counts that need shuffling and do not.
  for (const int samples : {1, 7, 16, 49}) {
    const auto s = make_sampler(GetParam(), samples);
    constexpr int kCount = 301;
    Keys all(kCount, 0, 0);
    for (int i = 0; i < kCount; ++i) {
      all.px[i] = (i * 37) % 19 - 3, all.py[i] = (i * 11) % 7 - 2;
      all.index[i] = static_cast<uint32_t>(i % samples), all.stream[i] = static_cast<uint32_t>(i % 3);
    }
    Keys single = all;
    all.draw(*s.plugin, 5);
    for (int i = kCount - 1; i >= 0; --i) s->get_2d(single.keys(i, 1), 5, &single.u[i], &single.v[i]);
    EXPECT_EQ(all.u, single.u);
    EXPECT_EQ(all.v, single.v);
    s->get_1d(all.keys(), 9, all.u.data());
    for (int i = kCount - 1; i >= 0; --i) s->get_1d(single.keys(i, 1), 9, &single.u[i]);
    EXPECT_EQ(all.u, single.u);
  }
}

TEST_P(AllSamplers, AreUniform) {
  // 4096 pixels x 16 samples in 10 x 10 boxes: chi squared with 99 degrees of freedom is below 160 with p > 0.9999.
  const auto s = make_sampler(GetParam(), 16);
  for (const int dimension : {0, 2, 41, 5000}) {
    std::vector<double> boxes(100);
    for (int pixel = 0; pixel < 4096; ++pixel) {
      Keys k(16, pixel % 64, pixel / 64);
      k.draw(*s.plugin, dimension);
      for (int i = 0; i < 16; ++i) {
        ASSERT_GE(k.u[i], 0);
        ASSERT_LE(k.u[i], 0x1.fffffep-1f);
        ASSERT_GE(k.v[i], 0);
        ASSERT_LE(k.v[i], 0x1.fffffep-1f);
        ++boxes[static_cast<size_t>(10 * k.u[i]) * 10 + static_cast<size_t>(10 * k.v[i])];
      }
    }
    double chi2 = 0;
    for (const double b : boxes) chi2 += (b - 655.36) * (b - 655.36) / 655.36;
    EXPECT_LT(chi2, 160) << "dimension " << dimension;
  }
}

TEST_P(AllSamplers, KeysMatter) {
  // Another pixel, branch, dimension or seed gives other numbers.
  const auto s = make_sampler(GetParam(), 16);
  std::set<float> first;
  for (const auto& [x, y, branch, dimension] :
       {std::array{0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {-1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 2}}) {
    first.insert(Keys(16, x, y, static_cast<uint32_t>(branch)).draw(*s.plugin, dimension).u[3]);
  }
  s->seed = 1;
  first.insert(Keys(16, 0, 0).draw(*s.plugin, 0).u[3]);
  EXPECT_EQ(first.size(), 7u);
}

TEST_P(AllSamplers, CountsAreKeptAndChecked) {
  const auto s = make_sampler(GetParam(), 12);
  EXPECT_EQ(s->samples_per_pixel(), 12);
  EXPECT_EQ(s->set_samples_per_pixel(100), 100);
  EXPECT_EQ(s->samples_per_pixel(), 100);
  EXPECT_EQ(s->set_samples_per_pixel(0), 1);
  EXPECT_FALSE(make_plugin<Sampler>("sampler", GetParam(), {integer("pixelsamples", 0)}).good());
}

/// True when every interval [k/cells, (k+1)/cells) holds equally many of the values.
bool equally_many(const std::vector<float>& values, int cells) {
  std::vector<int> count(static_cast<size_t>(cells));
  for (const float v : values) ++count[static_cast<size_t>(static_cast<double>(v) * cells)];
  return std::set<int>(count.begin(), count.end()).size() == 1;
}

TEST(Halton, ElementaryIntervalsHoldEquallyMany) {
  // 36 = 2^2 3^2 samples: every box of a 2^a x 3^b grid, a, b <= 2, holds 36 / (2^a 3^b) of them, in any dimension;
  // and one dimension alone has one in each of 2^6 = 64 intervals for 64 samples, 3^4 = 81 for 81.
  const auto s36 = make_sampler("halton", 36), s64 = make_sampler("halton", 64), s81 = make_sampler("halton", 81);
  for (const int dimension : {0, 1, 2, 30, 1001}) {
    for (int pixel = 0; pixel < 5; ++pixel) {
      Keys k(36, pixel, 3 * pixel + 1);
      k.draw(*s36.plugin, dimension);
      for (const auto& [columns, rows] : {std::pair{4, 9}, {2, 9}, {4, 3}, {2, 3}, {1, 9}, {4, 1}}) {
        std::vector<float> box;
        for (int i = 0; i < 36; ++i) {
          const int c = static_cast<int>(k.u[i] * columns), r = static_cast<int>(static_cast<double>(k.v[i]) * rows);
          box.push_back((c * rows + r + 0.5f) / (columns * rows));
        }
        EXPECT_TRUE(equally_many(box, columns * rows)) << columns << " x " << rows << ", dimension " << dimension;
      }
      EXPECT_TRUE(equally_many(Keys(64, pixel, 7).draw(*s64.plugin, dimension).u, 64));
      EXPECT_TRUE(equally_many(Keys(81, pixel, 9).draw(*s81.plugin, dimension).v, 81));
      Keys one(64, pixel, 2);
      s64->get_1d(one.keys(), dimension, one.u.data());
      EXPECT_TRUE(equally_many(one.u, 64));
    }
  }
}

/// Variance over pixels of the mean of f over the samples of a pixel.
double variance(const Sampler& s, int samples, int dimension, const std::function<double(double, double)>& f) {
  constexpr int kPixels = 2000;
  double sum = 0, sum2 = 0;
  for (int pixel = 0; pixel < kPixels; ++pixel) {
    Keys k(samples, pixel % 50, pixel / 50);
    k.draw(s, dimension);
    double mean = 0;
    for (int i = 0; i < samples; ++i) mean += f(static_cast<double>(k.u[i]), static_cast<double>(k.v[i])) / samples;
    sum += mean, sum2 += mean * mean;
  }
  return sum2 / kPixels - (sum / kPixels) * (sum / kPixels);
}

double disk(double x, double y) { return std::hypot(x - 0.4, y - 0.55) < 0.35 ? 1 : 0; }
double gaussian(double x, double y) { return std::exp(-4 * ((x - 0.3) * (x - 0.3) + (y - 0.6) * (y - 0.6))); }

TEST(Halton, IntegratesBetterThanRandomInEveryDimension) {
  for (const auto& [samples, disk_gain, gaussian_gain] : {std::tuple{16, 2.5, 8.0}, {64, 5.0, 30.0}}) {
    const auto halton = make_sampler("halton", samples), random = make_sampler("random", samples);
    const double random_disk = variance(*random.plugin, samples, 0, disk);
    const double random_gaussian = variance(*random.plugin, samples, 0, gaussian);
    for (const int dimension : {0, 2, 7, 40, 600}) {
      const double d = random_disk / variance(*halton.plugin, samples, dimension, disk);
      const double g = random_gaussian / variance(*halton.plugin, samples, dimension, gaussian);
      RecordProperty(std::to_string(samples) + "_samples_dimension_" + std::to_string(dimension),
                     "disk " + std::to_string(d) + ", gaussian " + std::to_string(g));
      EXPECT_GT(d, disk_gain) << samples << " samples, dimension " << dimension;
      EXPECT_GT(g, gaussian_gain) << samples << " samples, dimension " << dimension;
    }
  }
}

TEST(Halton, DimensionsCombineAtRandom) {
  // The correlation of the sample numbers' ranks in two dimensions, averaged over many pixels, is 0: the mean of
  // (u_a - 1/2)(u_b - 1/2) over 16 x 4000 samples has standard deviation 1/12/sqrt(64000) = 3.3e-4. The same for the
  // signs of both, which would betray that halves always meet halves; and 4D boxes are not empty systematically.
  for (const int samples : {16, 13}) {
    const auto s = make_sampler("halton", samples);
    double product = 0, square = 0;
    for (int pixel = 0; pixel < 4000; ++pixel) {
      Keys a(samples, pixel % 64, pixel / 64), b = a;
      a.draw(*s.plugin, 0), b.draw(*s.plugin, 2);
      double signs = 0;
      for (int i = 0; i < samples; ++i) {
        const double x = static_cast<double>(a.u[i]) - 0.5, y = static_cast<double>(b.u[i]) - 0.5;
        product += x * y, signs += (x < 0) == (y < 0) ? 1 : -1;
      }
      square += signs * signs / samples;
    }
    const double n = 4000.0 * samples;
    EXPECT_LT(std::abs(product / n), 5 / 12.0 / std::sqrt(n));
    // For a random permutation the squared sum of signs over the count is about 1 (16/15 for 16); locked halves give 16.
    EXPECT_NEAR(square / 4000, 1.0, 0.2) << samples;
  }
}

TEST(Halton, SamplePixelCenter) {
  const auto s = make_sampler("halton", 4, {boolean("samplepixelcenter", true)});
  Keys k(4, 10, 20);
  s->pixel_offset(k.keys(), k.u.data(), k.v.data());
  EXPECT_EQ(k.u, std::vector<float>(4, 0.5f));
  EXPECT_EQ(k.v, std::vector<float>(4, 0.5f));
  EXPECT_NE(k.draw(*s.plugin, 2).u, std::vector<float>(4, 0.5f));  // only the film position
}

TEST(Halton, EverySampleNumberIsUsedOnce) {
  // Counts next to powers of two are where the shuffling has to walk furthest.
  for (const int samples : {1, 2, 3, 5, 17, 33, 1000, 1025}) {
    const auto s = make_sampler("halton", samples);
    Keys k(samples, 4, 5);
    k.draw(*s.plugin, 6);
    const std::set<float> distinct(k.u.begin(), k.u.end());
    EXPECT_EQ(distinct.size(), static_cast<size_t>(samples));
  }
}

}  // namespace
}  // namespace whit
