// The store: one decode for many threads, sharing, eviction under a cap, errors kept and reported.
#include "core/image/texture_store.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "core/base/mapped_picture.h"
#include "core/image/mipmap.h"
#include "core/image/write.h"
#include "tests/base/temp_folder.h"

namespace whit {
namespace {

// A float picture of one value, side x side.
std::string constant_file(const std::string& name, int side, float value) {
  const std::string path = fmt::format("{}/whit_store_{}.pfm", test::temp_folder(), name);
  const std::vector<float> rgb(static_cast<size_t>(side) * side * 3, value);
  OutputImage image;
  image.width = image.height = side;
  image.rgb = rgb;
  EXPECT_EQ(write_image(path, image).error, "");
  return path;
}

TextureSpec spec_of(const std::string& path, TextureKind kind = TextureKind::Rgb) {
  TextureSpec spec;
  spec.path = path;
  spec.kind = kind;
  return spec;
}

float look(const ImageTexture* texture) {
  const float s = 0.5f, t = 0.5f;
  float r = -1, g = -2, b = -3;
  texture->lookup(1, &s, &t, nullptr, nullptr, nullptr, nullptr, &r, &g, &b);
  EXPECT_EQ(r, g);
  EXPECT_EQ(r, b);
  return r;
}

TEST(TextureStore, equal_specs_are_one_texture_and_nothing_is_read_before_it_is_used) {
  TextureStore store;
  TextureSpec spec = spec_of("/nowhere/yet.png");
  const ImageTexture* a = store.add(spec);
  EXPECT_EQ(a, store.add(spec));
  spec.scale = 2;
  EXPECT_NE(a, store.add(spec));
  EXPECT_TRUE(store.errors().all().empty());
  EXPECT_EQ(store.statistics().decodes, 0);
}

TEST(TextureStore, textures_that_differ_in_the_filter_share_the_pyramid) {
  TextureStore store;
  TextureSpec spec = spec_of(constant_file("share", 4, 0.5f));
  const ImageTexture* ewa = store.add(spec);
  spec.filter = TextureFilter::Trilinear;
  const ImageTexture* trilinear = store.add(spec);
  EXPECT_NE(ewa, trilinear);
  spec.filter = TextureFilter::Point;
  EXPECT_NE(store.add(spec), ewa);
  EXPECT_NE(store.add(spec), trilinear);
  EXPECT_EQ(look(ewa), 0.5f);
  EXPECT_EQ(look(trilinear), 0.5f);
  EXPECT_EQ(store.statistics().decodes, 1);
  EXPECT_EQ(store.statistics().lookups, 2);
  EXPECT_EQ(ewa->pyramid(), trilinear->pyramid());
}

TEST(TextureStore, float_lookups) {
  // Luminance of (v, v, v): the weights sum to 1. A Float texture holds one channel, an RGB one three.
  TextureStore store;
  const std::string path = constant_file("float", 2, 0.25f);
  const float st[300] = {};
  for (const TextureKind kind : {TextureKind::Float, TextureKind::Rgb}) {
    const ImageTexture* texture = store.add(spec_of(path, kind));
    EXPECT_EQ(texture->pyramid()->channels(), kind == TextureKind::Float ? 1 : 3);
    std::vector<float> out(300, -1);
    texture->lookup_float(300, st, st, nullptr, nullptr, nullptr, nullptr, out.data());
    for (float v : out) ASSERT_NEAR(v, 0.25f, 1e-6f);
    EXPECT_NEAR(look(texture), 0.25f, 1e-6f);
  }
}

TEST(TextureStore, many_threads_decode_once) {
  TextureStore store;
  const ImageTexture* texture = store.add(spec_of(constant_file("once", 300, 0.5f)));
  std::atomic<int> good{0};
  tbb::parallel_for(0, 400, [&](int) { good += std::abs(look(texture) - 0.5f) < 1e-5f; });
  EXPECT_EQ(good, 400);
  EXPECT_EQ(store.statistics().decodes, 1);
}

// A 32 x 32 RGB float pyramid has (1024 + 256 + 64 + 16 + 4 + 1) * 12 bytes. While it is made there are the picture in its
// reader, its rows as they are handed out, at most 256, and 12 rows in the builder.
constexpr size_t kPyramid = 16380, kReading = 12288 + 12288 + 12 * 32 * 12, kMaking = kPyramid + kReading;

TEST(TextureStore, least_recently_used_go_when_memory_is_short) {
  // Beside a pyramid that is made, one other fits in 62000, two do not.
  TextureStore store;
  store.set_memory_limit(62000);
  const ImageTexture* a = store.add(spec_of(constant_file("a", 32, 1)));
  const ImageTexture* b = store.add(spec_of(constant_file("b", 32, 2)));
  const ImageTexture* c = store.add(spec_of(constant_file("c", 32, 3)));
  EXPECT_EQ(look(a), 1);
  EXPECT_EQ(look(b), 2);
  EXPECT_EQ(look(a), 1);  // a is now younger than b
  EXPECT_EQ(look(c), 3);  // b goes
  TextureStatistics s = store.statistics();
  EXPECT_EQ(s.decodes, 3);
  EXPECT_EQ(s.evictions, 1);
  EXPECT_EQ(s.resident_bytes, 2 * kPyramid);
  EXPECT_EQ(s.peak_bytes, kPyramid + kMaking);
  EXPECT_EQ(look(a), 1);
  EXPECT_EQ(store.statistics().decodes, 3);  // still there
  EXPECT_EQ(look(b), 2);
  EXPECT_EQ(store.statistics().decodes, 3);  // not decoded again: it was in the file
  EXPECT_EQ(store.statistics().returns, 1);
  EXPECT_LE(store.statistics().resident_bytes, 62000u);
}

TEST(TextureStore, what_nobody_looked_up_goes_first) {
  // As above, but the textures are seen from afar: a footprint of 1/4 is at level 5 - 2 = 3, 4 x 4 texels, and levels 3
  // to 5 have (16 + 4 + 1) * 12 = 252 bytes, with the spare one 1020. In room for nine of these, twenty of those fit: no
  // texture is dropped, none decoded again, until someone looks closer than at the spare level.
  TextureStore store;
  store.set_memory_limit(kReading + 10 * 1020);
  std::vector<const ImageTexture*> textures;
  for (int i = 0; i < 20; ++i)
    textures.push_back(store.add(spec_of(constant_file(fmt::format("far{}", i), 32, float(i)))));
  const float st = 0.5f, zero = 0, far = 0.25f, near = 0.03f;
  const auto look_at = [&](const ImageTexture* texture, float d) {
    float out = -1;
    texture->lookup_float(1, &st, &st, &d, &zero, &zero, &d, &out);
    return out;
  };
  for (int round = 0; round < 2; ++round)
    for (int i = 0; i < 20; ++i) EXPECT_NEAR(look_at(textures[size_t(i)], far), float(i), 1e-5f);
  TextureStatistics s = store.statistics();
  EXPECT_EQ(s.decodes, 20);
  EXPECT_EQ(s.evictions, 0);
  EXPECT_GE(s.trims, 10);
  EXPECT_LE(s.peak_bytes, kReading + 10 * 1020);
  EXPECT_EQ(s.decoded_bytes, 20 * 1020);
  EXPECT_NEAR(look_at(textures[19], 2 * near), 19, 1e-5f);  // level 5 - 4 = 1
  EXPECT_NEAR(look_at(textures[3], near), 3, 1e-5f);
  s = store.statistics();
  EXPECT_EQ(s.decodes, 22);
  EXPECT_EQ(s.files, 20);
  EXPECT_GT(s.decode_seconds, 0);
}

TEST(TextureStore, threads_that_decode_share_the_cap) {
  // Room for one at a time, when each of the three other threads may be in a lookup of one that has been dropped.
  TextureStore store;
  store.set_memory_limit(40000);
  std::vector<const ImageTexture*> textures;
  for (int i = 0; i < 8; ++i)
    textures.push_back(store.add(spec_of(constant_file(fmt::format("cap{}", i), 32, float(i)))));
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (int first = 0; first < 4; ++first)
    threads.emplace_back([&, first] {
      for (int i = 0; i < 100; ++i) wrong += look(textures[size_t(first + i) % 8]) != float((first + i) % 8);
    });
  for (std::thread& t : threads) t.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(store.statistics().peak_bytes, kMaking + 3 * kPyramid);
}

TEST(TextureStore, a_pyramid_in_use_survives_eviction) {
  TextureStore store;
  store.set_memory_limit(1);
  const ImageTexture* a = store.add(spec_of(constant_file("use1", 8, 1)));
  const auto held = a->pyramid();
  EXPECT_EQ(look(store.add(spec_of(constant_file("use2", 8, 2)))), 2);
  EXPECT_EQ(store.statistics().evictions, 1);
  EXPECT_EQ(held->width(), 8);
  EXPECT_NE(a->pyramid(), held);
}

TEST(TextureStore, eviction_under_threads_changes_no_value) {
  TextureStore store;
  store.set_memory_limit(20000);
  std::vector<const ImageTexture*> textures;
  for (int i = 0; i < 6; ++i)
    textures.push_back(store.add(spec_of(constant_file(std::string(1, char('k' + i)), 32, float(i)))));
  std::atomic<int> wrong{0};
  tbb::parallel_for(0, 600, [&](int i) { wrong += look(textures[size_t(i * 7 % 6)]) != float(i * 7 % 6); });
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(store.statistics().evictions, 0);
}

TEST(TextureStore, only_levels_that_are_looked_at_are_kept_and_a_spare_one) {
  // As above: level 3 with the spare one 1020 bytes, all 16380.
  TextureStore store;
  const ImageTexture* texture = store.add(spec_of(constant_file("levels", 32, 0.5f)));
  const float st = 0.5f, zero = 0;
  const auto look_at = [&](float d) {
    float out = -1;
    texture->lookup_float(1, &st, &st, &d, &zero, &zero, &d, &out);
    EXPECT_NEAR(out, 0.5f, 1e-6f);
    return store.statistics();
  };
  EXPECT_EQ(look_at(0.25f).resident_bytes, 1020u);
  EXPECT_EQ(look_at(0.125f).decodes, 1);  // the spare level
  EXPECT_EQ(look_at(0.0625f).resident_bytes, kPyramid);
  EXPECT_EQ(look_at(0.01f).decodes, 2);
}

TEST(TextureStore, a_file_that_cannot_be_decoded_is_black_and_reported) {
  TextureStore store;
  const std::string path = constant_file("cut", 64, 1);
  std::filesystem::resize_file(path, 500);
  const ImageTexture* texture = store.add(spec_of(path), {3, 40});
  EXPECT_FALSE(store.failed());
  EXPECT_EQ(look(texture), 0);
  EXPECT_TRUE(store.failed());
  EXPECT_EQ(look(texture), 0);
  EXPECT_EQ(texture->pyramid(), nullptr);
  const Diagnostics errors = store.errors();
  ASSERT_EQ(errors.all().size(), 1u);
  EXPECT_NE(errors.all()[0].message.find(path), std::string::npos);
  EXPECT_EQ(errors.all()[0].where.file, 3u);
  EXPECT_EQ(errors.all()[0].where.offset, 40u);
  EXPECT_EQ(store.statistics().decodes, 0);
}

// All that the store says, as lines.
std::string said_by(const TextureStore& store) {
  std::string said;
  const Diagnostics errors = store.errors();
  for (const Diagnostic& d : errors.all()) said += fmt::format("{}@{}\n", d.message, d.where.offset);
  return said;
}

void make_old(const std::string& path) {
  std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
}

TEST(TextureStore, a_file_replaced_between_two_decodings_is_an_error) {
  // By another of the same size, as one who paints saves it: first in place, then by renaming. What was decoded before
  // gave values of 1; a picture of 1 and 2 would be of neither file.
  for (const bool rename : {false, true}) {
    const std::string path = constant_file("replaced", 32, 1);
    make_old(path);
    TextureStore store;
    // One reading is by numbers, one by colours: of two textures of a file the second is decoded later.
    const ImageTexture* colour = store.add(spec_of(path), {0, 7});
    const ImageTexture* number = store.add(spec_of(path, TextureKind::Float), {0, 9});
    EXPECT_EQ(look(colour), 1);
    const std::string other = constant_file(rename ? "other" : "replaced", 32, 2);
    if (rename) std::filesystem::rename(other, path);
    EXPECT_FALSE(store.failed());
    EXPECT_EQ(look(number), 0);
    EXPECT_TRUE(store.failed());
    EXPECT_EQ(said_by(store), fmt::format("cannot read image \"{}\": it changed while it was read@9\n", path));
    // What is in memory needs no file.
    EXPECT_EQ(look(colour), 1);
  }
}

TEST(TextureStore, a_file_that_is_cut_off_meanwhile_is_not_called_damaged) {
  const std::string path = constant_file("cut_off", 64, 1);
  make_old(path);
  TextureStore store;
  const ImageTexture* texture = store.add(spec_of(path), {0, 7});
  std::filesystem::resize_file(path, 100);
  EXPECT_EQ(look(texture), 0);
  EXPECT_EQ(said_by(store), fmt::format("cannot read image \"{}\": it changed while it was read@7\n", path));
}

TEST(TextureStore, so_is_a_picture_inside_of_a_model) {
  const std::string path = constant_file("inside", 256, 1);
  make_old(path);
  const auto file = std::make_shared<const MappedFile>(path);
  auto inside = std::make_shared<MappedPicture>(file);
  inside->name = "model.glb: /images/0";
  inside->bytes = {reinterpret_cast<const uint8_t*>(file->bytes().data()), file->bytes().size()};
  inside->owner = file;
  TextureSpec spec;
  spec.bytes = inside;
  TextureStore store;
  const ImageTexture* texture = store.add(spec, {0, 7});
  std::filesystem::resize_file(path, 100000);
  EXPECT_EQ(look(texture), 0);
  EXPECT_EQ(said_by(store), "cannot read image \"model.glb: /images/0\": it changed while it was read@7\n");
}

// The bytes of a file, as a model holds them.
std::shared_ptr<PictureBytes> in_memory(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  auto all =
      std::make_shared<std::vector<char>>(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  auto bytes = std::make_shared<PictureBytes>();
  bytes->name = "model.glb: /images/3" + (path.ends_with(".tga") ? std::string(".tga") : std::string());
  bytes->bytes = {reinterpret_cast<const uint8_t*>(all->data()), all->size()};
  bytes->owner = all;
  return bytes;
}

// A picture of 7 x 5 pixels in a format, by its extension.
std::string coloured_file(const std::string& extension) {
  const std::string path = fmt::format("{}/whit_store_colour.{}", test::temp_folder(), extension);
  std::vector<float> rgb;
  for (int i = 0; i < 7 * 5 * 3; ++i) rgb.push_back(static_cast<float>(i * 37 % 101) / 100);
  OutputImage image;
  image.width = 7, image.height = 5, image.rgb = rgb;
  EXPECT_EQ(write_image(path, image).error, "");
  return path;
}

std::vector<float> look_around(const ImageTexture* texture) {
  std::vector<float> s, t;
  for (int i = 0; i < 100; ++i) s.push_back(static_cast<float>(i % 10) / 10), t.push_back(static_cast<float>(i) / 100);
  std::vector<float> r(100), g(100), b(100);
  texture->lookup(100, s.data(), t.data(), nullptr, nullptr, nullptr, nullptr, r.data(), g.data(), b.data());
  r.insert(r.end(), g.begin(), g.end()), r.insert(r.end(), b.begin(), b.end());
  return r;
}

TEST(TextureStore, a_picture_in_memory_gives_the_bits_of_the_same_in_a_file) {
  for (const char* extension : {"png", "jpg", "tga", "exr", "tif", "pfm"}) {
    const std::string path = coloured_file(extension);
    TextureStore store;
    TextureSpec spec = spec_of(path);
    spec.gamma.reset();
    const std::vector<float> of_file = look_around(store.add(spec));
    spec.path.clear(), spec.bytes = in_memory(path);
    EXPECT_EQ(look_around(store.add(spec)), of_file) << extension;
    EXPECT_EQ(store.statistics().decodes, 2);
    EXPECT_TRUE(store.errors().all().empty()) << extension;
    EXPECT_GT(*std::max_element(of_file.begin(), of_file.end()), 0.5f);
  }
}

TEST(TextureStore, the_colours_of_webp_are_not_multiplied_by_its_alpha) {
  // Lossless, 2 x 2, as libwebp wrote it: (200 100 50 128) (10 20 30 255) / (0 0 0 255) (255 255 255 64).
  const unsigned char webp[] = {
      0x52, 0x49, 0x46, 0x46, 0x40, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50, 0x56, 0x50, 0x38, 0x4c, 0x33, 0x00,
      0x00, 0x00, 0x2f, 0x01, 0x40, 0x00, 0x10, 0x1f, 0x20, 0x10, 0x20, 0x4c, 0xf8, 0xf2, 0x3f, 0x63, 0x43, 0x48,
      0x40, 0xe8, 0xfe, 0xdf, 0x71, 0x8d, 0x90, 0x80, 0x30, 0x42, 0xf7, 0x7f, 0x25, 0x81, 0x00, 0xd1, 0x26, 0x4d,
      0x99, 0x34, 0x01, 0xfc, 0xa3, 0x55, 0x0a, 0xb2, 0x01, 0xca, 0x54, 0x61, 0x13, 0xd1, 0xff, 0xf8, 0x00, 0x00};
  const std::string path = fmt::format("{}/whit_store_alpha.webp", test::temp_folder());
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(webp), sizeof webp);
  for (const bool memory : {false, true}) {
    TextureStore store;
    TextureSpec spec = spec_of(path);
    spec.filter = TextureFilter::Point;
    if (memory) spec.path.clear(), spec.bytes = in_memory(path);
    const float s[] = {0.25f, 0.75f, 0.25f, 0.75f}, t[] = {0.75f, 0.75f, 0.25f, 0.25f};
    std::vector<float> r(4), g(4), b(4), a(4);
    store.add(spec)->lookup(4, s, t, nullptr, nullptr, nullptr, nullptr, r.data(), g.data(), b.data());
    spec.kind = TextureKind::Float, spec.channel = TextureChannel::Alpha;
    store.add(spec)->lookup_float(4, s, t, nullptr, nullptr, nullptr, nullptr, a.data());
    const auto of = [](std::vector<float> bytes) {
      for (float& v : bytes) v /= 255;
      return bytes;
    };
    EXPECT_EQ(r, of({200, 10, 0, 255}));
    EXPECT_EQ(g, of({100, 20, 0, 255}));
    EXPECT_EQ(b, of({50, 30, 0, 255}));
    EXPECT_EQ(a, of({128, 255, 255, 64}));
    EXPECT_TRUE(store.errors().all().empty());
    // Cut off, it is an error.
    const auto cut = in_memory(path);
    cut->bytes = cut->bytes.first(60);
    spec.path.clear(), spec.bytes = cut;
    store.add(spec)->lookup_float(1, s, t, nullptr, nullptr, nullptr, nullptr, a.data());
    ASSERT_EQ(store.errors().all().size(), 1u);
    EXPECT_NE(store.errors().all()[0].message.find("ends early"), std::string::npos) << store.errors().all()[0].message;
  }
}

TEST(TextureStore, errors_name_pictures_in_memory_as_they_are_called) {
  const std::string path = coloured_file("png");
  for (const size_t size : {size_t{0}, size_t{20}, size_t{60}}) {
    const auto bytes = in_memory(path);
    bytes->bytes = bytes->bytes.first(size);
    TextureStore store;
    TextureSpec spec;
    spec.bytes = bytes;
    EXPECT_EQ(look(store.add(spec)), 0);
    ASSERT_EQ(store.errors().all().size(), 1u) << size;
    EXPECT_EQ(store.errors().all()[0].message.find("cannot read image \"model.glb: /images/3\": "), 0u);
  }
}

TEST(TextureStore, channels_of_a_picture_share_what_is_decoded) {
  // One pixel: red 51, green 102, blue 204 of 255; decoded by sRGB's curve where gamma asks.
  const std::string path = fmt::format("{}/whit_store_channels.tga", test::temp_folder());
  std::string tga(18, '\0');
  tga[2] = 2, tga[12] = 1, tga[14] = 1, tga[16] = 32, tga[17] = 8;
  std::ofstream(path, std::ios::binary) << tga << "\xcc\x66\x33\x99";
  for (const bool gamma : {false, true}) {
    TextureStore store;
    const auto value = [&](TextureChannel channel) {
      TextureSpec spec = spec_of(path, TextureKind::Float);
      spec.channel = channel, spec.gamma = gamma;
      const float s = 0.5f, t = 0.5f;
      float out = -1;
      store.add(spec)->lookup_float(1, &s, &t, nullptr, nullptr, nullptr, nullptr, &out);
      return out;
    };
    const auto expected = [&](float v) { return gamma ? srgb_decode(v) : v; };
    EXPECT_EQ(value(TextureChannel::Red), expected(51 / 255.0f));
    EXPECT_EQ(value(TextureChannel::Green), expected(102 / 255.0f));
    EXPECT_EQ(value(TextureChannel::Blue), expected(204 / 255.0f));
    EXPECT_EQ(store.statistics().decodes, 1);
    EXPECT_EQ(value(TextureChannel::Alpha), 153 / 255.0f);  // never decoded
    EXPECT_EQ(store.statistics().decodes, 2);
  }
}

}  // namespace
}  // namespace whit
