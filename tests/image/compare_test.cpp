// The measures on pictures small enough to work out by hand.
#include "core/image/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace whit {
namespace {

Image picture(int width, int height, float value) {
  Image image;
  image.width = image.full_width = width;
  image.height = image.full_height = height;
  image.channels = 3;
  image.channel_names = {"R", "G", "B"};
  image.pixels.assign(static_cast<size_t>(width) * height * 3, value);
  return image;
}

float& at(Image& image, int x, int y, int c) {
  return image.pixels[(static_cast<size_t>(y) * image.width + x) * image.channels + c];
}

TEST(Compare, equal_pictures) {
  const Image a = picture(16, 16, 0.5f);
  const Comparison c = compare_images(a, a);
  EXPECT_EQ(c.failure, "");
  EXPECT_EQ(c.relmse, 0);
  EXPECT_EQ(c.ratio, 1);
  EXPECT_EQ(c.block, 0);
  EXPECT_FALSE(c.shifted);
  EXPECT_EQ(c.differing_pixels, 0);
  EXPECT_EQ(c.psnr, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(judge(c).empty());
}

TEST(Compare, one_pixel_differs) {
  // ref is 1 everywhere, mean 1. out differs in one channel of one of 256 pixels by 0.5.
  // relMSE: 0.25 / (1 + 0.01) / 768. ratio of red: (256.5 - 0) / 256 - 1 = 0.5 / 256.
  // block: the mean of 192 numbers moves by 0.5 / 192, over 1.1. PSNR: mse = 0.25 / 768, peak 1.
  const Image ref = picture(16, 16, 1);
  Image out = ref;
  at(out, 3, 12, 0) = 1.5f;
  const Comparison c = compare_images(out, ref);
  EXPECT_NEAR(c.relmse, 0.25 / 1.01 / 768, 1e-12);
  EXPECT_NEAR(c.ratio, 1 + 0.5 / 256, 1e-12);
  EXPECT_NEAR(c.block, 0.5 / 192 / 1.1, 1e-12);
  EXPECT_NEAR(c.psnr, 10 * std::log10(768 / 0.25), 1e-9);
  EXPECT_EQ(c.max_difference, 0.5);
  EXPECT_EQ(c.differing_pixels, 1);
  EXPECT_FALSE(c.shifted);
}

TEST(Compare, ratio_leaves_black_channels_out) {
  // Means of ref: 1, 1, 0.01; 5 % of the mean of all is 0.0335, so blue has no say. Green is furthest: 0.8.
  Image ref = picture(8, 8, 1), out = picture(8, 8, 1);
  for (int i = 0; i < 64; ++i) {
    at(ref, i % 8, i / 8, 2) = 0.01f;
    at(out, i % 8, i / 8, 0) = 1.1f;
    at(out, i % 8, i / 8, 1) = 0.8f;
    at(out, i % 8, i / 8, 2) = 0.02f;
  }
  EXPECT_NEAR(compare_images(out, ref).ratio, 0.8, 1e-6);
}

TEST(Compare, black_reference) {
  const Image black = picture(8, 8, 0), grey = picture(8, 8, 0.1f);
  EXPECT_EQ(compare_images(black, black).ratio, 1);
  EXPECT_EQ(compare_images(grey, black).ratio, std::numeric_limits<double>::infinity());
  EXPECT_FALSE(judge(compare_images(grey, black)).empty());
}

TEST(Compare, small_edge_blocks_are_left_out) {
  // 20 wide: blocks of 8, 8 and 4 columns; the last is exactly half a block and counts, 3 columns (19) do not.
  for (const int width : {20, 19}) {
    const Image ref = picture(width, 8, 1);
    Image out = ref;
    for (int y = 0; y < 8; ++y)
      for (int c = 0; c < 3; ++c) at(out, width - 1, y, c) = 3;
    // The last block's mean is 1 + 2 / 4 where it counts: |1.5 - 1| / 1.1.
    EXPECT_NEAR(compare_images(out, ref).block, width == 20 ? 0.5 / 1.1 : 0, 1e-12) << width;
  }
}

TEST(Compare, shift_by_one_pixel_is_found) {
  // A pattern without period 1 or 2, moved right by 1 and down by 1: out(x, y) = ref(x - 1, y - 1).
  Image ref = picture(24, 24, 0), out = ref;
  const auto pattern = [](int x, int y) { return static_cast<float>(((x * 7 + y * 13) * (x + 3 * y + 5)) % 31); };
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 24; ++x)
      for (int c = 0; c < 3; ++c) {
        at(ref, x, y, c) = pattern(x + 1, y + 1);
        at(out, x, y, c) = pattern(x, y);
      }
  const Comparison c = compare_images(out, ref);
  EXPECT_TRUE(c.shifted);
  EXPECT_EQ(c.shift_x, 1);
  EXPECT_EQ(c.shift_y, 1);
  const auto why = judge(c, {1e9, 1e9, 1e9});
  EXPECT_EQ(why, std::vector<std::string>{"shift"});
}

TEST(Compare, failures) {
  const Image ref = picture(8, 8, 1);
  EXPECT_NE(compare_images(picture(8, 7, 1), ref).failure.find("size 8 x 7, expected 8 x 8"), std::string::npos);
  Image moved = ref;
  moved.x = 1;
  EXPECT_NE(compare_images(moved, ref).failure.find("window"), std::string::npos);
  Image bad = ref;
  at(bad, 1, 1, 0) = std::numeric_limits<float>::quiet_NaN();
  at(bad, 1, 1, 1) = std::numeric_limits<float>::infinity();
  at(bad, 2, 1, 2) = std::numeric_limits<float>::infinity();
  const Comparison c = compare_images(bad, ref);
  EXPECT_EQ(c.bad_pixels, 2);
  EXPECT_EQ(judge(c), std::vector<std::string>{"2 pixels with NaN or infinity"});
  EXPECT_NE(compare_images(ref, bad).failure.find("reference"), std::string::npos);
}

TEST(Compare, tiny_pictures_have_no_shift) {
  const Image a = picture(2, 1, 1), b = picture(2, 1, 2);
  const Comparison c = compare_images(b, a);
  EXPECT_EQ(c.failure, "");
  EXPECT_FALSE(c.shifted);
  EXPECT_EQ(c.ratio, 2);
}

TEST(Judge, names_what_is_beyond_its_limit) {
  Comparison c;
  c.relmse = 0.03;
  c.ratio = 0.98;
  c.block = 0.079;
  EXPECT_EQ(judge(c), (std::vector<std::string>{"relMSE", "ratio"}));
  EXPECT_EQ(judge(c, {0.03, 0.021, 0.07}), std::vector<std::string>{"block"});
  c.relmse = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(judge(c, {1, 1, 1}), std::vector<std::string>{"relMSE"});
}

}  // namespace
}  // namespace whit
