// Reading: orientation, raw values, alpha left alone, errors that name file and reason.
#include "core/image/image.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cstring>

#include "core/image/oiio/module.h"
#include "core/image/planes.h"
#include "tests/base/temp_folder.h"

namespace whit {
namespace {

using test::temp_path;
using test::write_temp;

std::string floats(const std::vector<float>& values) {
  std::string bytes(values.size() * sizeof(float), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

// A true-colour TGA; `pixels` in file order, BGR or BGRA; `descriptor` holds alpha bits and the origin bit 0x20.
std::string tga(int width, int height, int bits, int descriptor, const std::string& pixels) {
  std::string h(18, '\0');
  h[2] = 2;
  h[12] = static_cast<char>(width);
  h[14] = static_cast<char>(height);
  h[16] = static_cast<char>(bits);
  h[17] = static_cast<char>(descriptor);
  return h + pixels;
}

std::string write_with_oiio(const std::string& name, OIIO::ImageSpec spec, const std::vector<unsigned char>& bytes) {
  auto out = OIIO::ImageOutput::create(temp_path(name));
  EXPECT_TRUE(out && out->open(temp_path(name), spec) && out->write_image(OIIO::TypeDesc::UINT8, bytes.data()) &&
              out->close());
  return temp_path(name);
}

TEST(ReadImage, pfm_rows_come_top_first) {
  // A PFM stores the bottom row first; here that is (1, 2, 3).
  const auto r = read_image(write_temp("o.pfm", "PF\n1 2\n-1.0\n" + floats({1, 2, 3, 40, 50, 60})));
  ASSERT_TRUE(r.ok()) << r.error;
  EXPECT_EQ(r.value.pixels, (std::vector<float>{40, 50, 60, 1, 2, 3}));
  EXPECT_EQ(r.value.format, SampleFormat::Float);
}

TEST(ReadImage, pfm_scale_multiplies_and_grey_has_one_channel) {
  const auto r = read_image(write_temp("g.pfm", "Pf\n2 1\n-2.0\n" + floats({0.25f, 3})));
  ASSERT_TRUE(r.ok()) << r.error;
  EXPECT_EQ(r.value.channels, 1);
  EXPECT_EQ(r.value.pixels, (std::vector<float>{0.5f, 6}));  // as pbrt-v3 does
}

TEST(ReadImage, tga_of_24_bits_bottom_up) {
  // File order: bottom row red (BGR 0,0,255), top row 51 of blue; no origin bit means bottom first.
  const auto r = read_image(write_temp("b.tga", tga(1, 2, 24, 0, std::string("\0\0\xff\x33\0\0", 6))));
  ASSERT_TRUE(r.ok()) << r.error;
  ASSERT_EQ(r.value.channels, 3);
  EXPECT_EQ(r.value.pixels, (std::vector<float>{0, 0, 0.2f, 1, 0, 0}));
  EXPECT_EQ(r.value.format, SampleFormat::UInt8);
}

TEST(ReadImage, tga_of_32_bits_top_down_ignores_alpha) {
  // Top row: BGRA 51, 102, 153 with alpha 0; bottom row 255, 0, 0 with alpha 51. Premultiplied they would be 0 and 0.2.
  const auto r = read_image(write_temp("a.tga", tga(1, 2, 32, 0x28, std::string("\x33\x66\x99\0\xff\0\0\x33", 8))));
  ASSERT_TRUE(r.ok()) << r.error;
  const auto rgb = r.value.rgb_channels();
  EXPECT_FLOAT_EQ(r.value.pixel(0, 0)[rgb[0]], 0.6f);
  EXPECT_FLOAT_EQ(r.value.pixel(0, 0)[rgb[1]], 0.4f);
  EXPECT_FLOAT_EQ(r.value.pixel(0, 0)[rgb[2]], 0.2f);
  EXPECT_FLOAT_EQ(r.value.pixel(0, 1)[rgb[2]], 1.0f);
}

TEST(ReadImage, png_alpha_is_not_multiplied_in) {
  OIIO::ImageSpec spec(2, 1, 4, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  const auto r = read_image(write_with_oiio("alpha.png", spec, {255, 51, 0, 0, 102, 0, 255, 51}));
  ASSERT_TRUE(r.ok()) << r.error;
  EXPECT_EQ(r.value.channels, 4);
  EXPECT_EQ(r.value.pixels, (std::vector<float>{1, 0.2f, 0, 0, 0.4f, 0, 1, 0.2f}));
}

TEST(ReadImage, grey_with_alpha_is_grey) {
  OIIO::ImageSpec spec(1, 1, 2, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.channelnames = {"Y", "A"};
  spec.alpha_channel = 1;
  const auto r = read_image(write_with_oiio("ya.png", spec, {51, 0}));
  ASSERT_TRUE(r.ok()) << r.error;
  EXPECT_EQ(r.value.rgb_channels(), (std::vector<int>{0, 0, 0}));
  EXPECT_FLOAT_EQ(r.value.pixels[0], 0.2f);
}

TEST(ReadImage, colour_channels_are_found_by_name) {
  ImageInfo info;
  info.channels = 5;
  info.channel_names = {"B", "A", "G", "Z", "R"};
  EXPECT_EQ(info.rgb_channels(), (std::vector<int>{4, 2, 0}));
  info.channel_names = {"a", "b", "c", "d", "e"};
  EXPECT_EQ(info.rgb_channels(), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(info.channel("c"), 2);
  EXPECT_EQ(info.channel("C"), -1);
}

TEST(ReadImage, jpeg_tiff_and_hdr_are_read) {
  OIIO::ImageSpec spec(8, 8, 3, OIIO::TypeDesc::UINT8);
  const std::vector<unsigned char> grey(8 * 8 * 3, 102);
  for (const char* name : {"x.jpg", "x.tif", "x.hdr"}) {
    const auto r = read_image(write_with_oiio(name, spec, grey));
    ASSERT_TRUE(r.ok()) << r.error;
    EXPECT_NEAR(r.value.pixel(3, 5)[1], 0.4f, 0.005f) << name;  // raw: 102/255, not decoded
  }
}

TEST(ReadImage, errors_name_the_file_and_the_reason) {
  const auto expect = [](const std::string& path, const std::string& reason) {
    for (const std::string& error : {read_image(path).error, probe_image(path).error}) {
      EXPECT_NE(error.find("\"" + path + "\""), std::string::npos) << error;
      EXPECT_NE(error.find(reason), std::string::npos) << error;
    }
  };
  expect("/nowhere/x.png", "no such file");
  expect(test::temp_folder(), "folder");
  expect(write_temp("empty.png", ""), "empty");
  expect(write_temp("zeros.png", std::string(300, '\0')), "it begins with zeros");
  expect(write_temp("noise.png", std::string(300, 'q')), ": ");
  expect(write_temp("noise.exr", std::string(300, 'q')), ": ");
  // 60000 x 60000 pixels in 18 bytes.
  std::string lying = tga(0, 0, 24, 0, "abc");
  lying[12] = lying[14] = '\x60';
  lying[13] = lying[15] = '\xea';
  expect(write_temp("lying.tga", lying), "claims");
}

// An entry of an OpenEXR header: of `claimed` bytes, though what follows may be shorter.
std::string exr_entry(const std::string& name, const std::string& type, uint32_t claimed, const std::string& value) {
  std::string size(4, '\0');
  for (size_t i = 0; i < 4; ++i) size[i] = static_cast<char>(claimed >> 8 * i);
  return name + '\0' + type + '\0' + size + value;
}

// OpenEXR takes what an entry claims, nearly 2 GB here, before it finds the file at its end.
TEST(ReadImage, entries_of_exr_headers_cannot_be_longer_than_the_file) {
  const std::string magic = "\x76\x2f\x31\x01", one("\x02\0\0\0", 4), many("\x02\x10\0\0", 4), end(1, '\0');
  const std::string good = exr_entry("owner", "string", 3, "abc"),
                    lie = exr_entry("capDate", "string", 0x70000000, "x");
  for (const std::string& bytes : {magic + one + lie, magic + one + good + lie, magic + many + good + end + lie}) {
    const std::string path = write_temp("lying.exr", bytes);
    const std::string claim =
        "claims that \"capDate\" has 1879048192 bytes, but the file has only " + std::to_string(bytes.size());
    for (const std::string& error : {read_image(path).error, probe_image(path).error, read_planes(path).error})
      EXPECT_NE(error.find(claim), std::string::npos) << error;
  }
  // What follows the headers of one part, or of many, is none.
  for (const std::string& bytes : {magic + one + good + end + lie, magic + many + good + end + end + lie}) {
    const std::string error = read_image(write_temp("headless.exr", bytes)).error;
    EXPECT_EQ(error.find("claims"), std::string::npos) << error;
  }
}

TEST(ReadImage, a_truncated_file_is_an_error) {
  const std::string whole = "PF\n64 64\n-1.0\n" + floats(std::vector<float>(64 * 64 * 3, 0.5f));
  EXPECT_FALSE(read_image(write_temp("cut.pfm", whole.substr(0, whole.size() / 2))).ok());
  const std::string targa = tga(64, 64, 24, 0, std::string(64 * 64 * 3 / 2, 'x'));
  EXPECT_FALSE(read_image(write_temp("cut.tga", targa)).ok());
}

TEST(ProbeImage, tells_the_size_without_reading_pixels) {
  // Only the header is there: probing works, reading does not.
  const std::string path = write_temp("head.pfm", "PF\n7 5\n-1.0\n" + floats({0}));
  const auto r = probe_image(path);
  ASSERT_TRUE(r.ok()) << r.error;
  EXPECT_EQ(r.value.width, 7);
  EXPECT_EQ(r.value.height, 5);
  EXPECT_EQ(r.value.channels, 3);
  EXPECT_EQ(r.value.full_width, 7);
}

/// A PNG of the parts given as IHDR's bits and colour type, an optional palette, and the raw rows.
std::string png_file(const std::string& name, uint8_t bits, uint8_t type, const std::string& palette,
                     std::string rows) {
  const auto word = [](uint32_t v) {
    return std::string{static_cast<char>(v >> 24), static_cast<char>(v >> 16), static_cast<char>(v >> 8),
                       static_cast<char>(v)};
  };
  const auto chunk = [&](const std::string& kind, const std::string& data) {
    uint32_t crc = 0xffffffffu;
    for (const char c : kind + data) {
      crc ^= static_cast<uint8_t>(c);
      for (int k = 0; k < 8; ++k) crc = crc & 1 ? 0xedb88320u ^ (crc >> 1) : crc >> 1;
    }
    return word(static_cast<uint32_t>(data.size())) + kind + data + word(~crc);
  };
  // One stored block of deflate: its length and the complement, little endian; Adler-32 behind it.
  uint32_t a = 1, b = 0;
  for (const char c : rows) a = (a + static_cast<uint8_t>(c)) % 65521, b = (b + a) % 65521;
  const auto n = static_cast<uint16_t>(rows.size());
  const std::string length{static_cast<char>(n), static_cast<char>(n >> 8), static_cast<char>(~n),
                           static_cast<char>(~n >> 8)};
  const std::string stored = std::string("\x78\x01\x01", 3) + length + rows + word(b << 16 | a);
  const std::string header = word(2) + word(1) + std::string{static_cast<char>(bits), static_cast<char>(type), 0, 0, 0};
  return write_temp(name, "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) +
                              (palette.empty() ? "" : chunk("PLTE", palette)) + chunk("IDAT", stored) +
                              chunk("IEND", ""));
}

Image read_by_openimageio(const std::string& path) {
  const auto rows = oiio().open(path);
  Image image;
  static_cast<ImageInfo&>(image) = rows->info;
  const size_t row = static_cast<size_t>(image.width) * static_cast<size_t>(image.channels);
  for (int y = 0; y < image.height; ++y) {
    if (image.format == SampleFormat::UInt8) {
      const uint8_t* const bytes = rows->next_bytes();
      for (size_t i = 0; i < row; ++i) image.pixels.push_back(static_cast<float>(bytes[i]) / 255);
    } else {
      const float* const floats = rows->next_floats();
      image.pixels.insert(image.pixels.end(), floats, floats + row);
    }
  }
  return image;
}

TEST(Png, EveryKindIsReadAsOpenImageIOReadsIt) {
  // Two pixels in a row behind the filter's byte 0; numbers of less than 8 bits are packed from the left.
  const auto bytes = [](std::initializer_list<int> list) { return std::string(list.begin(), list.end()); };
  const struct {
    uint8_t bits, type;
    std::string palette, rows;
    std::vector<float> pixels;
  } cases[] = {
      {1, 0, "", bytes({0, 0x40}), {0, 1}},
      {4, 0, "", bytes({0, 0x3f}), {3 / 15.0f, 1}},
      {8, 0, "", bytes({0, 51, 255}), {51 / 255.0f, 1}},
      {16, 0, "", bytes({0, 0x12, 0x34, 0xff, 0xff}), {0x1234 / 65535.0f, 1}},
      {8, 4, "", bytes({0, 51, 0, 255, 102}), {51 / 255.0f, 0, 1, 102 / 255.0f}},
      {16, 4, "", bytes({0, 0x12, 0x34, 0, 0, 0, 1, 0, 2}), {0x1234 / 65535.0f, 0, 1 / 65535.0f, 2 / 65535.0f}},
      {8, 2, "", bytes({0, 0, 51, 102, 153, 204, 255}), {0, 0.2f, 0.4f, 0.6f, 0.8f, 1}},
      {8, 6, "", bytes({0, 0, 51, 102, 0, 153, 204, 255, 51}), {0, 0.2f, 0.4f, 0, 0.6f, 0.8f, 1, 0.2f}},
      {8, 3, bytes({0, 51, 102, 153, 204, 255}), bytes({0, 1, 0}), {0.6f, 0.8f, 1, 0, 0.2f, 0.4f}},
      {2, 3, bytes({0, 51, 102, 153, 204, 255}), bytes({0, 0x40}), {0.6f, 0.8f, 1, 0, 0.2f, 0.4f}},
  };
  for (const auto& c : cases) {
    const std::string path = png_file("kind.png", c.bits, c.type, c.palette, c.rows);
    const std::string what = std::to_string(c.bits) + " bits, type " + std::to_string(c.type);
    const auto ours = read_image(path);
    ASSERT_TRUE(ours.ok()) << what << ours.error;
    const Image theirs = read_by_openimageio(path);
    EXPECT_EQ(ours.value.pixels, c.pixels) << what;
    EXPECT_EQ(theirs.pixels, c.pixels) << what;
    EXPECT_EQ(ours.value.channel_names, theirs.channel_names) << what;
    EXPECT_EQ(ours.value.format, theirs.format) << what;
    EXPECT_EQ(ours.value.full_width, 2) << what;
  }
}

}  // namespace
}  // namespace whit
