// The filters against a plain double-precision version of the formulas, and the cases that break filters.
#include "core/image/mipmap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/image/picture_rows.h"
#include "core/image/scratch_file.h"

namespace whit {
namespace {

Image picture(int width, int height, int channels, SampleFormat format = SampleFormat::Float, unsigned seed = 1) {
  Image image;
  image.width = width;
  image.height = height;
  image.channels = channels;
  image.format = format;
  image.channel_names = channels == 1 ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
  std::mt19937 random(seed);
  for (int i = 0; i < width * height * channels; ++i) image.pixels.push_back(static_cast<float>(random() % 256) / 255);
  return image;
}

// The same picture as 8-bit numbers.
ByteImage bytes_of(const Image& image) {
  ByteImage bytes;
  static_cast<ImageInfo&>(bytes) = image;
  bytes.format = SampleFormat::UInt8;
  for (const float v : image.pixels) bytes.pixels.push_back(static_cast<uint8_t>(std::lround(255 * v)));
  return bytes;
}

// One channel, powers of two: the pyramid and the filters, straight from the book, in double precision.
struct Reference {
  struct Level {
    int w, h;
    std::vector<double> v;
  };
  std::vector<Level> levels;
  WrapMode wrap;

  Reference(const Image& image, WrapMode mode) : wrap(mode) {
    levels.push_back({image.width, image.height, {image.pixels.begin(), image.pixels.end()}});
    while (levels.back().w > 1 || levels.back().h > 1) {
      const int l = last();
      Level next{std::max(1, levels[l].w / 2), std::max(1, levels[l].h / 2), {}};
      for (int t = 0; t < next.h; ++t)
        for (int s = 0; s < next.w; ++s)
          next.v.push_back((texel(l, 2 * s, 2 * t) + texel(l, 2 * s + 1, 2 * t) + texel(l, 2 * s, 2 * t + 1) +
                            texel(l, 2 * s + 1, 2 * t + 1)) /
                           4);
      levels.push_back(next);
    }
  }
  int last() const { return static_cast<int>(levels.size()) - 1; }
  static int wrapped(WrapMode mode, int i, int n) {
    const auto modulo = [](int a, int b) { return ((a % b) + b) % b; };
    if (mode == WrapMode::Repeat) return modulo(i, n);
    if (mode == WrapMode::Clamp) return std::clamp(i, 0, n - 1);
    // There and back: 0 1 2 2 1 0 0 1 ...
    if (mode == WrapMode::Mirror) return modulo(i, 2 * n) < n ? modulo(i, n) : n - 1 - modulo(i, n);
    return i;
  }
  double texel(int level, int s, int t) const {
    const Level& l = levels[static_cast<size_t>(level)];
    s = wrapped(wrap_along_s(wrap), s, l.w), t = wrapped(wrap_along_t(wrap), t, l.h);
    if (s < 0 || s >= l.w || t < 0 || t >= l.h) return 0;
    return l.v[static_cast<size_t>(t * l.w + s)];
  }
  double bilinear(int level, double s, double t) const {
    s = s * levels[static_cast<size_t>(level)].w - 0.5;
    t = t * levels[static_cast<size_t>(level)].h - 0.5;
    const int x = static_cast<int>(std::floor(s)), y = static_cast<int>(std::floor(t));
    const double a = s - x, b = t - y;
    return (1 - a) * (1 - b) * texel(level, x, y) + a * (1 - b) * texel(level, x + 1, y) +
           (1 - a) * b * texel(level, x, y + 1) + a * b * texel(level, x + 1, y + 1);
  }
  double nearest(double s, double t) const {
    return texel(0, static_cast<int>(std::floor(s * levels[0].w)), static_cast<int>(std::floor(t * levels[0].h)));
  }
  double trilinear(double s, double t, double width) const {
    const double level = last() + std::log2(std::max(width, 1e-8));
    if (level < 0) return bilinear(0, s, t);
    if (level >= last()) return texel(last(), 0, 0);
    const int l = static_cast<int>(level);
    return (1 - (level - l)) * bilinear(l, s, t) + (level - l) * bilinear(l + 1, s, t);
  }
  // Weighs every texel within 64 of st, without a bounding box.
  double ewa_level(int level, double s, double t, const double (&d)[2][2]) const {
    if (level > last()) return texel(last(), 0, 0);
    const double w = levels[static_cast<size_t>(level)].w, h = levels[static_cast<size_t>(level)].h;
    s = s * w - 0.5;
    t = t * h - 0.5;
    double A = 1, B = 0, C = 1;
    for (const auto& axis : d) {
      A += axis[1] * h * axis[1] * h;
      B -= 2 * axis[0] * w * axis[1] * h;
      C += axis[0] * w * axis[0] * w;
    }
    const double F = A * C - B * B / 4;
    double sum = 0, weights = 0;
    for (int y = int(t) - 64; y <= int(t) + 64; ++y)
      for (int x = int(s) - 64; x <= int(s) + 64; ++x) {
        const double r2 = (A * (x - s) * (x - s) + B * (x - s) * (y - t) + C * (y - t) * (y - t)) / F;
        if (r2 >= 1) continue;
        const double weight = std::exp(-2 * r2) - std::exp(-2.0);
        sum += weight * texel(level, x, y);
        weights += weight;
      }
    return sum / weights;
  }
  double ewa(double s, double t, double dsdx, double dtdx, double dsdy, double dtdy, double anisotropy) const {
    double d[2][2] = {{dsdx, dtdx}, {dsdy, dtdy}};
    if (std::hypot(dsdx, dtdx) < std::hypot(dsdy, dtdy)) std::swap(d[0], d[1]);
    const double major = std::hypot(d[0][0], d[0][1]);
    double minor = std::hypot(d[1][0], d[1][1]);
    if (minor * anisotropy < major && minor > 0) {
      const double scale = major / (minor * anisotropy);
      d[1][0] *= scale, d[1][1] *= scale, minor *= scale;
    }
    if (minor == 0) return bilinear(0, s, t);
    const double lod = std::max(0.0, last() + std::log2(minor));
    const int l = static_cast<int>(std::min(lod, 100.0));
    return (1 - (lod - l)) * ewa_level(l, s, t, d) + (lod - l) * ewa_level(l + 1, s, t, d);
  }
};

// n random points; footprints from below a texel to all of the texture, of any shape.
struct Points {
  std::vector<float> s, t, dsdx, dtdx, dsdy, dtdy;
  explicit Points(int n) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(-1.3f, 2.3f), sign(-1, 1), size(-10, 1);
    for (int i = 0; i < n; ++i) {
      s.push_back(place(random));
      t.push_back(place(random));
      const float a = std::exp2(size(random)), b = std::exp2(size(random));
      dsdx.push_back(a * sign(random));
      dtdx.push_back(a * sign(random));
      dsdy.push_back(b * sign(random));
      dtdy.push_back(b * sign(random));
    }
  }
  LookupPoints view(size_t first = 0, int n = -1) const {
    return {n < 0 ? static_cast<int>(s.size()) : n,
            &s[first],
            &t[first],
            &dsdx[first],
            &dtdx[first],
            &dsdy[first],
            &dtdy[first]};
  }
};

std::vector<float> look(const MipMap& map, const LookupPoints& points, const MipFilter& filter) {
  std::vector<float> r(static_cast<size_t>(points.n)), g = r, b = r;
  float* const out[3] = {r.data(), g.data(), b.data()};
  map.lookup(points, filter, out);
  return r;
}

constexpr TextureFilter kFilters[] = {TextureFilter::Ewa, TextureFilter::Trilinear, TextureFilter::Point};
const WrapMode kWraps[] = {WrapMode::Repeat,
                           WrapMode::Black,
                           WrapMode::Clamp,
                           WrapMode::Mirror,
                           WrapMode::LatLong,
                           wrap_of(WrapMode::Clamp, WrapMode::Repeat),
                           wrap_of(WrapMode::Mirror, WrapMode::Black),
                           wrap_of(WrapMode::Black, WrapMode::Mirror)};

TEST(MipMap, pyramid_shape) {
  const MipMap map(picture(8, 2, 3), {});
  EXPECT_EQ(map.level_count(), 4);
  EXPECT_EQ(map.width(3), 1);
  EXPECT_EQ(map.height(0), 2);
  EXPECT_EQ(map.height(1), 1);
  EXPECT_EQ(map.bytes(), (16u + 4 + 2 + 1) * 3 * sizeof(float));
  EXPECT_EQ(MipMap(picture(5, 3, 3), {}).width(), 8);
}

TEST(MipMap, bilinear_by_hand) {
  // Texels 0.25, 0.5 / 1, 2; centres at 0.25 and 0.75. The middle is their mean, 0.9375.
  Image image = picture(2, 2, 1);
  image.pixels = {0.25f, 0.5f, 1, 2};
  const float s[] = {0.5f, 0.25f, 0.75f, 0.25f}, t[] = {0.5f, 0.25f, 0.25f, 0.75f};
  const LookupPoints points{4, s, t};
  EXPECT_EQ(look(MipMap(image, {.flip = false}), points, {}), (std::vector<float>{0.9375f, 0.25f, 0.5f, 1}));
  EXPECT_EQ(look(MipMap(image, {}), points, {}), (std::vector<float>{0.9375f, 1, 2, 0.25f}));  // t = 0 is below
}

TEST(MipMap, wrap_modes_by_hand) {
  // One row 1, 3. At s = 0 the two nearest texels are the first and the one before it: repeat 3 -> 2, clamp 1 -> 1,
  // black 0 -> 0.5, mirror 1 -> 1.
  Image image = picture(2, 1, 1);
  image.pixels = {1, 3};
  const float s[] = {0}, t[] = {0.5f};
  const float expected[] = {2, 0.5f, 1, 1};
  for (int i = 0; i < 4; ++i) EXPECT_EQ(look(MipMap(image, {.wrap = kWraps[i]}), {1, s, t}, {})[0], expected[i]);
}

TEST(MipMap, axes_have_wrap_modes_of_their_own) {
  // Texels 1 2 / 4 8, nearest. To the right of the square s = 1.25 is column 0 again, 1 mirrored, 1 clamped or nothing;
  // above it t = 1.25 the same of rows.
  Image image = picture(2, 2, 1);
  image.pixels = {1, 2, 4, 8};
  const WrapMode modes[] = {WrapMode::Repeat, WrapMode::Mirror, WrapMode::Clamp, WrapMode::Black};
  const int column[] = {0, 1, 1, -1};
  const float at[] = {1.25f}, inside[] = {0.25f};
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b) {
      const MipMap map(image, {.wrap = wrap_of(modes[a], modes[b]), .flip = false});
      const int x = column[a], y = column[b];
      EXPECT_EQ(look(map, {1, at, at}, {TextureFilter::Point})[0], x < 0 || y < 0 ? 0.0f : image.pixels[2 * y + x]);
      EXPECT_EQ(look(map, {1, at, inside}, {TextureFilter::Point})[0], x < 0 ? 0.0f : image.pixels[x]);
      EXPECT_EQ(look(map, {1, inside, at}, {TextureFilter::Point})[0], y < 0 ? 0.0f : image.pixels[2 * y]);
    }
  // Mirrored, the texture has the period 2 and is the same forwards and backwards, also far away.
  const MipMap map(image, {.wrap = WrapMode::Mirror, .flip = false});
  for (const float s : {0.1f, 0.4f, 0.8f}) {
    const float here[] = {s}, there[] = {-s}, far[] = {s + 4096}, back[] = {2 - s};
    const float value = look(map, {1, here, here}, {})[0];
    EXPECT_NEAR(look(map, {1, there, there}, {})[0], value, 1e-6f);
    EXPECT_NEAR(look(map, {1, back, back}, {})[0], value, 1e-5f);
    EXPECT_NEAR(look(map, {1, far, far}, {})[0], value, 1e-2f);  // floats near 4096 are 5e-4 apart, times 14 per unit
  }
}

TEST(MipMap, alpha_is_a_channel_that_gamma_leaves_alone_and_1_where_there_is_none) {
  for (const bool power_of_two : {true, false})
    for (const bool bytes : {true, false})
      for (const int channels : {1, 2, 3, 4}) {
        Image image = picture(power_of_two ? 4 : 3, 1, channels);
        image.channel_names = channels < 3 ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
        if (channels % 2 == 0) image.channel_names.push_back("A");
        // All of one value: enlarging keeps it up to rounding.
        for (size_t i = 0; i < image.pixels.size(); ++i)
          image.pixels[i] = static_cast<int>(i) % channels == channels - 1 ? 0.2f : 0.6f;
        const MipMapOptions options{.single = true, .alpha = true, .gamma = false, .scale = 3};
        const MipMap map = bytes ? MipMap(bytes_of(image), options) : MipMap(image, options);
        EXPECT_EQ(map.channels(), 1);
        const float s[] = {0.4f}, t[] = {0.5f};
        EXPECT_NEAR(look(map, {1, s, t}, {})[0], channels % 2 == 0 ? 0.6f : 3.0f, 1e-3f) << channels;
      }
}

TEST(MipMap, filters_follow_the_formulas) {
  const Points points(2000);
  for (const auto& [width, height] : {std::pair{32, 32}, {64, 8}, {4, 32}, {1, 16}, {1, 1}})
    for (const WrapMode wrap : kWraps) {
      const Image image = picture(width, height, 1);
      const MipMap map(image, {.wrap = wrap, .flip = false});
      const Reference reference(image, wrap);
      for (const float anisotropy : {8.0f, 2.0f}) {
        const auto ewa = look(map, points.view(), {TextureFilter::Ewa, anisotropy});
        const auto trilinear = look(map, points.view(), {TextureFilter::Trilinear, anisotropy});
        for (size_t i = 0; i < points.s.size(); ++i) {
          const float s = points.s[i], t = points.t[i];
          ASSERT_NEAR(ewa[i],
                      reference.ewa(s, t, points.dsdx[i], points.dtdx[i], points.dsdy[i], points.dtdy[i], anisotropy),
                      2e-5)
              << width << "x" << height << " wrap " << int(wrap) << ' ' << i;
          const float widest = std::max(
              {std::abs(points.dsdx[i]), std::abs(points.dtdx[i]), std::abs(points.dsdy[i]), std::abs(points.dtdy[i])});
          ASSERT_NEAR(trilinear[i], reference.trilinear(s, t, widest), 2e-5) << width << " " << i;
        }
      }
    }
}

TEST(MipMap, points_get_the_texel_they_are_in_whatever_the_footprint) {
  const Points points(2000);
  for (const auto& [width, height] : {std::pair{32, 32}, {64, 8}, {1, 16}})
    for (const WrapMode wrap : kWraps) {
      const Image image = picture(width, height, 1);
      const MipMap map(image, {.wrap = wrap, .flip = false});
      const Reference reference(image, wrap);
      const auto with = look(map, points.view(), {TextureFilter::Point});
      const LookupPoints without{static_cast<int>(points.s.size()), points.s.data(), points.t.data()};
      EXPECT_EQ(look(map, without, {TextureFilter::Point}), with);
      for (size_t i = 0; i < points.s.size(); ++i) {
        // Which of two texels a point is in that is within rounding of their border is not told.
        const double s = points.s[i] * static_cast<double>(width), t = points.t[i] * static_cast<double>(height);
        if (std::abs(s - std::round(s)) < 1e-4 || std::abs(t - std::round(t)) < 1e-4) continue;
        ASSERT_EQ(with[i], static_cast<float>(reference.nearest(points.s[i], points.t[i]))) << int(wrap) << ' ' << i;
      }
    }
  // It needs the finest level.
  const MipMap map(picture(32, 32, 1), {});
  const float s[] = {0.3f}, wide[] = {1.0f};
  float out;
  float* const channels[] = {&out};
  EXPECT_EQ(map.lookup({1, s, s, wide, wide, wide, wide}, {TextureFilter::Point}, channels), 0);
}

TEST(MipMap, lookup_width_is_trilinear) {
  const Image image = picture(16, 16, 1);
  const MipMap map(image, {.flip = false});
  const Reference reference(image, WrapMode::Repeat);
  const float s[] = {0.3f, 0.7f, 0.1f, 0.9f}, t[] = {0.2f, 0.6f, 0.5f, 0.1f}, width[] = {0, 0.1f, 0.5f, 2};
  float out[4];
  float* const channels[] = {out};
  map.lookup_width(4, s, t, width, channels);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(out[i], reference.trilinear(s[i], t[i], width[i]), 1e-5) << i;
}

TEST(MipMap, a_batch_of_n_is_n_batches_of_one) {
  const Points points(500);
  const Image image = picture(32, 16, 3), halves = picture(32, 16, 3, SampleFormat::Half);
  const MipMapOptions options{.gamma = true};
  for (const MipMap& map : {MipMap(image, options), MipMap(halves, options), MipMap(bytes_of(image), options)})
    for (const TextureFilter kind : kFilters) {
      const auto all = look(map, points.view(), {kind, 8});
      for (size_t i = 0; i < all.size(); ++i) ASSERT_EQ(look(map, points.view(i, 1), {kind, 8})[0], all[i]) << i;
    }
}

TEST(MipMap, compact_storage_stays_within_a_thousandth) {
  const Points points(3000);
  for (const auto& [width, height] : {std::pair{32, 32}, {30, 20}, {1, 16}})
    for (const bool single : {false, true})
      for (const WrapMode wrap : kWraps) {
        const Image floats = picture(width, height, 3);
        const MipMapOptions options{.single = single, .wrap = wrap, .gamma = true, .scale = 2.5f};
        const MipMap small(bytes_of(floats), options), large(floats, options);
        EXPECT_LT(small.bytes(), large.bytes());
        const auto a = look(small, points.view(), {}), b = look(large, points.view(), {});
        for (size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], 1e-3f * b[i]) << i;
        // Bilinear at level 0 is exact where the bytes are kept.
        if (width == 32 && !single) {
          const LookupPoints fine{100, points.s.data(), points.t.data()};
          EXPECT_EQ(look(small, fine, {}), look(large, fine, {}));
        }
      }
}

// A picture that comes row by row, in either order.
class Rows : public PictureRows {
 public:
  explicit Rows(const Image& image, bool bottom_first_ = false) : image_(image), bytes_(bytes_of(image)) {
    info = image;
    bottom_first = bottom_first_;
  }
  const uint8_t* next_bytes() override { return bytes_.pixel(0, place()); }
  const float* next_floats() override { return image_.pixel(0, place()); }
  size_t memory() const override { return 1000; }

 private:
  int place() { return bottom_first ? image_.height - 1 - y_++ : y_++; }
  const Image image_;
  const ByteImage bytes_;
  int y_ = 0;
};

TEST(MipMap, building_takes_no_more_than_announced) {
  // What the reader says, the levels from `first` on, and a few rows of the picture; where sides are no powers of two some
  // more, 24, as floats.
  for (const int side : {64, 50})
    for (const SampleFormat format : {SampleFormat::Float, SampleFormat::UInt8})
      for (const int first : {0, 2}) {
        Rows rows(picture(side, side, 3, format));
        const size_t announced = MipMap::bytes_to_build(rows, {}, first);
        const size_t levels = MipMap(rows, {}, first).bytes(), some = 4 * 3 * 64 * sizeof(float);
        const size_t more = side == 50 ? 24 * 3 * 50 * sizeof(float) : 0;
        EXPECT_GE(announced, 1000 + levels + some + more);
        EXPECT_LE(announced, 1000 + levels + 4 * some + more);
        // In a file each level begins at a multiple of 64 bytes.
        const size_t in_file = MipMap::bytes_of_levels(rows.info, {}, first);
        EXPECT_GE(in_file, levels);
        EXPECT_LE(in_file, levels + 7 * 63);
      }
}

TEST(MipMap, levels_from_the_first_on_are_those_of_the_whole) {
  const Points points(60);
  for (const auto& [width, height] : {std::pair{32, 32}, {64, 8}, {30, 20}, {1, 16}, {16, 1}})
    for (const SampleFormat format :
         {SampleFormat::UInt8, SampleFormat::UInt16, SampleFormat::Half, SampleFormat::Float})
      for (const bool flip : {false, true})
        for (const WrapMode wrap : kWraps) {
          const Image image = picture(width, height, 3, format);
          const MipMapOptions options{.wrap = wrap, .gamma = true, .scale = 2.5f, .flip = flip};
          Rows all_rows(image);
          const MipMap whole(all_rows, options);
          const MipMap outline(static_cast<const ImageInfo&>(image), options);
          EXPECT_EQ(outline.first_level(), outline.level_count());
          for (const int first : {1, 3}) {
            for (const bool bottom_first : {false, true}) {
              Rows rows(image, bottom_first);
              const MipMap part(rows, options, first), rest(whole, first);
              ASSERT_EQ(part.first_level(), first);
              EXPECT_EQ(part.bytes(), rest.bytes());
              for (size_t i = 0; i < points.s.size(); ++i) {
                float a[3], b[3], c[3];
                float *const of_part[] = {&a[0], &a[1], &a[2]}, *const of_rest[] = {&b[0], &b[1], &b[2]};
                float* const of_outline[] = {&c[0], &c[1], &c[2]};
                const int level = rest.lookup(points.view(i, 1), {}, of_rest);
                ASSERT_EQ(part.lookup(points.view(i, 1), {}, of_part), level);
                ASSERT_EQ(outline.lookup(points.view(i, 1), {}, of_outline), level);
                for (int k = 0; k < 3 && level >= first; ++k)
                  ASSERT_EQ(a[k], b[k]) << width << 'x' << height << ' ' << i;
              }
            }
          }
        }
}

TEST(MipMap, enlarging_rows_as_they_come_is_enlarging_the_whole) {
  // 16 rows are kept, and of more the last 8; what a texture that repeats needs of its last rows at its first comes last.
  const Points points(40);
  for (const int height : {1, 2, 3, 7, 15, 16, 17, 18, 23, 31, 32, 33, 47, 63, 100, 255, 257})
    for (const SampleFormat format : {SampleFormat::UInt8, SampleFormat::Float})
      for (const bool flip : {false, true})
        for (const bool bottom_first : {false, true})
          for (const WrapMode wrap : kWraps) {
            const Image image = picture(5, height, 3, format);
            const Texels enlarged = resample_to_power_of_two(make_texels(image, false, false, 1, flip), wrap);
            Image as_enlarged = image;
            as_enlarged.format = SampleFormat::Float;
            as_enlarged.width = enlarged.width, as_enlarged.height = enlarged.height;
            as_enlarged.pixels = enlarged.values;
            const MipMap whole(as_enlarged, {.wrap = wrap, .flip = false});
            Rows rows(image, bottom_first);
            const MipMap map(rows, {.wrap = wrap, .flip = flip, .floats = true});
            ASSERT_EQ(map.height(), whole.height());
            EXPECT_EQ(look(map, points.view(), {}), look(whole, points.view(), {})) << height;
            EXPECT_EQ(look(map, points.view(), {TextureFilter::Point}),
                      look(whole, points.view(), {TextureFilter::Point}))
                << height;
          }
}

TEST(MipMap, levels_in_a_file_are_those_in_memory) {
  // 5 MiB of level 0 alone, so that memory is given back in between.
  const Image image = picture(700, 600, 3, SampleFormat::Float);
  ScratchFile file;
  const Points points(200);
  for (const int first : {0, 2}) {
    Rows a(image), b(image);
    const MipMap whole(a, {}, first);
    const MipMap map(b, {}, first, file.room(MipMap::bytes_of_levels(image, {}, first)));
    EXPECT_TRUE(map.is_in_file());
    EXPECT_EQ(map.bytes(), whole.bytes());
    map.give_back();
    EXPECT_EQ(look(map, points.view(), {}), look(whole, points.view(), {}));
  }
}

TEST(MipMap, what_halves_cannot_hold_is_said_and_floats_hold_it) {
  for (const float bad : {1e5f, std::numeric_limits<float>::infinity()}) {
    Image image = picture(8, 8, 3, SampleFormat::Half);
    image.pixels[100] = bad;
    Rows first(image), second(image);
    EXPECT_THROW(MipMap(first, {}, 2), ExceedsHalves);
    const MipMap map(second, {.scale = 2, .flip = false, .floats = true});
    const float s[] = {(100 / 3 % 8 + 0.5f) / 8}, t[] = {(100 / 24 + 0.5f) / 8};
    std::vector<float> r(1), g(1), b(1);
    float* const out[3] = {r.data(), g.data(), b.data()};
    map.lookup({1, s, t}, {TextureFilter::Point}, out);
    EXPECT_EQ(g[0], 2 * bad);  // number 100 is a green one
  }
}

TEST(MipMap, without_fine_levels_coarse_lookups_are_the_same_and_fine_ones_say_so) {
  // A footprint of 2^-3 in a texture of 2^5 texels is at level 5 - 3 = 2, whatever the filter that has footprints.
  const MipMap whole(bytes_of(picture(32, 32, 3)), {}), rest(whole, 2);
  EXPECT_EQ(whole.first_level(), 0);
  EXPECT_EQ(rest.first_level(), 2);
  EXPECT_EQ(rest.width(), 32);
  EXPECT_EQ(rest.bytes(), whole.bytes() - 32 * 32 * 3 - 16 * 16 * 3 * 2);
  const float s[] = {0.3f}, t[] = {0.6f}, zero[] = {0};
  for (const TextureFilter kind : {TextureFilter::Ewa, TextureFilter::Trilinear})
    for (const auto& [footprint, level] : {std::pair{0.125f, 2}, {0.3f, 3}, {100.0f, 5}, {0.12f, 1}, {0.001f, 0}}) {
      float a[3], b[3];
      float *const of_whole[] = {&a[0], &a[1], &a[2]}, *const of_rest[] = {&b[0], &b[1], &b[2]};
      const LookupPoints point{1, s, t, &footprint, zero, zero, &footprint};
      EXPECT_EQ(whole.lookup(point, {kind, 8}, of_whole), level);
      EXPECT_EQ(rest.lookup(point, {kind, 8}, of_rest), level);
      EXPECT_EQ(whole.lookup_width(1, s, t, &footprint, of_whole), level);
      EXPECT_EQ(rest.lookup_width(1, s, t, &footprint, of_rest), level);
      for (int c = 0; c < 3 && level >= 2; ++c) EXPECT_EQ(a[c], b[c]) << footprint;
    }
}

TEST(MipMap, a_scale_cannot_overflow_halves) {
  const MipMap map(bytes_of(picture(4, 4, 1)), {.scale = 1e9f});
  const float s[] = {0.5f}, t[] = {0.5f}, d[] = {4.0f}, zero[] = {0};
  const float v = look(map, {1, s, t, d, zero, zero, d}, {})[0];
  EXPECT_GT(v, 1e8f);
  EXPECT_LT(v, 1e9f);
}

TEST(MipMap, a_constant_texture_is_constant_under_any_footprint) {
  Image image = picture(16, 4, 1);
  std::fill(image.pixels.begin(), image.pixels.end(), 0.75f);
  const Points points(1000);
  for (const WrapMode wrap : {WrapMode::Repeat, WrapMode::Clamp})
    for (const TextureFilter kind : kFilters)
      for (float v : look(MipMap(image, {.wrap = wrap}), points.view(), {kind, 8})) ASSERT_NEAR(v, 0.75f, 1e-6f);
}

TEST(MipMap, extreme_footprints_give_finite_values) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const Image image = picture(32, 16, 1);
  const float values[] = {0, 1e-40f, 1e-25f, -1e-6f, 0.01f, 3, 1e10f, 1e20f, -3e38f, inf, nan};
  for (const WrapMode wrap : kWraps) {
    const MipMap map(image, {.wrap = wrap});
    for (const MipFilter filter :
         {MipFilter{}, MipFilter{TextureFilter::Trilinear, 8}, MipFilter{TextureFilter::Ewa, 1e9f},
          MipFilter{TextureFilter::Ewa, 0}, MipFilter{TextureFilter::Point, 8}})
      for (float place : {0.5f, -7.3f, 1e6f, -1e15f, 3e38f})
        for (float a : values)
          for (float b : values)
            for (float c : {0.0f, 1e-3f, 1e12f, nan}) {
              const float v = look(map, {1, &place, &place, &a, &b, &c, &a}, filter)[0];
              ASSERT_TRUE(v >= 0 && v <= 1) << place << " " << a << " " << b << " " << c << ": " << v;
            }
  }
}

TEST(MipMap, points_that_are_not_finite_give_nan) {
  const MipMap map(picture(4, 4, 3), {});
  const float s[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 0.5f};
  const float t[] = {0.5f, 0.5f, 0.5f};
  const auto v = look(map, {3, s, t}, {});
  EXPECT_TRUE(std::isnan(v[0]));
  EXPECT_TRUE(std::isnan(v[1]));
  EXPECT_FALSE(std::isnan(v[2]));
}

TEST(MipMap, an_infinite_footprint_is_the_mean) {
  const Image image = picture(8, 8, 1);
  double mean = 0;
  for (float v : image.pixels) mean += v / 64;
  const float s[] = {0.1f}, d[] = {std::numeric_limits<float>::infinity()};
  EXPECT_NEAR(look(MipMap(image, {}), {1, s, s, d, d, d, d}, {})[0], mean, 1e-6);
}

TEST(MipMap, a_repeating_texture_far_out_is_the_same) {
  // Multiples of 2^-6 stay exact in 4096 + x, so the reduced point is the same to the bit.
  const MipMap map(picture(16, 16, 1), {});
  const float near[] = {0.328125f}, far[] = {4096.328125f};
  EXPECT_EQ(look(map, {1, near, near}, {}), look(map, {1, far, far}, {}));
}

}  // namespace
}  // namespace whit
