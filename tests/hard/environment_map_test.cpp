// Case 10: maps of the whole sphere as light, at their poles and seam, as small as can be, and with texels that are no
// radiances: what a ray sees, what a sample brings and the density of that must be one story.
#include <fmt/core.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "core/plugin/light.h"
#include "tests/base/temp_folder.h"
#include "tests/channels.h"
#include "tests/hard/hard_case.h"
#include "tests/plugins/make_plugin.h"

namespace whit {
namespace {

using namespace test;

constexpr double kPi2 = 6.283185307179586;
constexpr float kInf = std::numeric_limits<float>::infinity(), kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kLast = 0x1.fffffep-1f;  // the samplers' largest number

/// A map: its texels, top row first, and the file they are in.
struct Map {
  std::string name;
  int width, height;
  std::function<RGB(int, int)> texel;
  bool grey = false;
  Mat4d light_to_world{};

  std::string file() const { return (std::filesystem::path(temp_folder()) / (name + ".pfm")).string(); }
  /// Raw floats, so that nothing is lost.
  void write() const {
    std::ofstream out(file(), std::ios::binary);
    out << (grey ? "Pf\n" : "PF\n") << width << ' ' << height << "\n-1.0\n";
    for (int y = height - 1; y >= 0; --y) {  // the format's first row is the bottom one
      for (int x = 0; x < width; ++x) {
        const RGB c = texel(x, y);
        out.write(reinterpret_cast<const char*>(&c), grey ? sizeof(float) : sizeof c);
      }
    }
  }
};

RGB rough(int x, int y) {
  const double a = std::abs(std::sin(12.9898 * x + 78.233 * y) * 43758.5453), r = a - std::floor(a);
  return RGB(static_cast<float>(0.1 + 3 * r * r), static_cast<float>(0.1 + r), static_cast<float>(0.3 + r * r));
}
std::function<RGB(int, int)> hot(int hot_x, int hot_y, float value) {
  return [=](int x, int y) { return x == hot_x && y == hot_y ? RGB(value) : RGB(0.0f); };
}
/// A rough sky in which four texels are no radiances.
RGB bad(int x, int y) {
  if (y == 2 && x == 1) return RGB(kNaN);
  if (y == 2 && x == 5) return RGB(kInf);
  if (y == 0 && x == 15) return RGB(-kInf);
  if (y == 7 && x == 0) return RGB(-1.0f);
  return rough(x, y);
}

std::vector<Map> maps() {
  const Mat4d skewed(0.9, 0.3, -0.2, 0, 0.4, -1.3, 0.1, 0, 0.2, 0.5, 0.7, 0, 3, 2, 1, 1);
  return {{"1x1", 1, 1, rough},
          {"1x2", 1, 2, rough},
          {"2x1", 2, 1, rough},
          {"grey", 16, 8, rough, true},
          {"rough", 16, 8, rough},
          {"skewed", 16, 8, rough, false, skewed},
          {"fine", 128, 64, rough},
          {"hot", 64, 32, hot(37, 9, 1000)},
          {"hot-at-the-pole", 64, 32, hot(5, 0, 1000)},
          {"hot-at-the-other-pole", 64, 32, hot(5, 31, 1000)},
          {"hot-at-the-seam", 64, 32, hot(63, 16, 1000)},
          {"hot-1e30", 64, 32, hot(37, 9, 1e30f)},
          {"1e30-among-others", 16, 8, [](int x, int y) { return x == 3 && y == 3 ? RGB(1e30f) : rough(x, y); }},
          {"1e-30", 16, 8, [](int x, int y) { return rough(x, y) * 1e-30f; }},
          {"bad", 16, 8, bad},
          {"black", 4, 2, [](int, int) { return RGB(0.0f); }}};
}

/// The infinite light of a picture.
Made<Light> light_of(const std::string& file, const Mat4d& light_to_world = {}) {
  Made<Light> light = make_plugin<Light>("light", "infinite", {text("mapname", file)});
  light->light_to_world = light_to_world;
  EXPECT_TRUE(light.prepare());
  return light;
}
Made<Light> light_of(const Map& map) {
  map.write();
  return light_of(map.file(), map.light_to_world);
}

/// The radiance from direction d.
RGB radiance(const Light& light, Vec3f d) {
  Vec3f o(0.0f);
  RGB out{0.0f};
  light.add_escaped(1, {&o.x, &o.y, &o.z}, {&d.x, &d.y, &d.z}, {&out.x, &out.y, &out.z}, nullptr);
  return out;
}

struct Samples {
  std::vector<Vec3f> wi;
  std::vector<RGB> weighted;  ///< Radiance over density.
};
Samples sample(const Light& light, const std::vector<float>& u, const std::vector<float>& v) {
  const int n = static_cast<int>(u.size());
  Triples p(n), wi(n), out(n);
  std::vector<float> distance(u.size());
  LightSamples s;
  s.n = n, s.u = u.data(), s.v = v.data();
  s.p = p.vec3(), s.wi = wi.vec3(), s.radiance = out.rgb(), s.distance = distance.data();
  light.sample(s);
  Samples all;
  for (int i = 0; i < n; ++i) all.wi.push_back(wi[i]), all.weighted.push_back(out.rgb()[i]);
  return all;
}

Vec3f direction(double theta, double phi) {
  return Vec3f(Vec3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
}

/// A map's value at a direction, in double: bilinear between the texels' centres. Columns go around, and a pole has the
/// value of its row.
Vec3d reference(const Map& map, const Vec3f& d) {
  const double phi = std::atan2(static_cast<double>(d.y), static_cast<double>(d.x));
  const double theta =
      std::atan2(std::hypot(static_cast<double>(d.x), static_cast<double>(d.y)), static_cast<double>(d.z));
  const double x = (phi < 0 ? phi + kPi2 : phi) / kPi2 * map.width - 0.5, y = theta / (kPi2 / 2) * map.height - 0.5;
  const double x0 = std::floor(x), y0 = std::floor(y);
  Vec3d sum(0.0);
  for (int k = 0; k < 4; ++k) {
    const double weight = (k & 1 ? x - x0 : 1 - x + x0) * (k & 2 ? y - y0 : 1 - y + y0);
    const int column = (static_cast<int>(x0) + (k & 1) + map.width) % map.width;
    const int row = std::clamp(static_cast<int>(y0) + (k >> 1), 0, map.height - 1);
    const RGB c = map.texel(column, row);
    for (int i = 0; i < 3; ++i) {
      const float v = c[map.grey ? 0 : i];
      if (v >= 0 && v < kInf) sum[i] += weight * static_cast<double>(v);
    }
  }
  return sum;
}

double largest_texel(const Map& map) {
  double most = 1e-38;
  for (int k = 0; k < map.width * map.height; ++k) {
    const RGB c = map.texel(k % map.width, k / map.width);
    for (int i = 0; i < 3; ++i) {
      if (c[i] < kInf) most = std::max(most, static_cast<double>(c[i]));
    }
  }
  return most;
}

/// Angles around poles, seam and the middle, at distances down to where a float cannot tell them apart.
std::vector<Vec3f> hard_directions() {
  std::vector<Vec3f> all = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {1, -0.0f, 0}, {-1, 0, 0}, {-1, -0.0f, 0}, {0, 1, 0}};
  const double half = kPi2 / 2;
  for (double e = 1; e > 1e-20; e *= 0.1) {
    for (const double phi : {0.0, 1.0, 2.5, 4.0, 6.0}) {
      all.push_back(direction(e, phi)), all.push_back(direction(half - e, phi));
    }
    for (const double theta : {0.01, 0.7, half / 2, 3.1}) {
      all.push_back(direction(theta, e)), all.push_back(direction(theta, -e));
      all.push_back(direction(theta, half + e)), all.push_back(direction(theta, half - e));
    }
  }
  return all;
}

TEST(Hard, EnvironmentMapsAreReadRight) {
  // Directions are floats: around the equator their angle is known to 6e-8, a few roundings more in whit's arithmetic, in
  // all 5e-7 of a turn: of a map of 128 columns 6e-5 of a texel, and what lies between two texels is at most the largest.
  HardCase value({10, "radiance of a map against double precision",
                  "poles, seam and u -> 1, at distances 1 to 1e-20; maps 1x1 to 128x64, grey, hot, 1e30, NaN",
                  "error in units of the brightest texel", 6e-5, ""});
  for (const Map& map : maps()) {
    if (map.name == "skewed") continue;
    const Made<Light> light = light_of(map);
    for (const Vec3f& d : hard_directions()) {
      const Vec3d expected = reference(map, d);
      const RGB seen = radiance(*light.plugin, d);
      for (int i = 0; i < 3; ++i) {
        value.see(std::abs(static_cast<double>(seen[i]) - expected[i]) / largest_texel(map),
                  fmt::format("{} direction {} {} {}", map.name, d.x, d.y, d.z));
      }
    }
  }
}

TEST(Hard, EnvironmentMapsDoNotLeakThroughTheirPoles) {
  // Everything is dark but the row at one pole: the half of the sphere at the other pole must be exactly so, for maps whose
  // sides are enlarged too (to 16 rows, each made of four at most; below zero is black).
  HardCase dark({10, "light of a map's row at a pole from the half sphere of the other one",
                 "maps of 4 to 12 rows, 64 directions down to 1e-8 from the pole", "radiance", 0, ""});
  for (const int height : {4, 8, 10, 12}) {
    for (const bool top : {true, false}) {
      const Map map{fmt::format("pole-{}-{}", height, top), height, height,
                    [=](int, int y) { return RGB(y == (top ? 0 : height - 1) ? 1000.0f : 0.0f); }};
      const Made<Light> light = light_of(map);
      for (int i = 0; i < 64; ++i) {
        const double from_pole = 0.75 * std::pow(10, -i / 8.0), theta = top ? kPi2 / 2 - from_pole : from_pole;
        const Vec3f d = direction(theta, 2.4 * i);
        dark.see(static_cast<double>(radiance(*light.plugin, d).x),
                 fmt::format("{} direction {} {} {}", map.name, d.x, d.y, d.z));
      }
      EXPECT_GT(radiance(*light.plugin, {0, 0, top ? 1.0f : -1.0f}).x, 900) << map.name;
    }
  }
}

/// Pairs of numbers: a jittered grid, and the corners and edges of the unit square.
void draw(int side, std::vector<float>& u, std::vector<float>& v) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (const float a : {0.0f, 0x1p-24f, 0.5f, kLast}) {
    for (const float b : {0.0f, 0x1p-24f, 0.5f, kLast}) u.push_back(a), v.push_back(b);
  }
  for (int i = 0; i < side * side; ++i) {
    const auto jittered = [&](int k) { return (static_cast<float>(k) + uniform(random)) / static_cast<float>(side); };
    u.push_back(std::min(kLast, jittered(i % side))), v.push_back(std::min(kLast, jittered(i / side)));
  }
}

TEST(Hard, EnvironmentSamplesBringWhatRaysSee) {
  // A sample's radiance times the density of its direction is what a ray sees there: one division and one product, three
  // roundings of 6e-8.
  HardCase same({10, "a sample's radiance x density against the radiance a ray sees there",
                 "65552 samples of each of 16 maps, the corners of the unit square among them", "relative error", 3e-7,
                 ""});
  for (const Map& map : maps()) {
    const Made<Light> light = light_of(map);
    std::vector<float> u, v;
    draw(256, u, v);
    const Samples samples = sample(*light.plugin, u, v);
    for (size_t i = 0; i < u.size(); ++i) {
      const double pdf = static_cast<double>(light->pdf({0, 0, 0}, samples.wi[i]));
      const RGB seen = radiance(*light.plugin, samples.wi[i]);
      const std::string at = fmt::format("{} u {} v {}", map.name, u[i], v[i]);
      // A direction on the edge of a black cell may round into it: then it must be black in both.
      if (!(pdf > 0)) same.see(seen == RGB(0.0f) && samples.weighted[i] == RGB(0.0f) ? 0 : INFINITY, at);
      for (int c = 0; c < 3; ++c) {
        const double reported = static_cast<double>(samples.weighted[i][c]) * pdf, exact = static_cast<double>(seen[c]);
        same.see(exact == 0 ? std::abs(reported) : std::abs(reported / exact - 1), at);
      }
    }
  }
}

/// Integrals over the sphere by the midpoint rule, with steps that are whole fractions of the maps' cells.
struct Integrals {
  double density = 0;
  Vec3d radiance{0.0};
};
Integrals integrate(const Map& map, const Light& light) {
  const int rows = std::max(512, 8 * map.height), columns = 2 * rows;
  Integrals sum;
  for (int r = 0; r < rows; ++r) {
    const double low = kPi2 / 2 * r / rows, high = kPi2 / 2 * (r + 1) / rows;
    const double solid_angle = kPi2 / columns * (std::cos(low) - std::cos(high));
    for (int c = 0; c < columns; ++c) {
      const Vec3f d = direction(0.5 * (low + high), kPi2 * (c + 0.5) / columns);
      sum.density += static_cast<double>(light.pdf({0, 0, 0}, d)) * solid_angle;
      sum.radiance += test::channels(radiance(light, d)) * solid_angle;
    }
  }
  return sum;
}

TEST(Hard, EnvironmentDensitiesAndMeans) {
  // The density is constant in cells whose edges are edges of the steps here: the sum is exact but for roundings, 1e-6;
  // under a skewed transform it is not constant and has jumps inside of steps, a part of 4 x 16 / 1024 of them, by half.
  HardCase density({10, "the integral of a map's density", "15 maps, 512 x 1024 steps", "deviation from 1", 1e-5, ""});
  HardCase skewed({10, "the integral of a map's density under a skewed transform", "512 x 1024 steps",
                   "deviation from 1", 1e-3, ""});
  // Inside a cell the radiance over the density deviates by a factor of at most 0.88, between cells by little: 262144
  // samples drawn independently have a standard deviation of 0.17 %, and stratified ones less; three of these. The
  // steps' own error is (pi / 512)^2 / 24 of the curvature: 1e-4 at most.
  HardCase mean({10, "the mean of a map's samples against the integral of its radiance", "262160 samples of 16 maps",
                 "relative error", 5e-3, ""});
  for (const Map& map : maps()) {
    const Made<Light> light = light_of(map);
    const Integrals exact = integrate(map, *light.plugin);
    (map.name == "skewed" ? skewed : density).see(std::abs(exact.density - 1), map.name);
    std::vector<float> u, v;
    draw(512, u, v);
    const Samples samples = sample(*light.plugin, u, v);
    Vec3d sum(0.0);
    for (size_t i = 16; i < u.size(); ++i) sum += test::channels(samples.weighted[i]) / (512.0 * 512.0);
    for (int c = 0; c < 3; ++c) {
      mean.see(exact.radiance[c] == 0 ? std::abs(sum[c]) : std::abs(sum[c] / exact.radiance[c] - 1), map.name);
    }
  }
}

/// A picture of 8 x 4 pixels with or without alpha, as an uncompressed TGA file.
std::string write_tga(const char* name, bool alpha) {
  const std::string path = (std::filesystem::path(temp_folder()) / name).string();
  const int bytes = alpha ? 4 : 3;
  // Type 2, origin at the top left (bit 5), 8 bits of alpha or none.
  std::vector<uint8_t> file = {0,
                               0,
                               2,
                               0,
                               0,
                               0,
                               0,
                               0,
                               0,
                               0,
                               0,
                               0,
                               8,
                               0,
                               4,
                               0,
                               static_cast<uint8_t>(8 * bytes),
                               static_cast<uint8_t>(alpha ? 0x28 : 0x20)};
  for (int i = 0; i < 8 * 4; ++i) {
    for (const int c : {7 * i, 255 - 5 * i, 3 * i + 20}) file.push_back(static_cast<uint8_t>(c));
    if (alpha) file.push_back(static_cast<uint8_t>(i % 3 == 0 ? 0 : 8 * i));
  }
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
  return path;
}

TEST(Hard, EnvironmentMapsWithAlphaOrBadTexels) {
  // Alpha says nothing about light: the same radiance with it as without. A texel that is no radiance is black, and said:
  // the same as when the file says 0.
  HardCase same({10, "maps with alpha, and with NaN and infinite texels, against those without",
                 "two maps, 4000 directions", "largest difference of radiance or density", 0, ""});
  const Map with_bad{"bad", 16, 8, bad};
  const Map without{"good", 16, 8, [](int x, int y) {
                      const RGB c = bad(x, y);
                      return c.x >= 0 && c.x < kInf ? c : RGB(0.0f);
                    }};
  const Made<Light> alpha = light_of(write_tga("alpha.tga", true)), opaque = light_of(write_tga("opaque.tga", false));
  const Made<Light> warned = light_of(with_bad), silent = light_of(without);
  ASSERT_EQ(warned.diagnostics.all().size(), 1u);
  EXPECT_NE(warned.diagnostics.all()[0].message.find("12 numbers"), std::string::npos);
  EXPECT_TRUE(silent.silent() && alpha.silent() && opaque.silent());
  for (int i = 0; i < 4000; ++i) {
    const Vec3f d = direction(std::acos(1 - 2 * (i + 0.5) / 4000), 2.399963 * i);
    const auto difference = [&](const Light& a, const Light& b) {
      return test::channels(radiance(a, d) - radiance(b, d)).length() +
             std::abs(static_cast<double>(a.pdf({0, 0, 0}, d)) - static_cast<double>(b.pdf({0, 0, 0}, d)));
    };
    same.see(difference(*alpha.plugin, *opaque.plugin), "alpha");
    same.see(difference(*warned.plugin, *silent.plugin), "bad texels");
  }
}

}  // namespace
}  // namespace whit
