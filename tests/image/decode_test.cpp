// Our own readers against pictures made here, number by number, and against OpenImageIO's.
#include "core/image/decode.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <functional>
#include <random>

#include "core/image/oiio/module.h"
#include "core/image/signature.h"
#include "tests/base/temp_folder.h"

namespace whit {
namespace {

using test::temp_path;
using test::write_temp;

// All numbers, top row first; bytes as numbers from 0 to 255.
std::vector<float> numbers_of(PictureRows& rows) {
  const ImageInfo& info = rows.info;
  const size_t row = size_t(info.width) * size_t(info.channels);
  std::vector<float> all(row * size_t(info.height));
  for (int y = 0; y < info.height; ++y) {
    float* const to = all.data() + row * size_t(rows.bottom_first ? info.height - 1 - y : y);
    if (info.format == SampleFormat::UInt8) std::copy_n(rows.next_bytes(), row, to);
    else std::copy_n(rows.next_floats(), row, to);
  }
  return all;
}

// --- PNG -------------------------------------------------------------------------------------------------------------

std::string word(uint32_t v) {
  return {static_cast<char>(v >> 24), static_cast<char>(v >> 16), static_cast<char>(v >> 8), static_cast<char>(v)};
}

std::string chunk(const std::string& kind, const std::string& data) {
  uint32_t crc = 0xffffffffu;
  for (const char c : kind + data) {
    crc ^= static_cast<uint8_t>(c);
    for (int k = 0; k < 8; ++k) crc = crc & 1 ? 0xedb88320u ^ (crc >> 1) : crc >> 1;
  }
  return word(static_cast<uint32_t>(data.size())) + kind + data + word(~crc);
}

// Blocks of deflate that are not compressed: their lengths and the complements, little endian; Adler-32 behind them.
std::string stored(const std::string& data) {
  std::string out("\x78\x01", 2);
  uint32_t a = 1, b = 0;
  for (const char c : data) a = (a + static_cast<uint8_t>(c)) % 65521, b = (b + a) % 65521;
  for (size_t at = 0; at < data.size(); at += 65535) {
    const auto n = static_cast<uint16_t>(std::min<size_t>(65535, data.size() - at));
    out += {static_cast<char>(at + n == data.size()), static_cast<char>(n), static_cast<char>(n >> 8),
            static_cast<char>(~n), static_cast<char>(~n >> 8)};
    out += data.substr(at, n);
  }
  return out + word(b << 16 | a);
}

struct PngPicture {
  int width, height, bits, type;
  std::vector<int> numbers;  // of the file: not scaled, palette entries by their place
  int per_pixel() const { return type == 2 ? 3 : type == 4 ? 2 : type == 6 ? 4 : 1; }
};

PngPicture random_png(int width, int height, int bits, int type) {
  PngPicture p{width, height, bits, type, {}};
  std::mt19937 random(static_cast<unsigned>(bits * 8 + type));
  for (int i = 0; i < width * height * p.per_pixel(); ++i)
    p.numbers.push_back(static_cast<int>(random() % (type == 3 ? 3u : 1u << bits)));
  return p;
}

// The rows of every dx-th pixel from (x0, y0) on, row number i by filter i modulo 5, as the standard describes them.
std::string filtered_rows(const PngPicture& p, int x0, int y0, int dx, int dy) {
  const int n = p.per_pixel(), width = (p.width - x0 + dx - 1) / dx, step = std::max(1, n * p.bits / 8);
  if (width <= 0) return "";
  std::string out;
  std::vector<int> above(static_cast<size_t>((width * n * p.bits + 7) / 8)), row;
  for (int y = y0, i = 0; y < p.height; y += dy, ++i) {
    row.assign(above.size(), 0);
    for (int k = 0; k < width * n; ++k) {
      const int v = p.numbers[size_t((y * p.width + x0 + k / n * dx) * n + k % n)], bit = k * p.bits;
      if (p.bits == 16) row[size_t(2 * k)] = v >> 8, row[size_t(2 * k + 1)] = v & 255;
      else row[size_t(bit / 8)] |= v << (8 - p.bits - bit % 8);
    }
    const int filter = i % 5;
    out += static_cast<char>(filter);
    for (int k = 0; k < int(row.size()); ++k) {
      const int a = k < step ? 0 : row[size_t(k - step)], b = above[size_t(k)],
                c = k < step ? 0 : above[size_t(k - step)];
      const int to_a = std::abs(b - c), to_b = std::abs(a - c), to_c = std::abs(a + b - 2 * c);
      const int paeth = to_a <= to_b && to_a <= to_c ? a : to_b <= to_c ? b : c;
      const std::array<int, 5> prediction{0, a, b, (a + b) / 2, paeth};
      out += static_cast<char>(row[size_t(k)] - prediction[size_t(filter)]);
    }
    above = row;
  }
  return out;
}

const std::string kColours("\x00\x33\x66\x99\xcc\xff\x11\x22\x44", 9);

std::string png_file(const PngPicture& p, bool interlaced, size_t chunk_bytes = 100000) {
  const std::string header =
      word(uint32_t(p.width)) + word(uint32_t(p.height)) +
      std::string{static_cast<char>(p.bits), static_cast<char>(p.type), 0, 0, static_cast<char>(interlaced)};
  const int passes[7][4] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                            {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
  std::string rows;
  if (!interlaced) rows = filtered_rows(p, 0, 0, 1, 1);
  else
    for (const auto& pass : passes) rows += filtered_rows(p, pass[0], pass[1], pass[2], pass[3]);
  std::string out = "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("tEXt", "Title and more");
  if (p.type == 3) out += chunk("PLTE", kColours);
  const std::string data = stored(rows);
  for (size_t at = 0; at < data.size(); at += chunk_bytes) out += chunk("IDAT", data.substr(at, chunk_bytes));
  return out + chunk("IEND", "");
}

std::vector<float> expected_of(const PngPicture& p) {
  std::vector<float> out;
  for (const int v : p.numbers) {
    if (p.type == 3) {
      for (int c = 0; c < 3; ++c) out.push_back(static_cast<uint8_t>(kColours[size_t(3 * v + c)]));
    } else {
      out.push_back(p.bits == 16 ? static_cast<float>(v) / 65535 : static_cast<float>(v * 255 / ((1 << p.bits) - 1)));
    }
  }
  return out;
}

constexpr struct {
  int bits, type;
} kPngKinds[] = {{1, 0}, {2, 0}, {4, 0}, {8, 0}, {16, 0}, {8, 2}, {16, 2}, {1, 3},
                 {2, 3}, {4, 3}, {8, 3}, {8, 4}, {16, 4}, {8, 6}, {16, 6}};

TEST(DecodePng, a_palette_may_have_alpha) {
  // Two alphas for three colours: the third is opaque.
  const PngPicture p = random_png(9, 4, 8, 3);
  std::string file = png_file(p, false);
  const size_t at = file.find("IDAT") - 4;
  file.insert(at, chunk("tRNS", std::string("\x00\x80", 2)));
  const auto rows = open_png(write_temp("transparent.png", file));
  ASSERT_EQ(rows->info.alpha_channel(), 3);
  const std::vector<float> numbers = numbers_of(*rows), colours = expected_of(p);
  for (size_t i = 0; i < p.numbers.size(); ++i) {
    for (size_t c = 0; c < 3; ++c) ASSERT_EQ(numbers[4 * i + c], colours[3 * i + c]);
    const float alphas[] = {0, 128, 255};
    ASSERT_EQ(numbers[4 * i + 3], alphas[p.numbers[i]]);
  }
}

TEST(DecodePng, one_colour_may_be_transparent) {
  for (const auto& [bits, type] : {std::pair{2, 0}, {8, 0}, {16, 0}, {8, 2}, {16, 2}}) {
    const PngPicture p = random_png(9, 4, bits, type);
    const size_t n = static_cast<size_t>(p.per_pixel()), pixel = 7;
    std::string key;
    for (size_t c = 0; c < n; ++c) {
      const int v = p.numbers[n * pixel + c];
      key += static_cast<char>(v >> 8), key += static_cast<char>(v & 255);
    }
    std::string file = png_file(p, false);
    file.insert(file.find("IDAT") - 4, chunk("tRNS", key));
    const auto rows = open_png(write_temp("transparent.png", file));
    ASSERT_EQ(rows->info.alpha_channel(), static_cast<int>(n));
    const std::vector<float> numbers = numbers_of(*rows), colours = expected_of(p);
    for (size_t i = 0; i < colours.size() / n; ++i) {
      bool same = true;
      for (size_t c = 0; c < n; ++c) {
        ASSERT_EQ(numbers[(n + 1) * i + c], colours[n * i + c]) << bits << ' ' << type;
        same = same && colours[n * i + c] == colours[n * pixel + c];
      }
      ASSERT_EQ(numbers[(n + 1) * i + n], same ? 0 : bits == 16 ? 1 : 255);
    }
  }
}

TEST(DecodePng, every_kind_by_every_filter_in_order_and_interlaced) {
  for (const auto& kind : kPngKinds) {
    if (kind.type == 3 && kind.bits == 1) continue;  // three colours
    for (const bool interlaced : {false, true})
      for (const auto& [width, height] : {std::pair{37, 23}, {1, 1}, {3, 2}, {1, 9}, {5, 1}}) {
        const PngPicture p = random_png(width, height, kind.bits, kind.type);
        const std::string path = write_temp("kind.png", png_file(p, interlaced));
        const std::string what = std::to_string(kind.bits) + " bits, type " + std::to_string(kind.type) + ", " +
                                 std::to_string(width) + " x " + std::to_string(height) +
                                 (interlaced ? " interlaced" : "");
        EXPECT_EQ(numbers_of(*open_png(path)), expected_of(p)) << what;
        EXPECT_EQ(numbers_of(*oiio().open(path)), expected_of(p)) << what;
      }
  }
}

TEST(DecodePng, more_than_fits_into_any_buffer_in_chunks_of_any_size) {
  // 700 x 500 x 3 bytes are eight strips of 128 KiB and 16 buffers of 64 KiB.
  const PngPicture p = random_png(700, 500, 8, 2);
  for (const size_t chunk_bytes : {1000u, 65536u, 70001u, 2000000u})
    EXPECT_EQ(numbers_of(*open_png(write_temp("large.png", png_file(p, false, chunk_bytes)))), expected_of(p));
  // A row alone is larger than a strip.
  const PngPicture wide = random_png(100000, 3, 8, 2);
  EXPECT_EQ(numbers_of(*open_png(write_temp("wide.png", png_file(wide, false)))), expected_of(wide));
}

std::string error_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const std::runtime_error& e) { return e.what(); }
  return "";
}

TEST(DecodePng, what_is_damaged_is_an_error) {
  const std::string whole = png_file(random_png(20, 20, 8, 2), false);
  const auto error = [](const std::string& bytes) {
    const std::string path = write_temp("damaged.png", bytes);
    return error_of([&] { numbers_of(*open_png(path)); });
  };
  EXPECT_EQ(error(whole), "");
  // Wherever it is cut before the end of the pixels: their chunk's sum is before the 12 bytes of the last chunk.
  for (size_t n = 0; n < whole.size() - 12; ++n) EXPECT_NE(error(whole.substr(0, n)), "") << n;
  // One wrong byte is found by a checksum, if not before; except in what is skipped, a text of 14 bytes with name and sum.
  const size_t text = whole.find("Title");
  for (size_t i = 0; i < whole.size() - 12; ++i) {
    if (i + 4 >= text && i < text + 18) continue;
    std::string bad = whole;
    bad[i] = static_cast<char>(bad[i] ^ 0x40);
    EXPECT_NE(error(bad), "") << i;
  }
}

TEST(DecodePng, what_gamma_says_where_nothing_goes_before_it) {
  const auto gamma = [](uint32_t power) { return chunk("gAMA", word(power)); };
  const std::string srgb = chunk("sRGB", std::string(1, '\0')), profile = chunk("iCCP", "x");
  const auto space = [](int bits, int type, const std::string& chunks) {
    const std::string whole = png_file(random_png(3, 2, bits, type), false);  // 8 bytes of signature, 25 of IHDR
    const std::string path = write_temp("gamma.png", whole.substr(0, 33) + chunks + whole.substr(33));
    return open_png(path)->info.metadata.at("oiio:ColorSpace");
  };
  for (const auto& [bits, type] : {std::pair{8, 2}, {16, 2}, {8, 3}, {2, 3}, {1, 0}, {16, 4}, {8, 6}}) {
    const auto of = [&, b = bits, t = type](const std::string& chunks) { return space(b, t, chunks); };
    EXPECT_EQ(of(""), "sRGB");
    EXPECT_EQ(of(gamma(100000)), "linear");
    EXPECT_EQ(of(gamma(45455)), "gamma=2.2");
    EXPECT_EQ(of(gamma(55556)), "gamma=1.8");
    EXPECT_EQ(of(gamma(50000)), "gamma=2");
    EXPECT_EQ(of(gamma(0)), "sRGB");  // means nothing
    EXPECT_EQ(of(chunk("gAMA", "ab")), "sRGB");
    for (const std::string& first : {srgb, profile}) {
      EXPECT_EQ(of(first + gamma(100000)), "sRGB");
      EXPECT_EQ(of(gamma(100000) + first), "sRGB");
    }
    EXPECT_EQ(of(chunk("cICP", std::string("\x01\x08\0\x01", 4))), "sRGB");
  }
}

TEST(DecodePng, what_is_cut_off_is_an_error) {
  const std::string whole = png_file(random_png(5, 4, 8, 2), false) + "more";
  for (size_t part = 0; part + 4 < whole.size(); ++part) {
    const std::string path = write_temp("cut.png", whole.substr(0, part));
    EXPECT_NE(error_of([&] { numbers_of(*open_png(path)); }), "") << part;
  }
  EXPECT_EQ(error_of([&] { numbers_of(*open_png(write_temp("long.png", whole))); }), "");  // as all readers have it
}

TEST(DecodePng, headers_that_cannot_be_are_errors) {
  const auto error = [](PngPicture p, int interlace = 0) {
    std::string bytes = png_file(p, false);
    if (interlace) bytes = png_file(p, interlace == 1);
    const std::string path = write_temp("header.png", bytes);
    return error_of([&] { open_png(path); });
  };
  for (const auto& [bits, type] : {std::pair{3, 0}, {4, 2}, {16, 3}, {8, 5}, {8, 1}, {4, 6}, {32, 0}}) {
    PngPicture p = random_png(2, 2, 8, 0);
    p.bits = bits, p.type = type;
    p.numbers.resize(100);
    std::string header = word(2) + word(2) + std::string{static_cast<char>(bits), static_cast<char>(type), 0, 0, 0};
    const std::string path = write_temp("header.png", "\x89PNG\r\n\x1a\n" + chunk("IHDR", header));
    EXPECT_NE(error_of([&] { open_png(path); }), "") << bits << ' ' << type;
  }
  EXPECT_EQ(error(random_png(2, 2, 8, 0)), "");
  // 2000000000 x 2000000000 pixels in a few bytes.
  const std::string lying = word(2000000000) + word(2000000000) + std::string("\x08\x02\0\0\0", 5);
  const std::string path = write_temp("lying.png", "\x89PNG\r\n\x1a\n" + chunk("IHDR", lying) + chunk("IDAT", "x"));
  EXPECT_NE(error_of([&] { open_png(path); }).find("claims"), std::string::npos);
}

// --- JPEG and TGA ----------------------------------------------------------------------------------------------------

std::string write_with_oiio(const std::string& name, OIIO::ImageSpec spec) {
  std::vector<unsigned char> pixels(size_t(spec.width) * size_t(spec.height) * size_t(spec.nchannels));
  // Smooth, with runs of equal pixels, so that JPEG and run lengths have something to do.
  for (size_t i = 0; i < pixels.size(); ++i) {
    const auto pixel = i / size_t(spec.nchannels), x = pixel % size_t(spec.width), y = pixel / size_t(spec.width);
    pixels[i] = static_cast<unsigned char>(x / 7 * 11 + y * 3 + i % size_t(spec.nchannels) * 50);
  }
  auto out = OIIO::ImageOutput::create(temp_path(name));
  EXPECT_TRUE(out && out->open(temp_path(name), spec) && out->write_image(OIIO::TypeDesc::UINT8, pixels.data()) &&
              out->close());
  return temp_path(name);
}

void expect_as_openimageio(const std::string& path, PictureRows& rows) {
  const auto theirs = oiio().open(path);
  EXPECT_EQ(rows.info.width, theirs->info.width);
  EXPECT_EQ(rows.info.height, theirs->info.height);
  EXPECT_EQ(rows.info.channel_names, theirs->info.channel_names) << path;
  EXPECT_EQ(rows.info.format, theirs->info.format) << path;
  EXPECT_EQ(numbers_of(rows), numbers_of(*theirs)) << path;
}

TEST(DecodeJpeg, is_as_openimageio_reads_it) {
  for (const int channels : {1, 3})
    for (const char* quality : {"jpeg:95", "jpeg:40"}) {
      OIIO::ImageSpec spec(301, 77, channels, OIIO::TypeDesc::UINT8);
      spec.attribute("compression", quality);
      spec.attribute("jpeg:progressive", quality[5] == '4');
      const std::string path = write_with_oiio("a.jpg", spec);
      EXPECT_EQ(kind_of_picture(path), PictureKind::Jpeg);
      expect_as_openimageio(path, *open_jpeg(path));
    }
}

TEST(DecodeJpeg, the_name_of_its_profile_is_known) {
  // ICC.1: 128 bytes of header, the number of tags, and of each its name, place and length.
  const auto profile = [](const std::string& tag) {
    return std::string(128, '\0') + word(1) + "desc" + word(144) + word(uint32_t(tag.size())) + tag;
  };
  const std::string old = "desc" + word(0) + word(7) + std::string("Linear\0", 7);
  const std::string wide("\0L\0i\0n\0e\0a\0r", 12);
  const std::string recent = "mluc" + word(0) + word(1) + word(12) + "enUS" + word(12) + word(28) + wide;
  for (const std::string& tag : {old, recent}) {
    const std::string plain = write_with_oiio("plain.jpg", OIIO::ImageSpec(16, 16, 3, OIIO::TypeDesc::UINT8));
    std::ifstream file(plain, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const std::string data = std::string("ICC_PROFILE\0\1\1", 14) + profile(tag);
    const auto length = static_cast<uint16_t>(data.size() + 2);
    const std::string marker =
        std::string("\xff\xe2") + static_cast<char>(length >> 8) + static_cast<char>(length) + data;
    const std::string path = write_temp("profile.jpg", bytes.substr(0, 2) + marker + bytes.substr(2));
    EXPECT_EQ(open_jpeg(path)->info.metadata.at("ICCProfile:profile_description"), "Linear") << tag.substr(0, 4);
  }
}

TEST(DecodeJpeg, what_is_cut_short_is_an_error) {
  const std::string path = write_with_oiio("whole.jpg", OIIO::ImageSpec(200, 200, 3, OIIO::TypeDesc::UINT8));
  std::ifstream file(path, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(file), {}};
  for (const size_t part : {whole.size() / 2, whole.size() * 9 / 10, size_t{300}, size_t{10}}) {
    const std::string cut = write_temp("cut.jpg", whole.substr(0, part));
    EXPECT_NE(error_of([&] { numbers_of(*open_jpeg(cut)); }), "") << part;
  }
}

TEST(DecodeTga, is_as_openimageio_reads_it) {
  for (const int channels : {1, 3, 4})
    for (const char* compression : {"none", "rle"}) {
      OIIO::ImageSpec spec(301, 77, channels, OIIO::TypeDesc::UINT8);
      spec.attribute("compression", compression);
      spec.attribute("oiio:UnassociatedAlpha", 1);
      const std::string path = write_with_oiio("a.tga", spec);
      EXPECT_EQ(kind_of_picture(path), PictureKind::Tga);
      expect_as_openimageio(path, *open_tga(path));
    }
}

TEST(DecodeTga, both_orders_of_rows_and_packets_across_rows) {
  // Kind 11: grey with run lengths, 3 x 2. Four pixels of 7, then two as they are, 8 and 9.
  for (const bool top_first : {false, true}) {
    std::string tga(18, '\0');
    tga[0] = 2, tga[2] = 11, tga[12] = 3, tga[14] = 2, tga[16] = 8, tga[17] = top_first ? 0x20 : 0;
    const std::string path = write_temp("runs.tga", tga + "id" + std::string("\x83\x07\x01\x08\x09 and more", 14));
    EXPECT_EQ(kind_of_picture(path), PictureKind::Tga);
    EXPECT_EQ(numbers_of(*open_tga(path)),
              top_first ? (std::vector<float>{7, 7, 7, 7, 8, 9}) : (std::vector<float>{7, 8, 9, 7, 7, 7}));
    expect_as_openimageio(path, *open_tga(path));
  }
}

TEST(DecodeTga, uncommon_kinds_are_left_to_openimageio) {
  std::string tga(18, '\0');
  tga[2] = 2, tga[12] = 1, tga[14] = 1, tga[16] = 24;
  EXPECT_EQ(kind_of_picture(write_temp("plain.tga", tga + "bgr12345")), PictureKind::Tga);
  std::string mirrored = tga, narrow = tga, mapped = tga;
  mirrored[17] = 0x10, narrow[16] = 16, mapped[1] = 1, mapped[2] = 1, mapped[16] = 8;
  for (const std::string& t : {mirrored, narrow, mapped})
    EXPECT_EQ(kind_of_picture(write_temp("other.tga", t + "bgr12345")), PictureKind::Other);
}

}  // namespace
}  // namespace whit
