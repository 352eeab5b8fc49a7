// Pictures by channels: OpenEXR files of all shapes, and what is cut off. OpenEXR and OpenImageIO write them here.
#include "core/image/planes.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTileDescriptionAttribute.h>
#include <OpenEXR/ImfTiledOutputPart.h>
#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/base/temp_folder.h"

namespace whit {
namespace {

using test::temp_path;
using test::write_temp;
using Names = std::vector<std::string>;

// A number that a half holds exactly, another one for each pixel nearby, channel and part: whole, at most 2047.
float number_at(int x, int y, int channel, int part) {
  return static_cast<float>(((x + 64) * 7 + (y + 64) * 31 + channel * 401 + part * 769) % 2048);
}

struct Part {
  std::string name;
  std::vector<std::pair<std::string, Imf::PixelType>> channels;
  Imath::Box2i data{{0, 0}, {19, 12}}, display{{0, 0}, {19, 12}};
  Imf::Compression compression = Imf::ZIP_COMPRESSION;
  int tile = 0;  // its width and height, or 0: rows
};

Part rgb_part(const std::string& name) { return {name, {{"R", Imf::HALF}, {"G", Imf::HALF}, {"B", Imf::HALF}}}; }

// Each number is that of number_at() by its place, its channel's place in the list and `id`.
void write_part(Imf::MultiPartOutputFile& file, int index, const Part& part, int id) {
  const int width = part.data.size().x + 1, height = part.data.size().y + 1;
  std::vector<std::vector<float>> floats;
  std::vector<std::vector<half>> halves;
  std::vector<std::vector<unsigned>> wholes;
  Imf::FrameBuffer buffer;
  for (size_t c = 0; c < part.channels.size(); ++c) {
    auto& f = floats.emplace_back();
    for (int y = part.data.min.y; y <= part.data.max.y; ++y)
      for (int x = part.data.min.x; x <= part.data.max.x; ++x) f.push_back(number_at(x, y, static_cast<int>(c), id));
    auto& h = halves.emplace_back(f.begin(), f.end());
    auto& w = wholes.emplace_back(f.begin(), f.end());
    const Imf::PixelType type = part.channels[c].second;
    void* const data = type == Imf::HALF    ? static_cast<void*>(h.data())
                       : type == Imf::FLOAT ? static_cast<void*>(f.data())
                                            : static_cast<void*>(w.data());
    buffer.insert(part.channels[c].first, Imf::Slice::Make(type, data, part.data.min, width, height));
  }
  if (part.tile > 0) {
    Imf::TiledOutputPart out(file, index);
    out.setFrameBuffer(buffer);
    out.writeTiles(0, out.numXTiles() - 1, 0, out.numYTiles() - 1);
  } else {
    Imf::OutputPart out(file, index);
    out.setFrameBuffer(buffer);
    out.writePixels(height);
  }
}

// The ids of the parts are their places in `parts`, or in `ids`.
std::string write_exr(const std::string& name, const std::vector<Part>& parts, std::vector<int> ids = {}) {
  std::vector<Imf::Header> headers;
  for (const Part& part : parts) {
    Imf::Header& header = headers.emplace_back(part.display, part.data);
    header.compression() = part.compression;
    header.setType(part.tile > 0 ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
    if (part.tile > 0) header.setTileDescription(Imf::TileDescription(part.tile, part.tile));
    if (!part.name.empty()) header.setName(part.name);
    for (const auto& [channel, type] : part.channels) header.channels().insert(channel, Imf::Channel(type));
    if (ids.size() < headers.size()) ids.push_back(static_cast<int>(headers.size()) - 1);
  }
  // Parts of different display windows are not to be had otherwise.
  Imf::MultiPartOutputFile file(temp_path(name).c_str(), headers.data(), static_cast<int>(headers.size()), true);
  for (size_t i = 0; i < parts.size(); ++i) write_part(file, static_cast<int>(i), parts[i], ids[i]);
  return temp_path(name);
}

// Whether a plane has the numbers of that channel and part, in the place of the data window.
void expect_plane(const PicturePlanes& p, const std::string& name, int channel, int part) {
  const int c = p.channel(name);
  ASSERT_GE(c, 0) << name;
  const std::vector<float>& plane = p.planes[static_cast<size_t>(c)];
  ASSERT_EQ(plane.size(), static_cast<size_t>(p.width) * static_cast<size_t>(p.height));
  for (int y = 0, i = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x, ++i)
      ASSERT_EQ(plane[static_cast<size_t>(i)], number_at(p.x + x, p.y + y, channel, part))
          << name << ' ' << x << ' ' << y;
}

Names sorted(Names names) {
  std::sort(names.begin(), names.end());
  return names;
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Planes, rows_and_tiles_of_all_kinds_of_numbers_and_compressions) {
  for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
                                             Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION})
    for (const int tile : {0, 8, 64}) {
      Part part{"", {{"A", Imf::HALF}, {"Z", Imf::FLOAT}, {"id", Imf::UINT}}};
      part.compression = compression, part.tile = tile;
      const auto read = read_planes(write_exr("kinds.exr", {part}));
      ASSERT_TRUE(read.ok()) << read.error;
      const PicturePlanes& p = read.value;
      EXPECT_EQ(p.channel_names, (Names{"A", "Z", "id"}));
      EXPECT_EQ(p.formats, (std::vector{SampleFormat::Half, SampleFormat::Float, SampleFormat::Float}));
      EXPECT_EQ(p.format, SampleFormat::Float);
      for (int c = 0; c < 3; ++c) expect_plane(p, p.channel_names[static_cast<size_t>(c)], c, 0);
    }
}

TEST(Planes, windows_may_begin_anywhere) {
  struct Case {
    Imath::Box2i data, display;
  };
  for (const Case& c : {Case{{{-5, -9}, {3, 4}}, {{0, 0}, {9, 9}}},                 // beyond the display window
                        Case{{{2, 3}, {7, 5}}, {{0, 0}, {9, 9}}},                   // a crop
                        Case{{{-30, -20}, {-11, -10}}, {{-40, -30}, {9, 9}}},       // all of it negative
                        Case{{{100, 200}, {100, 200}}, {{100, 200}, {100, 200}}}})  // a pixel far away
    for (const int tile : {0, 4}) {
      Part part = rgb_part("");
      part.data = c.data, part.display = c.display, part.tile = tile;
      const auto read = read_planes(write_exr("window.exr", {part}));
      ASSERT_TRUE(read.ok()) << read.error;
      const PicturePlanes& p = read.value;
      EXPECT_EQ(Imath::V2i(p.x, p.y), c.data.min);
      EXPECT_EQ(Imath::V2i(p.x + p.width - 1, p.y + p.height - 1), c.data.max);
      EXPECT_EQ(Imath::V2i(p.full_x, p.full_y), c.display.min);
      EXPECT_EQ(Imath::V2i(p.full_x + p.full_width - 1, p.full_y + p.full_height - 1), c.display.max);
      for (int k = 0; k < 3; ++k) expect_plane(p, std::string(1, "RGB"[k]), k, 0);
    }
}

// Reads the parts in every order; the names must be these, and each the same channel, which the map tells: part, channel.
void expect_names(std::vector<Part> parts, const std::map<std::string, std::pair<int, int>>& expected) {
  std::vector<int> order(parts.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  do {
    std::vector<Part> ordered;
    for (const int i : order) ordered.push_back(parts[static_cast<size_t>(i)]);
    const auto read = read_planes(write_exr("parts.exr", ordered, order));
    ASSERT_TRUE(read.ok()) << read.error;
    Names names;
    for (const auto& [name, of] : expected) {
      names.push_back(name);
      expect_plane(read.value, name, of.second, of.first);
    }
    EXPECT_EQ(sorted(read.value.channel_names), sorted(names));
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Planes, names_do_not_depend_on_the_order_of_parts) {
  const Part rgba = rgb_part("rgba"), normal = rgb_part("normal"), depth{"depth", {{"Z", Imf::FLOAT}}};
  expect_names({rgba, normal, depth}, {{"R", {0, 0}},
                                       {"G", {0, 1}},
                                       {"B", {0, 2}},
                                       {"Z", {2, 0}},
                                       {"normal.R", {1, 0}},
                                       {"normal.G", {1, 1}},
                                       {"normal.B", {1, 2}}});
  // None holds the picture itself.
  expect_names({rgb_part("one"), rgb_part("two")}, {{"one.R", {0, 0}},
                                                    {"one.G", {0, 1}},
                                                    {"one.B", {0, 2}},
                                                    {"two.R", {1, 0}},
                                                    {"two.G", {1, 1}},
                                                    {"two.B", {1, 2}}});
  // A name that only one has stays, also where it has its part's name already.
  expect_names({Part{"N", {{"N.X", Imf::HALF}}}, Part{"other", {{"X", Imf::HALF}}}, depth},
               {{"N.X", {0, 0}}, {"X", {1, 0}}, {"Z", {2, 0}}});
  // Parts of several names for it: the first of the list wins, of two spellings the first by their letters.
  const auto a = [](const std::string& name) { return Part{name, {{"A", Imf::HALF}}}; };
  expect_names({a("Beauty"), a("RGB")}, {{"A", {1, 0}}, {"Beauty.A", {0, 0}}});
  expect_names({a("c"), a("Combined"), a("x")}, {{"A", {1, 0}}, {"c.A", {0, 0}}, {"x.A", {2, 0}}});
  expect_names({a("MAIN"), a("C")}, {{"A", {0, 0}}, {"C.A", {1, 0}}});
  expect_names({a("C"), a("z")}, {{"A", {0, 0}}, {"z.A", {1, 0}}});
  expect_names({a("rgba"), a("RGBA")}, {{"A", {1, 0}}, {"rgba.A", {0, 0}}});
}

TEST(Planes, a_named_part_alone_keeps_its_channels_names) {
  const auto read = read_planes(write_exr("alone.exr", {rgb_part("normal")}));
  EXPECT_EQ(sorted(read.value.channel_names), (Names{"B", "G", "R"}));
}

TEST(Planes, two_channels_of_one_name_are_an_error) {
  const Part main{"rgba", {{"R", Imf::HALF}, {"normal.R", Imf::HALF}}}, normal{"normal", {{"R", Imf::HALF}}};
  for (const auto& parts : {std::vector{main, normal}, std::vector{normal, main}})
    EXPECT_NE(read_planes(write_exr("twice.exr", parts)).error.find("two channels normal.R"), std::string::npos);
}

TEST(Planes, parts_of_different_windows_are_an_error) {
  Part small = rgb_part("small");
  small.data = {{1, 1}, {5, 5}};
  const std::string error = read_planes(write_exr("windows.exr", {rgb_part("rgba"), small})).error;
  EXPECT_NE(error.find("different windows: \"rgba\" and \"small\""), std::string::npos) << error;
  small.data = rgb_part("").data;
  EXPECT_EQ(read_planes(write_exr("windows.exr", {rgb_part("rgba"), small})).error, "");
}

TEST(Planes, subsampled_and_deep_pictures_are_errors) {
  Imf::Header header(8, 8);
  header.channels().insert("BY", Imf::Channel(Imf::FLOAT, 2, 2));
  std::vector<float> quarter(16);
  Imf::FrameBuffer buffer;
  buffer.insert("BY", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(quarter.data()), 4, 16, 2, 2));
  {
    Imf::OutputFile file(temp_path("quarter.exr").c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(8);
  }
  const std::string error = read_planes(temp_path("quarter.exr")).error;
  EXPECT_NE(error.find("channel BY has not a number for every pixel"), std::string::npos) << error;

  OIIO::ImageSpec spec(4, 4, 2, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"Z", "A"};
  spec.deep = true;
  OIIO::DeepData deep(spec);
  for (int i = 0; i < 16; ++i) deep.set_samples(i, 2);
  const auto out = OIIO::ImageOutput::create(temp_path("deep.exr"));
  ASSERT_TRUE(out->open(temp_path("deep.exr"), spec) && out->write_deep_image(deep) && out->close());
  EXPECT_NE(read_planes(temp_path("deep.exr")).error.find("deep"), std::string::npos);
}

// 40 x 30 pixels of noise that no compression shortens much.
std::string write_noise(const std::string& name, OIIO::TypeDesc format, const std::string& compression = "",
                        int tile = 0, int bits = 0) {
  OIIO::ImageSpec spec(40, 30, 3, format);
  if (!compression.empty()) spec.attribute("compression", compression);
  if (bits > 0) spec.attribute("oiio:BitsPerSample", bits);
  spec.tile_width = spec.tile_height = tile;
  std::vector<float> pixels(size_t{40} * 30 * 3);
  uint32_t random = 1;
  for (float& v : pixels) {
    random = random * 1664525 + 1013904223;
    v = 0.1f + 0.8f * static_cast<float>(random >> 8) / float(1 << 24);
  }
  const auto out = OIIO::ImageOutput::create(name);
  EXPECT_TRUE(out && out->open(temp_path(name), spec) && out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) &&
              out->close())
      << name;
  return temp_path(name);
}

// Of files whose pixels come last: without any of these numbers of bytes, it is no picture.
void expect_cuts_found(const std::string& path, const std::string& what) {
  EXPECT_EQ(read_planes(path).error, "") << what;
  EXPECT_EQ(read_image(path).error, "") << what;
  const std::string whole = bytes_of(path);
  const size_t n = whole.size();
  for (const size_t less : {size_t{1}, size_t{2}, size_t{4}, size_t{14}, size_t{100}, n / 10, n / 4, n / 2, n * 3 / 4,
                            n * 9 / 10, n - 20, n - 4, n - 1}) {
    const std::string cut = write_temp("cut_" + what, whole.substr(0, n - less));
    EXPECT_NE(read_planes(cut).error.find("cannot read"), std::string::npos)
        << what << " without " << less << " of " << n;
    EXPECT_FALSE(read_image(cut).ok()) << what << " without " << less << " of " << n;
  }
}

TEST(Planes, what_is_cut_off_is_an_error) {
  const OIIO::TypeDesc u8 = OIIO::TypeDesc::UINT8, u16 = OIIO::TypeDesc::UINT16, f = OIIO::TypeDesc::FLOAT;
  for (const char* compression : {"none", "zip", "lzw", "packbits"})
    for (const OIIO::TypeDesc& type : {u8, u16, f})
      for (const int tile : {0, 16})
        expect_cuts_found(write_noise("a.tif", type, compression, tile), std::string(compression) + ".tif");
  for (const char* compression : {"none", "rle", "zip", "zips", "piz", "pxr24", "b44", "dwaa"})
    for (const int tile : {0, 16})
      expect_cuts_found(write_noise("a.exr", OIIO::TypeDesc::HALF, compression, tile),
                        std::string(compression) + ".exr");
  for (const char* name : {"a.bmp", "a.ppm", "a.png", "a.jpg", "a.iff", "a.sgi", "a.rla"})
    expect_cuts_found(write_noise(name, u8), name);
  expect_cuts_found(write_noise("b.ppm", u16), "b.ppm");
  expect_cuts_found(write_noise("b.png", u16), "b.png");
  expect_cuts_found(write_noise("a.hdr", f), "a.hdr");
  for (const int bits : {8, 10, 12, 16})
    expect_cuts_found(write_noise("a.dpx", bits == 8 ? u8 : u16, "", 0, bits), std::to_string(bits) + ".dpx");
}

TEST(Planes, a_tga_may_lack_all_behind_its_pixels) {
  // 18 bytes of header. What comes behind the pixels is of TGA 2.0, and old files have none of it.
  const std::string whole = bytes_of(write_noise("a.tga", OIIO::TypeDesc::UINT8, "none"));
  const size_t end = 18 + size_t{40} * 30 * 3;
  ASSERT_GT(whole.size(), end);
  EXPECT_TRUE(read_planes(write_temp("old.tga", whole.substr(0, end))).ok());
  for (const size_t less : {size_t{1}, size_t{3}, size_t{200}, end - 19, end - 3})
    EXPECT_FALSE(read_planes(write_temp("cut.tga", whole.substr(0, end - less))).ok()) << less;
}

TEST(Planes, pixels_missing_between_others_are_an_error) {
  // A multi-part file and one of tiles, cut at each of many lengths.
  Part tiles = rgb_part("normal");
  tiles.tile = 8;
  const std::string whole = bytes_of(write_exr("many.exr", {rgb_part("rgba"), tiles}));
  for (size_t n = 0; n < whole.size(); n += 7)
    EXPECT_NE(read_planes(write_temp("cut.exr", whole.substr(0, n))).error, "") << n << " of " << whole.size();
}

TEST(Planes, several_pages_are_an_error) {
  const std::string path = temp_path("pages.tif");
  const OIIO::ImageSpec spec(4, 4, 3, OIIO::TypeDesc::UINT8);
  const std::vector<uint8_t> pixels(48, 100);
  const auto out = OIIO::ImageOutput::create(path);
  ASSERT_TRUE(out->open(path, spec) && out->write_image(OIIO::TypeDesc::UINT8, pixels.data()) &&
              out->open(path, spec, OIIO::ImageOutput::AppendSubimage) &&
              out->write_image(OIIO::TypeDesc::UINT8, pixels.data()) && out->close());
  EXPECT_NE(read_planes(path).error.find("it holds several pictures"), std::string::npos) << read_planes(path).error;
}

TEST(Planes, the_top_row_is_first_whatever_the_file_has) {
  // Kind 3: grey bytes, 2 x 2; the bit 0x20 says that the top row is first.
  for (const bool top_first : {false, true}) {
    std::string tga(18, '\0');
    tga[2] = 3, tga[12] = 2, tga[14] = 2, tga[16] = 8, tga[17] = top_first ? 0x20 : 0;
    const auto read = read_planes(write_temp("order.tga", tga + std::string("\x00\x33\x66\xff", 4)));
    ASSERT_TRUE(read.ok()) << read.error;
    // 0x33 / 255 = 0.2, 0x66 / 255 = 0.4.
    ASSERT_EQ(read.value.planes.size(), 1u);
    EXPECT_EQ(read.value.planes[0],
              top_first ? (std::vector<float>{0, 0.2f, 0.4f, 1}) : (std::vector<float>{0.4f, 1, 0, 0.2f}));
  }
}

}  // namespace
}  // namespace whit
