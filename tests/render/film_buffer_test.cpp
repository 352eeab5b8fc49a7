// The film while rendering: where a sample goes, and that a constant picture stays what it is under every filter.
#include "core/render/film_buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/batch/zero_pages.h"
#include "tests/plugins/make_plugin.h"

namespace whit {
namespace {

test::Made<Filter> make_filter(const char* name, double radius) {
  return test::make_plugin<Filter>("filter", name,
                                   {test::floats("xwidth", {radius}), test::floats("ywidth", {radius})});
}

/// The pixels (x, y, weight) that a sample reached, of the tile (0, 0) and its border.
struct Reached {
  int x, y;
  float weight;
};
std::vector<Reached> reached(const FilterTable& filter, float film_x, float film_y) {
  TileSums sums({0, 0}, filter);
  sums.add(film_x, film_y, RGB(1.0f));
  std::vector<Reached> out;
  for (int y = -8; y < TileSums::kTile + 8; ++y) {
    for (int x = -8; x < TileSums::kTile + 8; ++x) {
      const auto s = sums.at(x, y);
      if (s && (*s)[3] != 0) out.push_back({x, y, static_cast<float>((*s)[3])});
    }
  }
  return out;
}

TEST(FilterTable, HoldsTheFilterAtTheMiddleOfItsCells) {
  const auto gaussian = make_filter("gaussian", 2);
  ASSERT_TRUE(gaussian.good());
  const FilterTable table(*gaussian.plugin);
  // 64 cells over a radius of 2: cell 10 holds what the filter is at 10.5 / 32, and the table is even in x and y.
  const float expected = gaussian->evaluate(10.5f / 32, 3.5f / 32);
  for (const float sx : {1.0f, -1.0f}) {
    for (const float sy : {1.0f, -1.0f}) EXPECT_EQ(table.weight(sx * 10.2f / 32, sy * 3.9f / 32), expected);
  }
  EXPECT_GT(expected, table.weight(1, 1));
  EXPECT_EQ(table.weight(2, 0), gaussian->evaluate(63.5f / 32, 0.5f / 32));  // the rim belongs to the last cell
}

TEST(FilterTable, ReachInWholePixels) {
  // A sample anywhere in its pixel lies up to 0.5 from the centre: radius 0.5 reaches no other, 0.6 and 1.5 one, 2 two.
  const std::pair<double, int> cases[] = {{0.25, 0}, {0.5, 0}, {0.6, 1}, {1.5, 1}, {2, 2}, {4, 4}};
  for (const auto& [radius, reach] : cases) {
    const auto filter = make_filter("box", radius);
    EXPECT_EQ(FilterTable(*filter.plugin).x_reach(), reach) << radius;
    EXPECT_EQ(FilterTable(*filter.plugin).y_reach(), reach) << radius;
  }
}

TEST(TileSums, ABoxGivesEachSampleToExactlyOnePixel) {
  const auto box = make_filter("box", 0.5);
  const FilterTable table(*box.plugin);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> position(0, TileSums::kTile);
  for (int i = 0; i < 2000; ++i) {
    // Random places, edges and corners of pixels, and the last float before them.
    float x = position(random), y = position(random);
    if (i % 3 == 1) x = std::floor(x);
    if (i % 3 == 2) x = std::nextafter(std::floor(x) + 1, 0.0f), y = std::floor(y);
    const auto pixels = reached(table, x, y);
    ASSERT_EQ(pixels.size(), 1u) << x << ", " << y;
    EXPECT_EQ(pixels[0].weight, 1);
    EXPECT_NEAR(static_cast<float>(pixels[0].x) + 0.5f, x, 0.5f);
    EXPECT_NEAR(static_cast<float>(pixels[0].y) + 0.5f, y, 0.5f);
  }
}

TEST(TileSums, ABatchIsItsSamplesInTheirOrder) {
  // Additions in the same order give the same bits. 700 samples, several to a pixel, some outside the tile, and every
  // tenth, which is not a number, left out.
  std::mt19937 random(7);
  std::uniform_real_distribution<float> position(-3, TileSums::kTile + 3), value(0, 2);
  constexpr int kCount = 700;
  std::vector<float> x(kCount), y(kCount), r(kCount), g(kCount), b(kCount);
  std::vector<uint8_t> usable(kCount);
  for (size_t i = 0; i < kCount; ++i) {
    const bool again = i % 3 != 0;
    x[i] = again ? x[i - 1] : position(random), y[i] = again ? y[i - 1] : position(random);
    r[i] = value(random), g[i] = value(random), b[i] = value(random);
    usable[i] = i % 10 != 0;
    if (!usable[i]) r[i] = NAN;
  }
  for (const auto& [name, radius] : {std::pair{"box", 0.5}, {"gaussian", 2.0}}) {
    const auto filter = make_filter(name, radius);
    const FilterTable table(*filter.plugin);
    TileSums together({0, 0}, table), one_by_one({0, 0}, table);
    together.add(kCount, x.data(), y.data(), {r.data(), g.data(), b.data()}, usable.data());
    for (size_t i = 0; i < kCount; ++i) {
      if (usable[i]) one_by_one.add(x[i], y[i], {r[i], g[i], b[i]});
    }
    for (int py = 0; py < TileSums::kTile; ++py) {
      for (int px = 0; px < TileSums::kTile; ++px) {
        ASSERT_EQ(together.at(px, py), one_by_one.at(px, py)) << name << px << py;
      }
    }
  }
}

TEST(TileSums, NoOrderOfAdditionsIsSeen) {
  // 3000 numbers from 1e-12 to 1e12 with weights of a gaussian: added as they come in double precision, the sums of two
  // orders would differ by some 1e-13 of themselves. With what rounding lost, sum and rest have 53 + 24 bits, so that two
  // orders give the same double but where it lies within 1e-7 of a tie: none of these 256 pixels' sums does.
  std::mt19937 random(11);
  std::uniform_real_distribution<float> position(4, 9), exponent(-12, 12);
  constexpr int kCount = 3000;
  struct Sample {
    float x, y;
    RGB value;
  };
  std::vector<Sample> samples;
  for (int i = 0; i < kCount; ++i) {
    const auto value = [&] { return std::pow(10.0f, exponent(random)); };
    samples.push_back({position(random), position(random), RGB(value(), value(), value())});
  }
  for (const auto& [name, radius] : {std::pair{"box", 0.5}, {"gaussian", 2.0}}) {
    const auto filter = make_filter(name, radius);
    const FilterTable table(*filter.plugin);
    TileSums forwards({0, 0}, table), backwards({0, 0}, table);
    for (const Sample& s : samples) forwards.add(s.x, s.y, s.value);
    for (auto s = samples.rbegin(); s != samples.rend(); ++s) backwards.add(s->x, s->y, s->value);
    for (int y = 0; y < TileSums::kTile; ++y) {
      for (int x = 0; x < TileSums::kTile; ++x) EXPECT_EQ(forwards.at(x, y), backwards.at(x, y)) << name << x << y;
    }
  }
}

TEST(TileSums, AFilterReachesBothSidesAlike) {
  // From (5.5, 7.25): x centres within 2 of it are 3.5 .. 7.5, both ends exactly 2 away: five; y centres 5.5 .. 8.5: four.
  const auto box = make_filter("box", 2);
  const auto pixels = reached(FilterTable(*box.plugin), 5.5f, 7.25f);
  ASSERT_EQ(pixels.size(), 20u);
  EXPECT_EQ(pixels.front().x, 3);
  EXPECT_EQ(pixels.front().y, 5);
  EXPECT_EQ(pixels.back().x, 7);
  EXPECT_EQ(pixels.back().y, 8);
}

TEST(TileSums, ItIsTheSameInMemoryThatItIsGiven) {
  const auto filter = make_filter("gaussian", 2);
  const FilterTable table(*filter.plugin);
  // A tile of 8 x 8 and two pixels around it, of four numbers each: 4 (8 + 2 2)^2.
  constexpr int kSize = 8;
  ASSERT_EQ(TileSums::numbers(table, kSize, false), 576u);
  ASSERT_EQ(TileSums::numbers(table, kSize, true), 4 * 576u);
  constexpr size_t kTiles = 3;
  const ZeroPages<double> memory(kTiles * 576);
  const ZeroPages<float> rests(kTiles * 576);
  EXPECT_EQ(memory.size(), kTiles * 576);
  EXPECT_TRUE(std::all_of(memory.data(), memory.data() + memory.size(), [](double v) { return v == 0; }));
  std::vector<TileSums> given;
  for (size_t i = 0; i < kTiles; ++i)
    given.emplace_back(Vec2i(static_cast<int>(i), 0), table, kSize, false,
                       TileMemory{memory.data() + 576 * i, rests.data() + 576 * i});
  for (size_t i = 0; i < kTiles; ++i) {
    TileSums own(Vec2i(static_cast<int>(i), 0), table, kSize);
    for (TileSums* sums : {&own, &given[i]}) sums->add(8.0f * static_cast<float>(i) + 3.3f, 4.6f, RGB(1, 2, 3));
    const int left = kSize * static_cast<int>(i) - 2;
    for (int y = -2; y < kSize + 2; ++y) {
      for (int x = left; x < left + kSize + 4; ++x) { EXPECT_EQ(own.at(x, y), given[i].at(x, y)) << x << ' ' << y; }
    }
  }
}

TEST(TileSums, NothingOutsideItsReach) {
  const auto filter = make_filter("box", 1.5);  // reaches one pixel beyond the tile of 16 x 16
  const FilterTable table(*filter.plugin);
  const TileSums sums({2, -1}, table);
  EXPECT_TRUE(sums.at(31, -17));
  EXPECT_FALSE(sums.at(30, -17));
  EXPECT_FALSE(sums.at(31, -18));
  EXPECT_TRUE(sums.at(48, 0));
  EXPECT_FALSE(sums.at(49, 0));
  EXPECT_FALSE(sums.at(48, 1));
}

/// A picture of 40 x 24 pixels from samples of one colour everywhere, 4 a pixel at random places.
Picture constant_picture(const char* filter_name, double radius, const RGB& colour, float scale) {
  const auto filter = make_filter(filter_name, radius);
  const FilterTable table(*filter.plugin);
  Picture picture;
  picture.resolution = {40, 24};
  picture.window = {{0, 0}, {40, 24}};
  std::vector<TileSums> tiles;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> jitter(0, 1);
  for (int ty = -1; ty < 3; ++ty) {
    for (int tx = -1; tx < 4; ++tx) {
      TileSums& tile = tiles.emplace_back(Vec2i(tx, ty), table);
      for (int y = ty * TileSums::kTile; y < (ty + 1) * TileSums::kTile; ++y) {
        for (int x = tx * TileSums::kTile; x < (tx + 1) * TileSums::kTile; ++x) {
          for (int s = 0; s < 4; ++s) {
            tile.add(static_cast<float>(x) + jitter(random), static_cast<float>(y) + jitter(random), colour);
          }
        }
      }
    }
  }
  const TileGrid grid{{-1, -1}, 5, 4};
  resolve_film({grid, table, tiles, {}, -1}, scale, picture);
  return picture;
}

TEST(ResolveFilm, NoScaleMakesAPixelInfinite) {
  for (const float value : constant_picture("box", 0.5, {1e5f, 0, 1e-5f}, 1e35f).rgb) EXPECT_TRUE(std::isfinite(value));
  EXPECT_EQ(constant_picture("box", 0.5, RGB(1e5f), 1e35f).rgb[0], std::numeric_limits<float>::max());
}

TEST(ResolveFilm, AConstantPictureStaysConstantUnderEveryFilter) {
  const std::pair<const char*, double> filters[] = {{"box", 0.5},    {"box", 2},      {"triangle", 2},
                                                    {"gaussian", 2}, {"mitchell", 2}, {"sinc", 4}};
  for (const auto& [name, radius] : filters) {
    const Picture picture = constant_picture(name, radius, {0.25f, 1, 3}, 2);
    ASSERT_EQ(picture.rgb.size(), 3u * 40 * 24);
    // Up to 256 terms with weights of both signs: their sums are off by some 256 / 2^24 of the sum of the weights'
    // magnitudes, which for sinc is a few times the sum of the weights.
    for (size_t i = 0; i < picture.rgb.size(); i += 3) {
      EXPECT_NEAR(picture.rgb[i], 0.5f, 0.5e-4f) << name;
      EXPECT_NEAR(picture.rgb[i + 1], 2, 2e-4f) << name;
      EXPECT_NEAR(picture.rgb[i + 2], 6, 6e-4f) << name;
    }
  }
}

TEST(ResolveFilm, APixelWithoutSamplesIsBlackAndNegativeResultsToo) {
  const auto box = make_filter("box", 0.5);
  const FilterTable table(*box.plugin);
  std::vector<TileSums> tiles;
  tiles.emplace_back(Vec2i(0, 0), table);
  tiles[0].add(0.5f, 0.5f, {1, 2, 4});
  tiles[0].add(0.25f, 0.75f, {3, 2, -8});
  Picture picture;
  picture.resolution = {2, 1};
  picture.window = {{0, 0}, {2, 1}};
  const TileGrid grid{{0, 0}, 1, 1};
  resolve_film({grid, table, tiles, {}, -1}, 1, picture);
  EXPECT_EQ(picture.rgb, (std::vector<float>{2, 2, 0, 0, 0, 0}));
}

TEST(ResolveFilm, ASampleNearATilesEdgeReachesBothSides) {
  // A sample at (15.9, 8.5), in tile 0, reaches pixels 15 and 16 with a triangle of radius 1: weights 1 - |p + 0.5 - x|,
  // 0.6 and 0.4, up to the table's cells of 1/64. Alone there, it gives both pixels its colour.
  const auto triangle = make_filter("triangle", 1);
  const FilterTable table(*triangle.plugin);
  std::vector<TileSums> tiles;
  tiles.emplace_back(Vec2i(0, 0), table);
  tiles.emplace_back(Vec2i(1, 0), table);
  tiles[0].add(15.9f, 8.5f, {1, 1, 1});
  EXPECT_NEAR((*tiles[0].at(16, 8))[3] / (*tiles[0].at(15, 8))[3], 0.4 / 0.6, 0.05);
  // Another one in pixel 16, in tile 1, black, weight 1 - |16.5 - 16.6| there: the mean is 0.4 / (0.4 + 0.9).
  tiles[1].add(16.6f, 8.5f, {0, 0, 0});
  Picture picture;
  picture.resolution = {32, 16};
  picture.window = {{15, 8}, {17, 9}};
  const TileGrid grid{{0, 0}, 2, 1};
  resolve_film({grid, table, tiles, {}, -1}, 1, picture);
  ASSERT_EQ(picture.rgb.size(), 6u);
  EXPECT_EQ(picture.rgb[0], 1);
  EXPECT_NEAR(picture.rgb[3], 0.4 / 1.3, 0.01);
}

}  // namespace
}  // namespace whit
