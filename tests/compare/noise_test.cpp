// Is it only noise: made noise, whose variance is known, and made differences.
#include "core/compare/noise.h"

#include <cmath>
#include <random>

#include "tests/compare/pictures.h"

namespace whit {
namespace {

constexpr int kSize = 64, kBlocks = 4;
constexpr float kNoise = 0.1f;  // Of a pixel.

// A picture of `mean` with Gaussian noise, and, as a film makes it, the variance of each pixel's mean from four blocks.
PicturePlanes noisy(uint32_t seed, const std::function<float(int, int)>& mean, bool with_variance) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0, kNoise * std::sqrt(static_cast<float>(kBlocks)));
  PicturePlanes p = picture(kSize, kSize, {"R", "G", "B", "variance.R", "variance.G", "variance.B"},
                            [](size_t, int, int) { return 0.0f; });
  for (size_t c = 0; c < 3; ++c)
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        float sum = 0, squares = 0;
        for (int b = 0; b < kBlocks; ++b) {
          const float v = noise(random);
          sum += v, squares += v * v;
        }
        const float off = sum / kBlocks;
        at(p, c, x, y) = mean(x, y) + off;
        at(p, c + 3, x, y) = (squares / kBlocks - off * off) / (kBlocks - 1);
      }
  if (!with_variance) {
    p.channels = 3;
    p.channel_names = {"R", "G", "B"};
    p.formats.assign(3, SampleFormat::Float);
    p.planes.erase(p.planes.begin() + 3, p.planes.end());
  }
  return p;
}

float flat(int, int) { return 1; }

TEST(Noise, AloneIsCalledSame) {
  // At alpha 0.001, 100 pairs are called the same but for one in ten runs of this kind; these seeds are fixed.
  for (const bool known : {true, false})
    for (uint32_t seed = 0; seed < 50; ++seed) {
      const NoiseVerdict v = test_noise(pair_of(noisy(2 * seed, flat, known), noisy(2 * seed + 1, flat, known)), 0.001);
      EXPECT_TRUE(v.same) << seed << " p " << v.p;
      EXPECT_EQ(v.estimated, !known);
    }
}

TEST(Noise, EqualPicturesAreTheSame) {
  const PicturePlanes p = noisy(1, flat, true);
  const NoiseVerdict v = test_noise(pair_of(p, p), 0.001);
  EXPECT_TRUE(v.same);
  EXPECT_EQ(v.p, 1);
}

TEST(Noise, FindsWhereAndByHowMuch) {
  // 5 % brighter in 24 x 16 pixels from (16, 32): the noise of the difference's mean there is 0.1 sqrt(2) / sqrt(384) = 0.0072,
  // a seventh of it, and of a block of 16 x 16 inside 0.0088, which is 5.7 deviations: one in a hundred million.
  const auto brighter = [](int x, int y) { return x >= 16 && x < 40 && y >= 32 && y < 48 ? 1.05f : 1.0f; };
  for (const bool known : {true, false}) {
    const NoiseVerdict v = test_noise(pair_of(noisy(5, brighter, known), noisy(6, flat, known)), 0.001);
    ASSERT_FALSE(v.same);
    ASSERT_EQ(v.regions.size(), 1u);
    const NoiseRegion& r = v.regions[0];
    EXPECT_LT(r.p, 0.001);
    EXPECT_GT(r.change, 0.02);
    EXPECT_LT(r.change, 0.1);  // What is found first is what chance made larger.
    // Blocks lie at steps of half their size: the box reaches no further than half of a 16 x 16 beyond.
    EXPECT_GE(r.box.min.x, 8);
    EXPECT_LE(r.box.max.x, 47);
    EXPECT_GE(r.box.min.y, 24);
    EXPECT_LE(r.box.max.y, 55);
  }
}

TEST(Noise, FindsTheWholePicture) {
  // 1.5 % everywhere: 0.015 against 0.1 sqrt(2) / 64 = 0.0022, 6.8 deviations. That is 1e-11, of one test among 5000.
  const auto brighter = [](int, int) { return 1.015f; };
  const NoiseVerdict v = test_noise(pair_of(noisy(7, brighter, true), noisy(8, flat, true)), 0.001);
  ASSERT_FALSE(v.same);
  EXPECT_NEAR(v.regions[0].change, 0.015,
              0.0132);  // Three deviations of a quarter of the picture, which may stand for it.
}

TEST(Noise, AnotherNumberOfSamplesIsNoDifference) {
  // A rare event: one pixel in 100 has a value of 4 where B averages 16 samples of what A has one of. Welch's test by itself is
  // fooled where A has seen none of them and so thinks that it has no noise.
  const auto rare = [](uint32_t seed, int samples) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> u(0, 1);
    PicturePlanes p = picture(kSize, kSize, {"R", "variance.R"}, [](size_t, int, int) { return 0.0f; });
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        double blocks[kBlocks] = {};
        for (int s = 0; s < kBlocks * samples; ++s) blocks[s % kBlocks] += u(random) < 0.0025f ? 4.0 / samples : 0;
        double mean = 0, squares = 0;
        for (const double b : blocks) mean += b / kBlocks, squares += b * b / kBlocks;
        at(p, 0, x, y) = static_cast<float>(mean);
        at(p, 1, x, y) = static_cast<float>((squares - mean * mean) / (kBlocks - 1));
      }
    say_in_header(p, "whit:samplesPerPixel", std::to_string(kBlocks * samples));
    return p;
  };
  int different = 0;
  for (uint32_t seed = 0; seed < 40; ++seed)
    different += !test_noise(pair_of(rare(seed, 1), rare(seed + 1000, 16)), 0.001).same;
  EXPECT_LE(different, 1);
}

TEST(Noise, SharedFiltersAreAllowedFor) {
  // A box filter of 2 x 2 pixels makes neighbours alike: with an area of 4, in the file or found, it is noise all the same.
  const auto blurred = [](uint32_t seed, bool known) {
    PicturePlanes p = noisy(seed, flat, known), out = p;
    for (size_t c = 0; c < p.planes.size(); ++c)
      for (int y = 0; y + 1 < kSize; ++y)
        for (int x = 0; x + 1 < kSize; ++x) {
          const float sum = at(p, c, x, y) + at(p, c, x + 1, y) + at(p, c, x, y + 1) + at(p, c, x + 1, y + 1);
          at(out, c, x, y) = c < 3 ? sum / 4 : sum / 16;
        }
    say_in_header(out, "whit:filterArea", "4");
    return out;
  };
  for (const bool known : {true, false})
    for (uint32_t seed = 100; seed < 130; ++seed)
      EXPECT_TRUE(test_noise(pair_of(blurred(2 * seed, known), blurred(2 * seed + 1, known)), 0.001).same)
          << seed << known;
}

TEST(Noise, FindsWhatMeansDoNotShow) {
  // A chessboard of pixels, inverted: every block has its mean. 0.8 is 5.7 deviations of a pixel's difference, in all of them.
  const auto board = [](bool inverted) {
    return [=](int x, int y) { return (x + y) % 2 == static_cast<int>(inverted) ? 1.4f : 0.6f; };
  };
  EXPECT_FALSE(test_noise(pair_of(noisy(11, board(true), true), noisy(12, board(false), true)), 0.001).same);
  EXPECT_TRUE(test_noise(pair_of(noisy(13, board(true), true), noisy(14, board(true), true)), 0.001).same);
}

TEST(Noise, TooLittleToTestIsNotCalledSame) {
  Limits noise;
  noise.noise = true;
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 1}}) {
    EXPECT_FALSE(test_noise(pair_of(grey(width, height, 0), grey(width, height, 1)), 0.001).same);
    EXPECT_FALSE(compared(grey(width, height, 0), grey(width, height, 1), noise).same());
  }
  // A column of 64, and 3 x 2 pixels, three times as bright: no spread, and no noise.
  for (const auto& [width, height] : {std::pair{1, 64}, {3, 2}})
    EXPECT_FALSE(test_noise(pair_of(grey(width, height, 3), grey(width, height, 1)), 0.001).same) << width;
}

TEST(Noise, PixelsWithoutAVarianceAreTestedByTheirDifference) {
  PicturePlanes a = noisy(21, flat, true), b = noisy(22, flat, true);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < 30; ++x) {
      for (size_t c = 3; c < 6; ++c) at(a, c, x, y) = std::numeric_limits<float>::infinity();
      if (x < 28)
        for (size_t c = 0; c < 3; ++c) at(a, c, x, y) = 0;
    }
  const NoiseVerdict v = test_noise(pair_of(a, b), 0.001);
  EXPECT_FALSE(v.same);
  EXPECT_LT(v.untested, 1e-9);
}

TEST(Noise, FewSamplesThatAgreeByChance) {
  // Dots of half a pixel on black, four samples each: with a chance of 1 in 256 all of A's meet the dot and none of B's, both of
  // which are then sure.
  const auto dots = [](uint32_t seed) {
    std::mt19937 random(seed);
    PicturePlanes p = picture(kSize, kSize, {"R", "variance.R"}, [](size_t, int, int) { return 0.0f; });
    for (int y = 3; y < kSize; y += 8)
      for (int x = 3; x < kSize; x += 8) {
        int hits = 0;
        for (int s = 0; s < kBlocks; ++s) hits += static_cast<int>(random() >> 31);
        const float mean = static_cast<float>(hits) / kBlocks;
        at(p, 0, x, y) = mean;
        at(p, 1, x, y) = mean * (1 - mean) / (kBlocks - 1);
      }
    say_in_header(p, "whit:samplesPerPixel", "4");
    return p;
  };
  // Alone it is most of its block; at alpha 0.001 that must not be enough.
  int different = 0;
  for (uint32_t seed = 0; seed < 60; ++seed)
    different += !test_noise(pair_of(dots(2 * seed), dots(2 * seed + 1)), 0.001).same;
  EXPECT_EQ(different, 0);
}

TEST(Noise, AMirroredPictureIsNone) {
  // Without variances a mirrored picture differs as noise does.
  const auto blobs = [](bool mirrored) {
    return picture(96, 96, {"R", "G", "B"}, [=](size_t, int x, int y) {
      const int from = mirrored ? 95 - x : x;
      return static_cast<float>((from * 7 + y * 13 + from * y / 5) % 17) / 17;
    });
  };
  Limits noise;
  noise.noise = true;
  const Comparison c = compared(blobs(true), blobs(false), noise);
  EXPECT_FALSE(c.same());
}

TEST(Noise, RoundingIsNoDifference) {
  // A half against a float of a picture without any noise.
  PicturePlanes a = picture(32, 32, {"R"}, [](size_t, int x, int) { return 0.1f + 0.01f * static_cast<float>(x); }),
                b = a;
  a.formats[0] = SampleFormat::Half;
  for (float& v : a.planes[0]) v *= 1 + 0x1p-12f;
  EXPECT_TRUE(test_noise(pair_of(a, b), 0.001).same);
  for (float& v : a.planes[0]) v *= 1 + 0x1p-9f;
  EXPECT_FALSE(test_noise(pair_of(a, b), 0.001).same);
}

TEST(Noise, NamesTheObject) {
  // A cryptomatte: the float with the bits 0x3f000000, 0.5, is "ball".
  const auto with_ball = [](uint32_t seed, float ball) {
    const auto in_ball = [](int x, int y) { return x >= 20 && x < 44 && y >= 20 && y < 44; };
    PicturePlanes p = noisy(
        seed, [=](int x, int y) { return in_ball(x, y) ? ball : 1.0f; }, true);
    p.channel_names.emplace_back("CryptoShape00.r");
    p.channel_names.emplace_back("CryptoShape00.g");
    p.formats.resize(8, SampleFormat::Float);
    p.channels = 8;
    for (int k = 0; k < 2; ++k) {
      std::vector<float>& plane = p.planes.emplace_back();
      for (int i = 0; i < kSize * kSize; ++i) plane.push_back(!in_ball(i % kSize, i / kSize) ? 0.0f : k ? 1.0f : 0.5f);
    }
    say_in_header(p, "cryptomatte/1234567/name", "CryptoShape");
    say_in_header(p, "cryptomatte/1234567/manifest", R"({"ball":"3f000000"})");
    return p;
  };
  const NoiseVerdict v = test_noise(pair_of(with_ball(1, 1.06f), with_ball(2, 1)), 0.001);
  ASSERT_FALSE(v.same);
  EXPECT_EQ(v.regions[0].objects, std::vector<std::string>{"ball"});
}

}  // namespace
}  // namespace whit
