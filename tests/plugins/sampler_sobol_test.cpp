// sobol, 02sequence, maxmindist and stratified: stateless, uniform, evenly spread in pixels and (sobol) across them.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "core/plugin/sampler.h"
#include "tests/plugins/make_plugin.h"

namespace whit {
namespace {

using namespace test;

Made<Sampler> make_sampler(const char* name, int samples) {
  Made<Sampler> s = make_plugin<Sampler>("sampler", name);
  EXPECT_TRUE(s.silent());
  EXPECT_EQ(s->set_samples_per_pixel(samples), samples);
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
  /// Dimension -1 is the position within the pixel.
  Keys& draw(const Sampler& s, int dimension) {
    if (dimension < 0) s.pixel_offset(keys(), u.data(), v.data());
    else s.get_2d(keys(), dimension, u.data(), v.data());
    return *this;
  }
  std::vector<int32_t> px, py;
  std::vector<uint32_t> index, stream;
  std::vector<float> u, v;
};

constexpr const char* kAll[] = {"sobol", "02sequence", "maxmindist", "stratified"};
constexpr const char* kNets[] = {"sobol", "02sequence"};

TEST(SobolSamplers, AreStateless) {
  for (const char* name : kAll) {
    for (const int samples : {1, 16, 64}) {
      const auto s = make_sampler(name, samples);
      constexpr int kCount = 301;
      Keys all(kCount, 0, 0);
      for (int i = 0; i < kCount; ++i) {
        all.px[i] = (i * 37) % 19 - 3, all.py[i] = (i * 11) % 7 - 2;
        all.index[i] = static_cast<uint32_t>(i % samples), all.stream[i] = static_cast<uint32_t>(i % 3);
      }
      Keys one = all;
      for (const int dimension : {-1, 5}) {
        all.draw(*s.plugin, dimension);
        for (int i = kCount - 1; i >= 0; --i) {
          if (dimension < 0) s->pixel_offset(one.keys(i, 1), &one.u[i], &one.v[i]);
          else s->get_2d(one.keys(i, 1), dimension, &one.u[i], &one.v[i]);
        }
        EXPECT_EQ(all.u, one.u) << name;
        EXPECT_EQ(all.v, one.v) << name;
      }
      s->get_1d(all.keys(), 9, all.u.data());
      for (int i = kCount - 1; i >= 0; --i) s->get_1d(one.keys(i, 1), 9, &one.u[i]);
      EXPECT_EQ(all.u, one.u) << name;
    }
  }
}

TEST(SobolSamplers, AreUniform) {
  // 4096 pixels x 16 samples in 10 x 10 boxes: chi squared with 99 degrees of freedom is below 160 with p > 0.9999.
  for (const char* name : kAll) {
    const auto s = make_sampler(name, 16);
    for (const int dimension : {-1, 0, 2, 5000}) {
      std::vector<double> boxes(100);
      for (int pixel = 0; pixel < 4096; ++pixel) {
        Keys k(16, pixel % 64, pixel / 64);
        k.draw(*s.plugin, dimension);
        for (int i = 0; i < 16; ++i) {
          ASSERT_TRUE(k.u[i] >= 0 && k.u[i] < 1 && k.v[i] >= 0 && k.v[i] < 1);
          ++boxes[static_cast<size_t>(10 * k.u[i]) * 10 + static_cast<size_t>(10 * k.v[i])];
        }
      }
      double chi2 = 0;
      for (const double b : boxes) chi2 += (b - 655.36) * (b - 655.36) / 655.36;
      EXPECT_LT(chi2, 160) << name << ", dimension " << dimension;
    }
  }
}

TEST(SobolSamplers, KeysMatter) {
  for (const char* name : kAll) {
    const auto s = make_sampler(name, 16);
    std::set<float> first;
    for (const auto& [x, y, branch, dimension] :
         {std::array{0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {-1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 2}}) {
      first.insert(Keys(16, x, y, static_cast<uint32_t>(branch)).draw(*s.plugin, dimension).u[3]);
    }
    first.insert(Keys(16, 0, 0).draw(*s.plugin, -1).u[3]);
    s->seed = 1;
    first.insert(Keys(16, 0, 0).draw(*s.plugin, 0).u[3]);
    first.insert(Keys(16, 0, 0).draw(*s.plugin, -1).u[3]);
    // 02sequence and stratified take the film position from dimension 0.
    EXPECT_GE(first.size(), 7u) << name;
  }
}

TEST(SobolSamplers, CountsAreRounded) {
  for (const char* name : {"sobol", "02sequence", "lowdiscrepancy", "maxmindist"}) {
    const auto s = make_plugin<Sampler>("sampler", name, {integer("pixelsamples", 17)});
    EXPECT_TRUE(s.silent());
    EXPECT_EQ(s->samples_per_pixel(), 32) << name;
    EXPECT_EQ(s->set_samples_per_pixel(0), 1);
    EXPECT_FALSE(make_plugin<Sampler>("sampler", name, {integer("pixelsamples", 0)}).good());
  }
  const auto s = make_plugin<Sampler>("sampler", "stratified", {integer("xsamples", 3), integer("ysamples", 5)});
  EXPECT_EQ(s->samples_per_pixel(), 15);
  EXPECT_EQ(s->set_samples_per_pixel(15), 15);
  EXPECT_EQ(s->set_samples_per_pixel(10), 12);
  EXPECT_EQ(s->set_samples_per_pixel(1), 1);
  EXPECT_FALSE(
      make_plugin<Sampler>("sampler", "stratified", {integer("xsamples", 65536), integer("ysamples", 65536)}).good());
}

/// True when every box of columns x rows holds equally many of the points.
bool equally_many(const std::vector<double>& x, const std::vector<double>& y, int columns, int rows) {
  std::vector<int> count(static_cast<size_t>(columns * rows));
  for (size_t i = 0; i < x.size(); ++i) {
    ++count[static_cast<size_t>(x[i] * columns) * static_cast<size_t>(rows) + static_cast<size_t>(y[i] * rows)];
  }
  return std::set<int>(count.begin(), count.end()).size() == 1;
}

TEST(SobolSamplers, EveryElementaryIntervalHoldsOnePoint) {
  for (const char* name : kNets) {
    const auto s = make_sampler(name, 64);
    for (const int dimension : {-1, 0, 2, 1001}) {
      for (int pixel = 0; pixel < 5; ++pixel) {
        Keys k(64, 100 * pixel - 20, 3 * pixel - 1);
        k.draw(*s.plugin, dimension);
        const std::vector<double> x(k.u.begin(), k.u.end()), y(k.v.begin(), k.v.end());
        for (int columns = 1; columns <= 64; columns *= 2) {
          EXPECT_TRUE(equally_many(x, y, columns, 64 / columns)) << name << ' ' << dimension << ' ' << columns;
        }
        s->get_1d(k.keys(), dimension + 1, k.u.data());
        EXPECT_TRUE(equally_many({k.u.begin(), k.u.end()}, y, 64, 1));
      }
    }
  }
}

TEST(Sobol, FilmPositionsAreANetAcrossPixels) {
  // 8 x 8 pixels with 16 samples each, aligned: boxes from 1 x 1/16 pixels over whole pixels to 8 pixels x 1/128.
  const auto s = make_sampler("sobol", 16);
  std::vector<double> x, y;
  for (int pixel = 0; pixel < 64; ++pixel) {
    Keys k(16, 24 + pixel % 8, -16 + pixel / 8);
    k.draw(*s.plugin, -1);
    for (int i = 0; i < 16; ++i) {
      x.push_back((pixel % 8 + static_cast<double>(k.u[i])) / 8);
      y.push_back((pixel / 8 + static_cast<double>(k.v[i])) / 8);
    }
  }
  for (int columns = 1; columns <= 1024; columns *= 2) {
    EXPECT_TRUE(equally_many(x, y, columns, 1024 / columns)) << columns;
  }
}

TEST(Sobol, ManySamplesStayDistinct) {
  const auto s = make_sampler("sobol", 1 << 17);
  Keys k(1 << 17, 3, 4);
  k.draw(*s.plugin, -1);
  std::set<std::pair<float, float>> distinct;
  for (size_t i = 0; i < k.u.size(); ++i) distinct.insert({k.u[i], k.v[i]});
  EXPECT_GT(distinct.size(), k.u.size() - 100);
}

TEST(MaxMinDist, FilmPositionsKeepTheirDistance) {
  // On the torus; jitter within cells takes up to sqrt(2)/n off. Sobol's own points come as near as that.
  for (const auto& [samples, least] : {std::pair{16, 0.13}, {64, 0.075}, {256, 0.03}}) {
    const auto s = make_sampler("maxmindist", samples);
    double smallest = 1;
    for (int pixel = 0; pixel < 20; ++pixel) {
      Keys k(samples, pixel, 2);
      k.draw(*s.plugin, -1);
      std::vector<double> x(k.u.begin(), k.u.end()), y(k.v.begin(), k.v.end());
      EXPECT_TRUE(equally_many(x, y, samples, 1));
      EXPECT_TRUE(equally_many(x, y, 1, samples));
      for (int i = 0; i < samples; ++i) {
        for (int j = 0; j < i; ++j) {
          const auto torus = [](double d) { return std::min(std::abs(d), 1 - std::abs(d)); };
          smallest = std::min(smallest, std::hypot(torus(x[i] - x[j]), torus(y[i] - y[j])));
        }
      }
    }
    RecordProperty("distance_" + std::to_string(samples), std::to_string(smallest));
    EXPECT_GT(smallest, least) << samples;
  }
}

TEST(Stratified, EveryCellAndEveryStripHoldsOneSample) {
  const auto s = make_plugin<Sampler>("sampler", "stratified", {integer("xsamples", 5), integer("ysamples", 3)});
  for (const int dimension : {-1, 0, 7, 900}) {
    Keys k(15, 3, 4);
    k.draw(*s.plugin, dimension);
    const std::vector<double> x(k.u.begin(), k.u.end()), y(k.v.begin(), k.v.end());
    EXPECT_TRUE(equally_many(x, y, 5, 3));
    EXPECT_TRUE(equally_many(x, y, 15, 1));
    EXPECT_TRUE(equally_many(x, y, 1, 15));
    s->get_1d(k.keys(), 4, k.u.data());
    EXPECT_TRUE(equally_many({k.u.begin(), k.u.end()}, y, 15, 1));
  }
}

TEST(Stratified, WithoutJitterSamplesAreCentred) {
  const auto s = make_plugin<Sampler>("sampler", "stratified",
                                      {integer("xsamples", 2), integer("ysamples", 2), boolean("jitter", false)});
  Keys k(4, 3, 4);
  k.draw(*s.plugin, -1);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(std::abs(k.u[i] - 0.5f), 0.25f, 1e-7);
    EXPECT_NEAR(std::abs(k.v[i] - 0.5f), 0.25f, 1e-7);
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

TEST(SobolSamplers, IntegrateBetterThanRandom) {
  // Independent samples of the disk have variance p (1 - p) / n; of the gaussian 0.0664 / n. The gains asked for are
  // those of plainly jittered cells and more.
  const double p = M_PI * 0.35 * 0.35;
  for (const char* name : kAll) {
    for (const auto& [samples, disk_gain, gaussian_gain] : {std::tuple{16, 2.5, 8.0}, {64, 4.5, 30.0}}) {
      const auto s = make_sampler(name, samples);
      for (const int dimension : {-1, 0, 2, 600}) {
        const double d = p * (1 - p) / samples / variance(*s.plugin, samples, dimension, disk);
        const double g = 0.0664 / samples / variance(*s.plugin, samples, dimension, gaussian);
        RecordProperty(
            std::string(name) + "_" + std::to_string(samples) + "_dimension_" + std::to_string(dimension + 1),
            "disk " + std::to_string(d) + ", gaussian " + std::to_string(g));
        EXPECT_GT(d, disk_gain) << name << ' ' << samples << ' ' << dimension;
        EXPECT_GT(g, gaussian_gain) << name << ' ' << samples << ' ' << dimension;
      }
    }
  }
}

TEST(SobolSamplers, DimensionsCombineAtRandom) {
  // As in sampler_statistics_test.cpp: no correlation, and halves do not always meet halves.
  for (const char* name : kAll) {
    const auto s = make_sampler(name, 16);
    double product = 0, square = 0;
    for (int pixel = 0; pixel < 4000; ++pixel) {
      Keys a(16, pixel % 64, pixel / 64), b = a;
      a.draw(*s.plugin, -1), b.draw(*s.plugin, 2);
      double signs = 0;
      for (int i = 0; i < 16; ++i) {
        const double x = static_cast<double>(a.u[i]) - 0.5, y = static_cast<double>(b.u[i]) - 0.5;
        product += x * y, signs += (x < 0) == (y < 0) ? 1 : -1;
      }
      square += signs * signs / 16;
    }
    EXPECT_LT(std::abs(product / 64000), 5 / 12.0 / std::sqrt(64000.0)) << name;
    EXPECT_NEAR(square / 4000, 1.0, 0.2) << name;
  }
}

}  // namespace
}  // namespace whit
