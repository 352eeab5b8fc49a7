#include "core/compare/shift.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace whit {
namespace {

struct Picture {
  int width = 0, height = 0;
  std::vector<float> v;
  float& at(int x, int y) { return v[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)]; }
};

Picture make(int width, int height, const std::function<double(double x, double y)>& of) {
  Picture p{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) p.v.push_back(static_cast<float>(of(x, y)));
  return p;
}

Displacement find(const Picture& out, const Picture& ref) {
  return find_displacement(out.v, ref.v, ref.width, ref.height);
}

// How much of the pixel from x to x + 1 is between a and b.
double share(double x, double a, double b) { return std::clamp(std::min(x + 1, b) - std::max(x, a), 0.0, 1.0); }

// Boxes on a slope, displaced by (dx, dy): each pixel is the mean over its area, so that displacements by parts of a pixel
// are exact.
Picture boxes(int width, int height, double dx = 0, double dy = 0) {
  return make(width, height, [=](double x, double y) {
    double v = 0.2 + 0.1 * (x - dx) / width;
    for (int i = 0; i < 12; ++i) {
      const double cx = std::fmod(0.37 + 0.618034 * i, 1.0) * width + dx,
                   cy = std::fmod(0.1 + 0.381966 * i * i, 1.0) * height + dy;
      const double rx = (0.04 + 0.015 * (i % 5)) * width, ry = (0.05 + 0.02 * (i % 4)) * height;
      const double level = std::fmod(0.17 + 0.754878 * i, 1.0);
      v += (level - v) * share(x, cx - rx, cx + rx) * share(y, cy - ry, cy + ry);
    }
    return v;
  });
}

// A uniform number in [0, 1) for each pixel and seed (a 64-bit finaliser of MurmurHash3).
double random_at(double x, double y, int seed) {
  auto h = static_cast<uint64_t>(x) * 0x9e3779b97f4a7c15u + static_cast<uint64_t>(y) * 0xc2b2ae3d27d4eb4fu +
           static_cast<uint64_t>(seed) * 0x165667b19e3779f9u;
  h ^= h >> 33, h *= 0xff51afd7ed558ccdu, h ^= h >> 33, h *= 0xc4ceb9fe1a85ec53u, h ^= h >> 33;
  return static_cast<double>(h >> 11) / 9007199254740992.0;
}

// Uniform noise of a standard deviation.
Picture noisy(Picture p, double deviation, int seed) {
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x)
      p.at(x, y) += static_cast<float>(deviation * std::sqrt(12.0) * (random_at(x, y, seed) - 0.5));
  return p;
}

Picture mapped(Picture p, const std::function<double(double)>& of) {
  for (float& v : p.v) v = static_cast<float>(of(double{v}));
  return p;
}

void expect_shift(const Picture& out, const Picture& ref, double x, double y, double within = 0.05) {
  const Displacement d = find(out, ref);
  EXPECT_TRUE(d.found);
  EXPECT_STREQ(d.words, "");
  EXPECT_NEAR(d.by.x, x, within);
  EXPECT_NEAR(d.by.y, y, within);
}

TEST(Shift, IsWhereWhatIsInTheReferenceHasGone) {
  // A box from 20 to 40 is from 23 to 43, 2 higher.
  const auto box = [](double x0, double y0) {
    return make(64, 64, [=](double x, double y) { return x >= x0 && x < x0 + 20 && y >= y0 && y < y0 + 20 ? 1 : 0; });
  };
  expect_shift(box(23, 18), box(20, 20), 3, -2, 1e-6);
}

TEST(Shift, IsFoundBetweenPixels) {
  for (const auto& [width, height] : {std::pair{96, 64}, {200, 150}, {640, 400}})
    for (const auto& [x, y] :
         {std::pair{0.5, 0.0}, {0.25, 0.0}, {0.0, -0.25}, {-0.5, 0.25}, {1.5, 0.5}, {0.75, -0.75}}) {
      SCOPED_TRACE(testing::Message() << width << " x " << height << " by " << x << ", " << y);
      expect_shift(boxes(width, height, x, y), boxes(width, height), x, y);
    }
}

TEST(Shift, IsFoundUnderNoise) {
  const Picture ref = noisy(boxes(640, 400), 0.05, 1);
  for (const auto& [x, y] : {std::pair{0.5, 0.0}, {0.0, 0.25}, {-0.25, 0.5}, {1.0, 0.0}, {12.5, -7.25}}) {
    SCOPED_TRACE(testing::Message() << "by " << x << ", " << y);
    expect_shift(noisy(boxes(640, 400, x, y), 0.05, 2), ref, x, y);
  }
}

TEST(Shift, IsFoundFarAway) {
  for (const auto& [width, height] : {std::pair{96, 80}, {200, 150}, {640, 400}})
    for (const auto& [x, y] : {std::pair{1, 0}, {0, -1}, {2, -3}, {7, 5}, {16, 0}, {-16, 16}}) {
      SCOPED_TRACE(testing::Message() << width << " x " << height << " by " << x << ", " << y);
      expect_shift(boxes(width, height, x, y), boxes(width, height), x, y);
    }
}

// All that differs is a texture of single pixels, which no smaller picture shows.
TEST(Shift, IsFoundOfNoiseItself) {
  for (const int width : {64, 700}) {
    const Picture ref = make(width, 80, [](double x, double y) { return random_at(x + 100, y + 100, 3); });
    expect_shift(make(width, 80, [](double x, double y) { return random_at(x + 99, y + 100, 3); }), ref, 1, 0);
    expect_shift(make(width, 80, [](double x, double y) { return random_at(x + 103, y + 95, 3); }), ref, -3, 5);
  }
}

// Shares of pixels that are lit, and how: even, few (fireflies), and of long tails.
TEST(Shift, IsNotMadeUpOfNoise) {
  const std::function<double(double)> kinds[] = {
      [](double u) { return u; },
      [](double u) { return u < 0.3 ? 1 : 0; },
      [](double u) { return u < 0.01 ? 100 * u : 0; },
      [](double u) { return 0.1 / (1e-4 + u); },
  };
  int found = 0;
  for (const int size : {8, 16, 32, 64, 200})
    for (const auto& kind : kinds)
      for (const bool of_something : {false, true})
        for (int pair = 0; pair < 6; ++pair) {
          const Picture scene = boxes(size, size);
          const auto render = [&](int seed) {
            Picture p = scene;
            for (int y = 0; y < size; ++y)
              for (int x = 0; x < size; ++x)
                p.at(x, y) = static_cast<float>((of_something ? double{p.at(x, y)} : 0) + kind(random_at(x, y, seed)));
            return p;
          };
          found += find(render(2 * pair + 10), render(2 * pair + 11)).found;
        }
  EXPECT_EQ(found, 0);
}

// Half a pixel of linear interpolation takes half of this noise's variance away, which must not decide.
TEST(Shift, IsNotWhatBlursNoise) {
  constexpr int kWidth = 400, kHeight = 300;
  const Picture scene = boxes(kWidth, kHeight), a = noisy(scene, 0.1, 1), b = noisy(scene, 0.1, 2);
  const auto blurred = [&](double before, double here, double after) {
    return make(kWidth, kHeight, [&, p = a](double x, double y) mutable {
      const int at = static_cast<int>(x), row = static_cast<int>(y);
      return before * double{p.at(std::max(at - 1, 0), row)} + here * double{p.at(at, row)} +
             after * double{p.at(std::min(at + 1, kWidth - 1), row)};
    });
  };
  EXPECT_FALSE(find(a, b).found);
  EXPECT_FALSE(find(blurred(0.25, 0.5, 0.25), b).found);
  EXPECT_FALSE(find(b, blurred(0.25, 0.5, 0.25)).found);
  // This one has been displaced to the left.
  expect_shift(blurred(0, 0.5, 0.5), b, -0.5, 0, 0.1);
}

TEST(Shift, IsNotAnotherBrightness) {
  const Picture slope = make(200, 100, [](double x, double) { return 0.1 + x / 200; });
  for (const Picture& ref : {boxes(200, 150), slope}) {
    for (const double factor : {1.01, 0.99, 1.1, 0.5})
      EXPECT_FALSE(find(mapped(ref, [=](double v) { return factor * v; }), ref).found);
    EXPECT_FALSE(find(mapped(ref, [](double v) { return v + 0.01; }), ref).found);
  }
  EXPECT_FALSE(find(mapped(boxes(200, 150), [](double v) { return std::pow(v, 2.2); }), boxes(200, 150)).found);
}

TEST(Shift, IsNotAPartThatHasMoved) {
  const auto shadow = [](double x0) {
    Picture p = boxes(200, 150);
    for (int y = 40; y < 80; ++y)
      for (int x = 0; x < 200; ++x) p.at(x, y) *= static_cast<float>(1 - 0.5 * share(x, x0, x0 + 60));
    return p;
  };
  EXPECT_FALSE(find(shadow(51), shadow(50)).found);
  EXPECT_FALSE(find(shadow(50.5), shadow(50)).found);
}

TEST(Shift, IsNotClaimedOfPatternsThatRepeatThemselves) {
  for (const int size : {1, 2, 3, 4, 8, 16}) {
    SCOPED_TRACE(size);
    const auto board = [=](int by) {
      return make(192, 128, [=](double x, double y) {
        return (static_cast<int>(x + 64 - by) / size + static_cast<int>(y) / size) % 2 == 0 ? 1.0 : 0.0;
      });
    };
    EXPECT_FALSE(find(board(size), board(0)).found);
    EXPECT_FALSE(find(board(1), board(0)).found);
    EXPECT_FALSE(find(noisy(board(1), 0.1, 1), noisy(board(0), 0.1, 2)).found);
  }
}

// How far along an edge nothing can tell.
TEST(Shift, IsAcrossEdgesOnly) {
  const auto edges = [](double by) {
    return make(200, 100, [=](double x, double) {
      return share(x, 30 + by, 71 + by) + 0.5 * share(x, 90 + by, 97 + by) + 0.7 * share(x, 140 + by, 168 + by);
    });
  };
  expect_shift(edges(1), edges(0), 1, 0);
  expect_shift(noisy(edges(1), 0.02, 1), noisy(edges(0), 0.02, 2), 1, 0);
  EXPECT_EQ(find(edges(3), edges(0)).by.y, 0);
}

TEST(Shift, NamesMirroredAndTurnedPictures) {
  for (const auto& size : {std::pair{64, 64}, {101, 77}, {641, 403}, {400, 400}}) {
    const int width = size.first, height = size.second;
    SCOPED_TRACE(width);
    for (const double noise : {0.0, 0.05}) {
      const Picture clean = boxes(width, height), ref = noisy(clean, noise, 1);
      const auto from = [&](const std::function<float(int x, int y)>& of) {
        return noisy(
            make(width, height, [&](double x, double y) { return of(static_cast<int>(x), static_cast<int>(y)); }),
            noise, 2);
      };
      Picture p = clean;
      const int right = width - 1, bottom = height - 1;
      EXPECT_STREQ(find(from([&](int x, int y) { return p.at(right - x, y); }), ref).words, "mirrored left to right");
      EXPECT_STREQ(find(from([&](int x, int y) { return p.at(x, bottom - y); }), ref).words, "flipped top to bottom");
      EXPECT_STREQ(find(from([&](int x, int y) { return p.at(right - x, bottom - y); }), ref).words,
                   "turned by 180 degrees");
      if (width == height) {
        EXPECT_STREQ(find(from([&](int x, int y) { return p.at(y, x); }), ref).words, "transposed");
      }
    }
  }
}

TEST(Shift, IsNotFoundWhereThereIsNothingToFind) {
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 1}, {1, 2}, {3, 3}, {5, 4}, {300, 1}, {1, 300}}) {
    SCOPED_TRACE(testing::Message() << width << " x " << height);
    const auto texture = [&, w = width, h = height](int by) {
      return make(w, h, [=](double x, double y) { return random_at(x + 10 - by, y, 1); });
    };
    EXPECT_FALSE(find(texture(0), texture(0)).found);
    EXPECT_FALSE(find(texture(1), texture(0)).found);
  }
  const Picture ref = boxes(64, 64), black = mapped(ref, [](double) { return 0; }),
                grey = mapped(ref, [](double) { return 0.5; });
  EXPECT_FALSE(find(ref, ref).found);
  for (const Picture* constant : {&black, &grey}) {
    EXPECT_FALSE(find(*constant, ref).found);
    EXPECT_FALSE(find(ref, *constant).found);
  }
  EXPECT_FALSE(find(black, grey).found);
  EXPECT_FALSE(find_displacement({}, {}, 0, 0).found);
}

TEST(Shift, BearsNumbersOfAnyKind) {
  const Picture ref = boxes(200, 150), out = boxes(200, 150, 3, -2);
  for (const double factor : {1e-20, 1e30, 3e38, -1.0}) {
    SCOPED_TRACE(factor);
    const auto scaled = [=](double v) { return factor * v; };
    expect_shift(mapped(out, scaled), mapped(ref, scaled), 3, -2);
  }
  const auto below = [](double v) { return v - 0.5; };
  expect_shift(mapped(out, below), mapped(ref, below), 3, -2);
  Picture broken = out;
  broken.at(5, 7) = NAN;
  broken.at(9, 7) = std::numeric_limits<float>::infinity();
  broken.at(90, 70) = 1e30f;
  expect_shift(broken, ref, 3, -2);
  // One highlight must not decide.
  Picture lamp = ref;
  lamp.at(50, 50) = 1e6f;
  EXPECT_FALSE(find(lamp, ref).found);
}

TEST(Shift, DoesNotDependOnThreads) {
  const Picture ref = noisy(boxes(900, 700), 0.05, 1), out = noisy(boxes(900, 700, 2.5, 1), 0.05, 2);
  const Displacement all = find(out, ref);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Displacement alone = find(out, ref);
  EXPECT_TRUE(all.found);
  EXPECT_EQ(alone.by, all.by);
}

}  // namespace
}  // namespace whit
