// From raw pixels to texture values: decoding, flip, luminance, and the Lanczos enlargement.
#include "core/image/texels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace whit {
namespace {

Image picture(int width, int height, int channels, std::vector<float> pixels) {
  Image image;
  image.width = width;
  image.height = height;
  image.channels = channels;
  image.channel_names.assign(static_cast<size_t>(channels), "x");
  image.pixels = std::move(pixels);
  return image;
}

TEST(Texels, srgb_decode) {
  EXPECT_EQ(srgb_decode(0), 0);
  EXPECT_FLOAT_EQ(srgb_decode(1), 1);
  EXPECT_FLOAT_EQ(srgb_decode(0.04f), 0.04f / 12.92f);
  EXPECT_FLOAT_EQ(srgb_decode(0.5f), 0.21404114f);  // ((0.5 + 0.055) / 1.055)^2.4
}

TEST(Texels, default_gamma_is_for_png_tga_and_what_else_is_srgb) {
  const auto of = [](const char* path, SampleFormat format, std::map<std::string, std::string> metadata = {}) {
    ImageInfo info;
    info.format = format, info.metadata = std::move(metadata);
    return default_gamma(path, info);
  };
  constexpr SampleFormat k8 = SampleFormat::UInt8, k16 = SampleFormat::UInt16;
  const std::map<std::string, std::string> srgb{{"oiio:ColorSpace", "sRGB"}}, linear{{"oiio:ColorSpace", "Linear"}};
  const auto profile = [](const char* name) {
    return std::map<std::string, std::string>{{"oiio:ColorSpace", "sRGB"}, {"ICCProfile:profile_description", name}};
  };
  // pbrt-v3's rule is by the name alone.
  for (const char* name : {"a.png", "b/c.TGA", "x.Png"}) {
    for (const SampleFormat format : {k8, k16}) EXPECT_TRUE(of(name, format)) << name;
    EXPECT_TRUE(of(name, k8, linear)) << name;
  }
  for (const char* name : {"a.jpg", "a.tif", "a.bmp", "png", "a.png.gif"}) {
    EXPECT_TRUE(of(name, k8)) << name;
    EXPECT_FALSE(of(name, k16)) << name;
    EXPECT_TRUE(of(name, k16, srgb)) << name;
    EXPECT_FALSE(of(name, k8, linear)) << name;
    EXPECT_TRUE(of(name, k16, profile("Adobe RGB (1998)"))) << name;
    EXPECT_FALSE(of(name, k8, profile("Linear RGB Profile"))) << name;
  }
  // A PNG whose gAMA says "linear", whatever its name.
  for (const char* name : {"a.png", "a", "a.jpg"})
    for (const SampleFormat format : {k8, k16})
      EXPECT_TRUE(of(name, format, {{"oiio:ColorSpace", "linear"}, {"png:gAMA", "100000"}})) << name;
  for (const char* name : {"a.exr", "a.pfm", "a.png.exr", "a.hdr", "a.tif"}) {
    EXPECT_FALSE(of(name, SampleFormat::Half)) << name;
    EXPECT_FALSE(of(name, SampleFormat::Float)) << name;
  }
}

TEST(Texels, colour_gamma_then_scale_and_flip) {
  const Image image = picture(1, 2, 3, {0.5f, 0, 1, 0.25f, 0.5f, 0.75f});
  const Texels plain = make_texels(image, false, false, 1, false);
  EXPECT_EQ(plain.values, image.pixels);
  const Texels t = make_texels(image, false, true, 2, true);
  ASSERT_EQ(t.channels, 3);
  EXPECT_FLOAT_EQ(t.values[3], 2 * srgb_decode(0.5f));  // the top row is now last
  EXPECT_FLOAT_EQ(t.values[0], 2 * srgb_decode(0.25f));
}

TEST(Texels, float_maps_take_luminance_then_gamma_then_scale) {
  // Y = 0.212671 * 0.5 + 0.715160 * 0.2 + 0.072169 * 1 = 0.3215365, decoded, times 3.
  const Texels t = make_texels(picture(1, 1, 3, {0.5f, 0.2f, 1}), true, true, 3, true);
  ASSERT_EQ(t.channels, 1);
  EXPECT_NEAR(t.values[0], 3 * std::pow((0.3215365 + 0.055) / 1.055, 2.4), 1e-6);
}

TEST(Texels, grey_pictures_stay_grey_and_alpha_is_left_out) {
  const Texels t = make_texels(picture(2, 1, 2, {0.5f, 0.1f, 0.25f, 0.9f}), false, false, 1, true);
  EXPECT_EQ(t.channels, 1);
  EXPECT_EQ(t.values, (std::vector<float>{0.5f, 0.25f}));
}

TEST(Texels, bytes_give_the_bits_that_their_quotients_give) {
  ByteImage bytes;
  bytes.width = 16, bytes.height = 16, bytes.channels = 3, bytes.channel_names = {"R", "G", "B"};
  for (int i = 0; i < 3 * 256; ++i) bytes.pixels.push_back(static_cast<uint8_t>(i * 89));  // every byte in each channel
  for (size_t i = 0; i < 3 * 64; ++i) bytes.pixels[i] = static_cast<uint8_t>(i / 3);       // and some pixels grey
  Image floats;
  static_cast<ImageInfo&>(floats) = bytes;
  for (const uint8_t v : bytes.pixels) floats.pixels.push_back(static_cast<float>(v) / 255);
  for (const bool single : {false, true})
    for (const bool gamma : {false, true}) {
      const TexelRows rows(bytes, single ? TexelRows::Take::Luminance : TexelRows::Take::Rgb, gamma, 3);
      std::vector<float> a(16 * size_t(rows.channels())), b = a;
      for (int y = 0; y < 16; ++y) {
        rows.convert(bytes.pixel(0, y), a.data());
        rows.convert(floats.pixel(0, y), b.data());
        EXPECT_EQ(a, b) << y;
      }
    }
}

TEST(Resample, powers_of_two_are_untouched) {
  const Texels in{2, 1, 1, {-3, 5}};
  EXPECT_EQ(resample_to_power_of_two(in, WrapMode::Repeat).values, in.values);
}

// sinc(2x) sinc(x) of x = distance / 2, the filter of radius 2 with tau 2.
double lanczos(double distance) {
  const double x = std::abs(distance) / 2 * std::numbers::pi;
  if (x < 1e-9) return 1;
  return std::abs(distance) > 2 ? 0 : std::sin(2 * x) / (2 * x) * std::sin(x) / x;
}

TEST(Resample, three_texels_become_four) {
  // New texel i is centred at (i + 0.5) * 3 / 4 = 0.375, 1.125, 1.875, 2.625 of the old ones, whose centres are at
  // 0.5, 1.5, 2.5. The four nearest take part; outside, 9 repeats as v[j mod 3], clamps, or is missing.
  const double v[3] = {1, 4, 9};
  const double centre[4] = {0.375, 1.125, 1.875, 2.625};
  const int first[4] = {-2, -1, 0, 1};  // floor(centre - 1.5)
  for (const WrapMode wrap : {WrapMode::Repeat, WrapMode::Clamp, WrapMode::Black, WrapMode::Mirror}) {
    const Texels out = resample_to_power_of_two({3, 1, 1, {1, 4, 9}}, wrap);
    ASSERT_EQ(out.width, 4);
    ASSERT_EQ(out.height, 1);
    for (int i = 0; i < 4; ++i) {
      double sum = 0, weights = 0;
      for (int j = first[i]; j < first[i] + 4; ++j) {
        const double w = lanczos(j + 0.5 - centre[i]);
        weights += w;
        if (wrap == WrapMode::Repeat) sum += w * v[(j + 3) % 3];
        if (wrap == WrapMode::Clamp) sum += w * v[j < 0 ? 0 : j > 2 ? 2 : j];
        if (wrap == WrapMode::Mirror) sum += w * v[j < 0 ? -1 - j : j > 2 ? 5 - j : j];
        if (wrap == WrapMode::Black && j >= 0 && j < 3) sum += w * v[j];
      }
      EXPECT_NEAR(out.values[static_cast<size_t>(i)], std::max(0.0, sum / weights), 1e-5) << i;
    }
  }
}

TEST(Resample, a_constant_stays_constant_in_both_directions) {
  const Texels out = resample_to_power_of_two({5, 9, 3, std::vector<float>(5 * 9 * 3, 0.7f)}, WrapMode::Repeat);
  EXPECT_EQ(out.width, 8);
  EXPECT_EQ(out.height, 16);
  for (float v : out.values) ASSERT_NEAR(v, 0.7f, 1e-6f);
}

TEST(Resample, only_the_odd_side_changes) {
  // Height 2 stays: the filter is 0 at whole distances, so rows do not mix.
  const Texels out = resample_to_power_of_two({3, 2, 1, {1, 1, 1, 5, 5, 5}}, WrapMode::Repeat);
  ASSERT_EQ(out.width, 4);
  ASSERT_EQ(out.height, 2);
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(out.values[i], 1, 1e-6);
    EXPECT_NEAR(out.values[4 + i], 5, 1e-5);
  }
}

TEST(Resample, pictures_of_all_directions_go_around_along_s_alone) {
  // Columns are enlarged as if they repeated, rows as if they were clamped: of a product of both, the product.
  const float row[3] = {1, 4, 9}, column[3] = {2, 3, 7};
  Texels in{3, 3, 1, {}};
  for (const float t : column) {
    for (const float s : row) in.values.push_back(s * t);
  }
  const Texels out = resample_to_power_of_two(in, WrapMode::LatLong);
  const Texels along_s = resample_to_power_of_two({3, 1, 1, {1, 4, 9}}, WrapMode::Repeat);
  const Texels along_t = resample_to_power_of_two({1, 3, 1, {2, 3, 7}}, WrapMode::Clamp);
  for (size_t i = 0; i < 16; ++i) EXPECT_NEAR(out.values[i], along_s.values[i % 4] * along_t.values[i / 4], 1e-4) << i;
}

TEST(Resample, overshoot_below_zero_is_clamped) {
  const Texels out = resample_to_power_of_two({7, 1, 1, {0, 0, 0, 100, 0, 0, 0}}, WrapMode::Clamp);
  for (float v : out.values) EXPECT_GE(v, 0);
}

}  // namespace
}  // namespace whit
