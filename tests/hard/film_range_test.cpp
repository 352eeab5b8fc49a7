// Case 17: very dark and very bright radiance, a million samples in a pixel, and what a half cannot hold.
#include <fmt/core.h>

#include <random>

#include "core/image/image.h"
#include "core/image/write.h"
#include "tests/base/temp_folder.h"
#include "tests/hard/hard_case.h"
#include "tests/hard/render_text.h"
#include "tests/plugins/make_plugin.h"

namespace whit {
namespace {

using namespace test;

/// The sum of `n` samples at the middle of a pixel under a filter, over their weights, relative to the same in long
/// double; the value of sample i is value(i).
template <class Value>
double error_of_mean(const FilterTable& filter, int n, const Value& value) {
  constexpr int kBatch = 1000;
  TileSums sums({0, 0}, filter);
  std::vector<float> at(kBatch, 8.5f), r(kBatch);
  const std::vector<uint8_t> usable(kBatch, 1);
  long double exact = 0;
  for (int i = 0; i < n; i += kBatch) {
    for (int k = 0; k < kBatch; ++k) r[k] = value(i + k), exact += static_cast<long double>(r[k]);
    sums.add(kBatch, at.data(), at.data(), {r.data(), r.data(), r.data()}, usable.data());
  }
  const long double mean =
      static_cast<long double>((*sums.at(8, 8))[0]) / static_cast<long double>((*sums.at(8, 8))[3]);
  return std::abs(static_cast<double>(mean / (exact / n) - 1));
}

TEST(Hard, SumsOfAMillionSamples) {
  // In float each addition of the same number may round the same way: a sum of 1e6 times 0.1 is off by 1 %.
  HardCase worst({17, "the mean of a million samples of a pixel",
                  "constant 1e-30 to 1e30, random, one in a thousand bright", "relative error against long double",
                  1e-5, ""});
  std::mt19937 random(3);
  std::uniform_real_distribution<float> u(0, 1);
  for (const char* name : {"box", "gaussian", "mitchell"}) {
    const auto plugin = make_plugin<Filter>("filter", name);
    const FilterTable filter(*plugin.plugin);
    for (const float v : {1e-30f, 1e-3f, 0.1f, 1.0f / 3, 0.7f, 1.0f, 123.456f, 1e30f}) {
      worst.see(error_of_mean(filter, 1000000, [v](int) { return v; }), fmt::format("{} {}", name, v));
    }
    worst.see(error_of_mean(filter, 1000000, [&](int) { return u(random); }), std::string(name) + " random");
    worst.see(error_of_mean(filter, 1000000, [](int i) { return i % 1000 == 0 ? 1e4f : 0.1f; }),
              std::string(name) + " bright");
  }
}

TEST(Hard, PixelsOfAMillionSamples) {
  HardCase worst({17, "a pixel that sees constant radiance, by a million samples", "radiance 0.1, 0.3, 1e-30 and 1e30",
                  "relative error of the pixel", 1e-5, ""});
  for (const double radiance : {0.1, 0.3, 1e-30, 1e30}) {
    const Rendered picture(
        fmt::format("Film \"image\" \"integer xresolution\" 1 \"integer yresolution\" 1\n"
                    "Sampler \"halton\" \"integer pixelsamples\" 1000000\nCamera \"perspective\"\nWorldBegin\n"
                    "LightSource \"infinite\" \"rgb L\" [{0} {0} {0}]\nTranslate 0 0 -9 Shape \"disk\"\nWorldEnd\n",
                    radiance));
    for (const float v : picture.rgb()) {
      worst.see(std::abs(static_cast<double>(v) / radiance - 1), fmt::format("radiance {}", radiance));
    }
  }
}

TEST(Hard, DarkAndBrightInOnePicture) {
  // Columns of emitters ahead of the camera, which the upper pixels see, and behind it, which the lower ones see in a
  // mirror; their radiance goes from 1e-30 to 1e30 in steps of 1e10. There is no other light.
  HardCase worst({17, "radiance of 1e-30 to 1e30 in one picture",
                  "emitters side by side, seen directly and in a mirror", "relative error of a pixel", 1e-5, ""});
  std::string world =
      "Material \"mirror\" \"rgb Kr\" [.5 .5 .5] Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
      "\"point P\" [-4 -4 1  4 -4 1  4 0 1  -4 0 1] Material \"matte\" \"rgb Kd\" [0 0 0]\n";
  for (int k = 0; k < 7; ++k) {
    world += fmt::format("AreaLightSource \"diffuse\" \"rgb L\" [1e{0} 1e{0} 1e{0}] \"bool twosided\" \"true\"\n",
                         10 * k - 30);
    for (const int z : {-5, 5}) {
      world += fmt::format(
          "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [{0} -4 {2} {1} -4 {2} {1} 4 {2} {0} 4 "
          "{2}]\n",
          k - 3.5, k - 2.5, z);
    }
  }
  const Rendered picture(
      "Film \"image\" \"integer xresolution\" 7 \"integer yresolution\" 2\n"
      "Sampler \"halton\" \"integer pixelsamples\" 64\n"
      "Camera \"orthographic\" \"float screenwindow\" [-3.5 3.5 -1 1]\nWorldBegin\n" +
      world + "WorldEnd\n");
  for (int k = 0; k < 7; ++k) {
    const double radiance = std::pow(10, 10 * k - 30);
    const std::string at = fmt::format("1e{}", 10 * k - 30);
    worst.see(std::abs(static_cast<double>(picture.pixel(k, 0).x) / radiance - 1), at);
    worst.see(std::abs(static_cast<double>(picture.pixel(k, 1).x) / radiance / 0.5 - 1), at + " in the mirror");
  }
}

TEST(Hard, LightsOfAnyStrength) {
  // Light is linear: under lights a times as strong, the picture is a times as bright.
  HardCase worst(
      {17, "a scene under lights of any strength, over that strength", "1e-30 to 1e30", "relMSE", 1e-10, ""});
  const auto picture = [](double strength) {
    const Rendered rendered(fmt::format(
        "Film \"image\" \"integer xresolution\" 32 \"integer yresolution\" 32\nSampler \"halton\" \"integer "
        "pixelsamples\" 4\n"
        "LookAt 0 2 6  0 0.5 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\n"
        "AttributeBegin Translate 2 4 3 LightSource \"point\" \"rgb I\" [{0} {0} {0}] AttributeEnd\n"
        "LightSource \"infinite\" \"rgb L\" [{1} {1} {1}]\n"
        "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [{0} {0} {0}] Translate -2 3 0 Shape \"sphere\" "
        "AttributeEnd\n"
        "Shape \"disk\" \"float radius\" 0.1 Rotate -90 1 0 0 Shape \"disk\" \"float radius\" 9 Rotate 90 1 0 0\n"
        "Translate -1.3 0.5 0 Material \"plastic\" Shape \"sphere\" \"float radius\" 0.5\n"
        "Translate 1.3 0 0 Material \"glass\" Shape \"sphere\" \"float radius\" 0.5\n"
        "Translate 1.3 0 0 Material \"metal\" Shape \"sphere\" \"float radius\" 0.5\nWorldEnd\n",
        20 * strength, 0.1 * strength));
    std::vector<float> rgb;
    for (const float v : rendered.rgb()) rgb.push_back(static_cast<float>(static_cast<double>(v) / strength));
    return rgb;
  };
  const std::vector<float> one = picture(1);
  for (int exponent = -30; exponent <= 30; exponent += 5) {
    worst.see(relative_mse(picture(std::pow(10, exponent)), one), fmt::format("1e{}", exponent));
  }
}

TEST(Hard, BeyondHalf) {
  // A half holds 65504, and 6.1e-5 with all of its 11 bits: what it cannot hold makes the file float, which is said.
  HardCase worst({17, "pictures that a half cannot hold, written and read", "one value of 1e-30 to 1e30, and both ends",
                  "relative error of a value", 0.5 / 1024, ""});
  const std::string path = temp_folder() + "/range.exr";
  for (const float v :
       {1e-30f, 1e-10f, 1e-8f, 1e-6f, 1e-4f, 1.0f, 65504.0f, 65505.0f, 65519.0f, 65520.0f, 1e6f, 1e30f}) {
    for (const bool both : {false, true}) {
      const std::vector<float> rgb{v, v, v, both ? 1e-30f : v, v, v};
      OutputImage image;
      image.width = 2, image.height = 1, image.rgb = rgb;
      const WriteResult written = write_image(path, image);
      ASSERT_TRUE(written.ok()) << written.error;
      const auto read = read_image(path);
      ASSERT_TRUE(read.ok()) << read.error;
      EXPECT_EQ(read.value.format == SampleFormat::Float, !written.warning.empty()) << v;
      // Next to ordinary values, 1e-30 is as good as nothing, and may be.
      const size_t values = both && v > 1e-5f && v < 65504.1f ? 3 : rgb.size();
      for (size_t i = 0; i < values; ++i) {
        worst.see(std::abs(static_cast<double>(read.value.pixels[i]) / static_cast<double>(rgb[i]) - 1),
                  fmt::format("{}", v));
      }
    }
  }
}

}  // namespace
}  // namespace whit
