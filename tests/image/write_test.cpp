// Writing: what is read back is what was given; failures leave nothing behind and say why.
#include "core/image/write.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "core/image/image.h"
#include "tests/base/temp_folder.h"

namespace whit {
namespace {

namespace fs = std::filesystem;

// An empty folder of its own for each test.
class Write : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = test::temp_folder() + "/whit_write_" + testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  size_t files() const {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  std::string folder_;
};

// Values i / 16 as a picture; all exact in half.
struct Picture {
  std::vector<float> rgb;
  OutputImage image;
  Picture(int width, int height, float step = 1.0f / 16) {
    for (int i = 0; i < width * height * 3; ++i) rgb.push_back(step * static_cast<float>(i));
    image.width = width;
    image.height = height;
    image.rgb = rgb;
  }
};

std::string contents(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

TEST_F(Write, exr_is_half_and_reads_back) {
  const Picture p(5, 3);
  const WriteResult w = write_image(path("a.exr"), p.image);
  ASSERT_TRUE(w.ok()) << w.error;
  EXPECT_EQ(w.warning, "");
  const auto r = read_image(path("a.exr"));
  ASSERT_TRUE(r.ok()) << r.error;
  EXPECT_EQ(r.value.format, SampleFormat::Half);
  EXPECT_EQ(r.value.pixels, p.rgb);
  EXPECT_EQ(r.value.channel_names, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(r.value.metadata.at("compression"), "zip");
  EXPECT_EQ(files(), 1u);
}

TEST_F(Write, exr_float_on_request) {
  const Picture p(4, 4, 1.0f / 3);
  ASSERT_TRUE(write_image(path("a.exr"), p.image, {.full_float = true}).ok());
  const auto r = read_image(path("a.exr"));
  EXPECT_EQ(r.value.format, SampleFormat::Float);
  EXPECT_EQ(r.value.pixels, p.rgb);
}

TEST_F(Write, values_beyond_half_make_the_file_float_with_a_warning) {
  Picture p(2, 2);
  p.rgb[4] = 1e6f;
  const WriteResult w = write_image(path("a.exr"), p.image);
  ASSERT_TRUE(w.ok()) << w.error;
  EXPECT_NE(w.warning.find("float"), std::string::npos) << w.warning;
  const auto r = read_image(path("a.exr"));
  EXPECT_EQ(r.value.format, SampleFormat::Float);
  EXPECT_EQ(r.value.pixels, p.rgb);
}

TEST_F(Write, crop_is_a_data_window_in_the_display_window) {
  Picture p(4, 2);
  p.image.x = 10;
  p.image.y = 20;
  p.image.full_width = 100;
  p.image.full_height = 50;
  ASSERT_TRUE(write_image(path("c.exr"), p.image).ok());
  const auto r = read_image(path("c.exr"));
  ASSERT_TRUE(r.ok()) << r.error;
  EXPECT_EQ(r.value.x, 10);
  EXPECT_EQ(r.value.y, 20);
  EXPECT_EQ(r.value.full_x, 0);
  EXPECT_EQ(r.value.full_y, 0);
  EXPECT_EQ(r.value.full_width, 100);
  EXPECT_EQ(r.value.full_height, 50);
  EXPECT_EQ(r.value.pixels, p.rgb);
  // The others hold the crop alone.
  for (const char* name : {"c.png", "c.tga", "c.tif", "c.jpg", "c.pfm"}) {
    ASSERT_TRUE(write_image(path(name), p.image).ok()) << name;
    const auto o = read_image(path(name));
    ASSERT_TRUE(o.ok()) << o.error;
    EXPECT_EQ(o.value.width, 4) << name;
    EXPECT_EQ(o.value.height, 2) << name;
    EXPECT_EQ(o.value.x, 0) << name;
  }
}

TEST_F(Write, layers_keep_name_value_and_precision) {
  Picture p(2, 2);
  const std::vector<float> z{1.0f / 3, 1e8f, 3, 4}, albedo{0.25f, 0.5f, 0.75f, 1};
  p.image.layers = {{"Z", z, true}, {"Albedo.R", albedo, false}};
  const WriteResult w = write_image(path("l.exr"), p.image);
  ASSERT_TRUE(w.ok()) << w.error;
  EXPECT_EQ(w.warning, "");  // 1e8 is in a float layer
  const auto r = read_image(path("l.exr"));
  ASSERT_TRUE(r.ok()) << r.error;
  ASSERT_GE(r.value.channel("Z"), 0);
  ASSERT_GE(r.value.channel("Albedo.R"), 0);
  for (int i = 0; i < 4; ++i) {
    const float* pixel = r.value.pixel(i % 2, i / 2);
    EXPECT_EQ(pixel[r.value.channel("Z")], z[static_cast<size_t>(i)]);
    EXPECT_EQ(pixel[r.value.channel("Albedo.R")], albedo[static_cast<size_t>(i)]);
    for (int c = 0; c < 3; ++c)
      EXPECT_EQ(pixel[r.value.rgb_channels()[static_cast<size_t>(c)]], p.rgb[static_cast<size_t>(3 * i + c)]);
  }
}

TEST_F(Write, metadata_reads_back) {
  Picture p(2, 2);
  p.image.metadata = {{"Software", std::string("whit 0.1.0")},
                      {"whit:samplesPerPixel", 64},
                      {"whit:renderTime", 1.5f},
                      {"whit:command", std::string("whit scene.pbrt --spp 64")}};
  ASSERT_TRUE(write_image(path("m.exr"), p.image).ok());
  const auto r = read_image(path("m.exr"));
  EXPECT_EQ(r.value.metadata.at("Software"), "whit 0.1.0");
  EXPECT_EQ(r.value.metadata.at("whit:samplesPerPixel"), "64");
  EXPECT_EQ(r.value.metadata.at("whit:renderTime"), "1.5");
  EXPECT_EQ(r.value.metadata.at("whit:command"), "whit scene.pbrt --spp 64");
}

TEST_F(Write, the_same_picture_gives_the_same_bytes) {
  const Picture p(33, 70, 1.0f / 7000);  // more rows than are handed over at once
  for (const char* e : {".exr", ".pfm", ".png", ".tga", ".tif", ".jpg"}) {
    ASSERT_TRUE(write_image(path(std::string("a") + e), p.image).ok());
    ASSERT_TRUE(write_image(path(std::string("b") + e), p.image).ok());
    EXPECT_EQ(contents(path(std::string("a") + e)), contents(path(std::string("b") + e))) << e;
    // The time of day would make files differ from one second to the next: "2026:11:22".
    const auto metadata = read_image(path(std::string("a") + e)).value.metadata;
    const auto date = metadata.find("DateTime");
    EXPECT_TRUE(date == metadata.end() || date->second.empty()) << e << date->second;
  }
}

TEST_F(Write, pfm_is_exact_and_goes_bottom_up) {
  const Picture p(3, 70, 1.0f / 3);
  ASSERT_TRUE(write_image(path("a.pfm"), p.image).ok());
  EXPECT_EQ(read_image(path("a.pfm")).value.pixels, p.rgb);
  const std::string bytes = contents(path("a.pfm"));
  EXPECT_EQ(bytes.substr(0, 13), "PF\n3 70\n-1.0\n");
  // The last row of the file is the top one, which starts with 0.
  EXPECT_EQ(bytes.substr(13 + 69 * 36, 4), std::string(4, '\0'));
}

TEST_F(Write, eight_bits_round_half_up_and_clamp) {
  // 255 v + 0.5, cut off: 0.5 -> 128; 0.001 -> 0 (0.755); 0.002 -> 1 (1.01).
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const std::vector<float> values{0.5f, 0.001f, 0.002f, -3, 1.5f, nan, inf, -inf, 1};
  const std::vector<int> expected{128, 0, 1, 0, 255, 0, 255, 0, 255};
  OutputImage image{.width = 3, .height = 1, .rgb = values};
  for (const char* name : {"q.png", "q.tga", "q.tif"}) {
    ASSERT_TRUE(write_image(path(name), image).ok());
    const auto r = read_image(path(name));
    ASSERT_EQ(r.value.pixels.size(), 9u);
    for (size_t i = 0; i < 9; ++i) EXPECT_EQ(std::lround(255 * r.value.pixels[i]), expected[i]) << name << i;
    EXPECT_EQ(r.value.format, SampleFormat::UInt8);
  }
}

TEST_F(Write, sixteen_bits_for_png_and_tiff) {
  const std::vector<float> values{0.25f, 0.5f, 1};  // 65535 v + 0.5: 16384, 32768, 65535
  OutputImage image{.width = 1, .height = 1, .rgb = values};
  for (const char* name : {"w.png", "w.TIFF"}) {
    ASSERT_TRUE(write_image(path(name), image, {.bits = 16}).ok());
    const auto r = read_image(path(name));
    EXPECT_EQ(r.value.format, SampleFormat::UInt16);
    EXPECT_EQ(std::lround(65535 * r.value.pixels[0]), 16384);
    EXPECT_EQ(std::lround(65535 * r.value.pixels[1]), 32768);
    EXPECT_EQ(std::lround(65535 * r.value.pixels[2]), 65535);
  }
}

TEST_F(Write, jpeg_is_close) {
  const std::vector<float> grey(16 * 16 * 3, 0.4f);
  ASSERT_TRUE(write_image(path("j.jpeg"), {.width = 16, .height = 16, .rgb = grey}).ok());
  EXPECT_NEAR(read_image(path("j.jpeg")).value.pixels[100], 0.4f, 0.01f);
}

TEST_F(Write, linear_formats) {
  EXPECT_TRUE(is_linear_format("x/a.EXR"));
  EXPECT_TRUE(is_linear_format("a.pfm"));
  EXPECT_FALSE(is_linear_format("a.png"));
}

TEST_F(Write, errors_name_path_and_reason) {
  const Picture p(2, 2);
  const auto expect = [&](const std::string& where, const std::string& reason) {
    for (const std::string& error : {write_image(where, p.image).error, check_writable(where)}) {
      EXPECT_NE(error.find("\"" + where + "\""), std::string::npos) << error;
      EXPECT_NE(error.find(reason), std::string::npos) << error;
    }
  };
  expect(path("a.xyz"), ".exr .pfm .png .tga");
  expect(path("a"), "no extension");
  expect(path("none/a.exr"), "No such file or directory");
  fs::create_directory(path("dir.png"));
  expect(path("dir.png"), "folder");
  EXPECT_FALSE(write_image(path("x.exr"), {.width = 3, .height = 3, .rgb = p.rgb}).ok());
  EXPECT_FALSE(write_image(path("x.exr"), {}).ok());
  EXPECT_EQ(files(), 1u);
}

TEST_F(Write, permission_is_checked) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_NE(check_writable(path("a.exr")).find("Permission denied"), std::string::npos);
  fs::permissions(folder_, fs::perms::owner_all);
}

TEST_F(Write, check_writable_leaves_everything_as_it_is) {
  EXPECT_EQ(check_writable(path("new.exr")), "");
  EXPECT_EQ(files(), 0u);
  std::ofstream(path("old.exr")) << "precious";
  EXPECT_EQ(check_writable(path("old.exr")), "");
  EXPECT_EQ(contents(path("old.exr")), "precious");
  EXPECT_EQ(files(), 1u);
}

// A limit on the size of files stands in for a full disk: write() fails in the same way, with EFBIG.
TEST_F(Write, a_full_disk_is_an_error_and_keeps_the_old_file) {
  std::vector<float> noise;
  uint32_t state = 1;
  for (int i = 0; i < 200 * 200 * 3; ++i)
    noise.push_back(float((state = state * 1664525u + 1013904223u) >> 8) / 16777216);
  const OutputImage image{.width = 200, .height = 200, .rgb = noise};
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  for (const char* e : {".exr", ".pfm", ".png", ".tga", ".jpg", ".tif"}) {
    const std::string file = path(std::string("full") + e);
    // 8000 bytes fail early; one byte too few fails in the very last write.
    ASSERT_TRUE(write_image(file, image).ok());
    const auto size = fs::file_size(file);
    std::ofstream(file) << "precious";
    for (const rlim_t limit : {rlim_t{8000}, rlim_t{size - 1}}) {
      const rlimit small{limit, before.rlim_max};
      ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
      const WriteResult w = write_image(file, image);
      setrlimit(RLIMIT_FSIZE, &before);
      EXPECT_NE(w.error.find("File too large"), std::string::npos) << e << ": " << w.error;
      EXPECT_NE(w.error.find(file), std::string::npos);
      EXPECT_EQ(contents(file), "precious") << e;
    }
    fs::remove(file);
    EXPECT_EQ(files(), 0u) << e;
  }
  std::signal(SIGXFSZ, old_handler);
}

TEST_F(Write, a_symbolic_link_stays_and_its_target_is_replaced) {
  const Picture p(2, 2);
  fs::create_symlink("target.pfm", path("link.pfm"));
  ASSERT_TRUE(write_image(path("link.pfm"), p.image).ok());
  EXPECT_TRUE(fs::is_symlink(path("link.pfm")));
  EXPECT_EQ(read_image(path("target.pfm")).value.pixels, p.rgb);
}

}  // namespace
}  // namespace whit
