#include "core/accuracy/flip.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

namespace whit {
namespace {

constexpr int kWidth = 24, kHeight = 16;

template <class Of>
std::vector<float> picture(int width, int height, const Of& of) {
  std::vector<float> rgb;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) rgb.push_back(static_cast<float>(of(x, y, c)));
  return rgb;
}

double waves(int x, int y, int c) { return 0.5 + 0.4 * std::sin(0.3 * x * (c + 1) + 0.2 * y); }

// Expected values are those of the authors' program (flip-evaluator 1.6 for Python), for the same pictures made there.
struct Expected {
  double mean, centre, corner;
};

void expect_flip(const std::vector<float>& test, double ppd, const Expected& expected) {
  const Flip f = flip(picture(kWidth, kHeight, waves), test, kWidth, kHeight, ppd);
  EXPECT_NEAR(f.mean, expected.mean, 2e-4);
  EXPECT_NEAR(f.map[kHeight / 2 * kWidth + kWidth / 3], expected.centre, 1e-3);
  EXPECT_NEAR(f.map[0], expected.corner, 1e-3);
}

TEST(Flip, SeesNoise) {
  const auto noisy = picture(kWidth, kHeight, [](int x, int y, int c) {
    return waves(x, y, c) + 0.2 * std::sin(12.9898 * x + 78.233 * y + 37.719 * c);
  });
  expect_flip(noisy, 67, {0.156965, 0.128954, 0.190505});
  expect_flip(noisy, 20, {0.463988, 0.547275, 0.104303});
}

TEST(Flip, SeesDisplacement) {
  const auto shifted = picture(kWidth, kHeight, [](int x, int y, int c) { return waves(x + 1, y, c); });
  expect_flip(shifted, 67, {0.517970, 0.744428, 0.580282});
  expect_flip(shifted, 20, {0.661570, 0.958304, 0.649179});
}

TEST(Flip, SeesSinglePixels) {
  auto lamp = picture(kWidth, kHeight, waves);
  for (size_t c = 0; c < 3; ++c) {
    lamp[3 * (kHeight / 2 * kWidth + kWidth / 3) + c] = 1;
    lamp[c] = 0;
  }
  expect_flip(lamp, 67, {0.020694, 0.355679, 0.437818});
  expect_flip(lamp, 20, {0.010546, 0.977600, 0.921186});
}

TEST(Flip, SeesBrightness) {
  const auto dark = picture(kWidth, kHeight, [](int x, int y, int c) { return 0.5 * waves(x, y, c); });
  expect_flip(dark, 67, {0.852376, 0.797230, 0.789429});
}

TEST(Flip, IsZeroOfEqualsAndNotANumberOfNan) {
  auto p = picture(kWidth, kHeight, waves);
  EXPECT_EQ(flip(p, p, kWidth, kHeight).mean, 0);
  const auto ref = p;
  p[100] = NAN;
  EXPECT_TRUE(std::isnan(flip(ref, p, kWidth, kHeight).mean));
  EXPECT_EQ(flip(std::vector<float>{0, 0, 0}, std::vector<float>{0, 0, 0}, 1, 1).mean, 0);
}

TEST(Flip, TakesLessThanASecondForAMegapixel) {
  const auto a = picture(1024, 1024, waves);
  const auto b = picture(1024, 1024, [](int x, int y, int c) { return waves(x + 1, y, c); });
  const auto start = std::chrono::steady_clock::now();
  EXPECT_GT(flip(a, b, 1024, 1024).mean, 0);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  RecordProperty("seconds", std::to_string(seconds));
  EXPECT_LT(seconds, 5);  // Below one on an idle machine.
}

}  // namespace
}  // namespace whit
