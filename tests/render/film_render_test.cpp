// A film that grows by passes.

#include "core/render/film_render.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/render/film_world.h"

namespace whit {
namespace {

using test::kGaussian;
using World = test::FilmWorld;
using test::film_world;

TEST(FilmRender, PassesAreOnePicture) {
  for (const char* filter : {"", kGaussian}) {
    for (const char* sampler : {"random", "sobol", "02sequence"}) {
      const World of = film_world(filter, sampler);
      FilmRender once(of.scene(), {}), twice(of.scene(), {}), blocks(of.scene(), {.threads = 1, .blocks = true});
      ASSERT_TRUE(once.extend(256));
      ASSERT_TRUE(twice.extend(64) && twice.extend(256));
      ASSERT_TRUE(blocks.extend(128) && blocks.extend(256));
      EXPECT_EQ(once.picture().rgb, twice.picture().rgb) << filter << sampler;
      EXPECT_EQ(once.picture().rgb, blocks.picture().rgb) << filter << sampler;
    }
  }
}

TEST(FilmRender, FilmsThatGrowInTurnAreThoseThatGrowAlone) {
  const World of = film_world(kGaussian);
  FilmRender alone(of.scene(), {}), a(of.scene(), {}), b(of.scene(), {});
  alone.extend(8);
  FilmRender* const films[] = {&a, &b};
  ASSERT_TRUE(FilmRender::extend_in_turn(films, 8));
  EXPECT_EQ(a.picture().rgb, alone.picture().rgb);
  EXPECT_EQ(b.picture().rgb, alone.picture().rgb);
  EXPECT_GT(a.cpu_seconds(), 0);
}

TEST(FilmRender, UnitsCoverEachPixelOnce) {
  const World of = film_world(kGaussian);
  FilmRender film(of.scene(), {.adaptive = true});
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 40; ++x) {
      int covered = 0;
      for (const FilmRender::Unit& u : film.units())
        covered +=
            u.holds(x, y) && x >= u.pixels.min.x && x < u.pixels.max.x && y >= u.pixels.min.y && y < u.pixels.max.y;
      EXPECT_EQ(covered, 1) << x << ',' << y;
    }
  }
}

TEST(FilmRender, UnitsKnowTheirAreas) {
  const World of = film_world(kGaussian);
  RenderOptions options;
  options.adaptive = true, options.crop_given = true;
  // 13 x 7 pixels of the picture, and as many more around as the filter reaches.
  options.crop[0] = 3 / 40.0, options.crop[1] = 16 / 40.0, options.crop[2] = 5 / 24.0, options.crop[3] = 12 / 24.0;
  int64_t sum = 0;
  FilmRender film(of.scene(), options);
  for (const FilmRender::Unit& u : film.units()) {
    int64_t counted = 0;
    for (int y = u.pixels.min.y; y < u.pixels.max.y; ++y) {
      for (int x = u.pixels.min.x; x < u.pixels.max.x; ++x) counted += u.holds(x, y);
    }
    EXPECT_EQ(u.area(), counted);
    sum += u.area();
  }
  const FilterTable filter(of.scene().filter());
  EXPECT_EQ(sum, (13 + 2 * filter.x_reach()) * (7 + 2 * filter.y_reach()));
  film.extend(4);
  EXPECT_EQ(film.result().samples_per_pixel, 4);
}

TEST(FilmRender, UnitsHaveTheSamplesTheyAreGivenForAnyThreads) {
  const World of = film_world(kGaussian);
  const auto render_with = [&](int threads) {
    FilmRender film(of.scene(), {.threads = threads, .blocks = true, .adaptive = true});
    film.extend(16);
    std::vector<uint32_t> want(film.units().size(), 16);
    for (size_t u = 0; u < want.size(); u += 3) want[u] = 32;
    film.extend(want);
    for (size_t u = 0; u < want.size(); ++u) EXPECT_EQ(film.units()[u].samples, want[u]);
    std::vector<float> all = film.picture().rgb;
    const std::vector<float> variance = film.variance();
    all.insert(all.end(), variance.begin(), variance.end());
    return all;
  };
  EXPECT_EQ(render_with(1), render_with(3));
}

/// The sky is 2 in green and nothing else is there, so that the value of a pixel says how its weights add up; and on an
/// even slope a symmetric filter gives the middle's value, unless the denser side pulls it.
TEST(TileSums, ADenserUnitPullsNoFilter) {
  const World of = film_world(kGaussian);
  const FilterTable filter(of.scene().filter());
  const TileGrid grid{{0, 0}, 2, 1, 16, 1};
  std::vector<TileSums> sums;
  sums.emplace_back(Vec2i(0, 0), filter), sums.emplace_back(Vec2i(1, 0), filter);
  const int sides[2] = {4, 16};  // samples on a grid of so many by so many in each pixel
  for (int t = 0; t < 2; ++t) {
    const int n = sides[t] * 16;
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const float x = 16 * t + (i + 0.5f) / sides[t], y = (j + 0.5f) / sides[t];
        sums[t].add(x, y, RGB(x));
      }
    }
  }
  const std::vector<double> weights{1.0 / 16, 1.0 / 256};
  Picture picture;
  picture.window = {{15, 8}, {17, 9}};
  resolve_film({grid, filter, sums, weights, -1}, 1, picture);
  // The middles of pixels 15 and 16; the filter's table has steps of 1/32, and the grids of samples of 1/4 and 1/16.
  EXPECT_NEAR(picture.rgb[0], 15.5, 0.01);
  EXPECT_NEAR(picture.rgb[3], 16.5, 0.01);
  resolve_film({grid, filter, sums, {}, -1}, 1, picture);
  EXPECT_GT(picture.rgb[0], 15.6);
}

TEST(TileSums, VarianceIsThatOfTheMeanOfFourBlocks) {
  const World of = film_world("");
  const FilterTable filter(of.scene().filter());
  const TileGrid grid{{0, 0}, 1, 1};
  std::vector<TileSums> sums;
  sums.emplace_back(Vec2i(0, 0), filter, 16, true);
  const auto variance = [&] { return block_variance({grid, filter, sums, {}, -1}, {3, 3}); };
  EXPECT_TRUE(std::isinf(variance().x));
  for (int k = 0; k < 2; ++k) sums[0].add(3.5f, 3.5f, RGB(1), 0);
  EXPECT_TRUE(std::isinf(variance().x));
  for (int b = 1; b < 4; ++b) {
    for (int k = 0; k < 2; ++k) sums[0].add(3.5f, 3.5f, {1.0f + b, 1, 0}, b);
  }
  // Reds 1, 2, 3, 4: their variance is 5/3, that of the mean of four a fourth of it.
  EXPECT_NEAR(variance().x, 5.0 / 12, 1e-6);
  EXPECT_NEAR(variance().y, 0, 1e-12);
  EXPECT_NEAR(variance().z, (0.75 * 0.75 + 3 * 0.25 * 0.25) / 12, 1e-6);  // 1 0 0 0: off by 3/4 and thrice 1/4
  sums[0].halve_blocks();
  // 1.5 and 3.5 of equal weight: ((1)^2 / 2 + (1)^2 / 2) / 1.
  EXPECT_NEAR(variance().x, 1, 1e-6);
  EXPECT_EQ((*sums[0].at(3, 3))[3], 8);
}

}  // namespace
}  // namespace whit
