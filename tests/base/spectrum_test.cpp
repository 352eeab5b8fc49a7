#include "core/base/spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/base/cie_1931.h"
#include "tests/base/temp_folder.h"

namespace whit {
namespace {

TEST(Spectrum, TableIsTheCieObserver) {
  double y = 0;
  for (const auto& row : kCie) y += row[1];
  // The integral that pbrt-v3 prints.
  EXPECT_NEAR(y, 106.856895, 1e-4);
  EXPECT_EQ(kCie[555 - kCieFirst][1], 1);
}

TEST(Spectrum, XyzOfWhiteAndBack) {
  // D65 white is (1, 1, 1); the matrix was rounded from a slightly different white.
  const RGB white = rgb_from_xyz(0.950456, 1, 1.089058);
  EXPECT_NEAR(white.x, 1, 5e-4);
  EXPECT_NEAR(white.y, 1, 5e-4);
  EXPECT_NEAR(white.z, 1, 5e-4);
  // Round trip by the inverse matrix, ITU-R BT.709: XYZ of (0.2, 0.5, 0.7).
  const double r = 0.2, g = 0.5, b = 0.7;
  const RGB c = rgb_from_xyz(0.412453 * r + 0.357580 * g + 0.180423 * b, 0.212671 * r + 0.715160 * g + 0.072169 * b,
                             0.019334 * r + 0.119193 * g + 0.950227 * b);
  EXPECT_NEAR(c.x, r, 2e-6);
  EXPECT_NEAR(c.y, g, 2e-6);
  EXPECT_NEAR(c.z, b, 2e-6);
}

TEST(Spectrum, EqualEnergyWhite) {
  // x, y and z have the same integral, to 4e-4, so XYZ = (1, 1, 1) * 470/471, and RGB is the row sums of the matrix:
  // 1.204794, 0.948291, 0.908916.
  const std::vector<double> pairs = {300, 1, 900, 1};
  const RGB c = rgb_from_samples(pairs);
  const double k = 470.0 / 471;
  EXPECT_NEAR(c.x, 1.204794 * k, 5e-4);
  EXPECT_NEAR(c.y, 0.948291 * k, 5e-4);
  EXPECT_NEAR(c.z, 0.908916 * k, 5e-4);
}

TEST(Spectrum, SamplesAreSortedInterpolatedAndClamped) {
  const std::vector<double> ramp = {400, 0, 700, 3}, turned = {700, 3, 400, 0}, finer = {400, 0, 500, 1, 700, 3};
  EXPECT_EQ(rgb_from_samples(ramp), rgb_from_samples(turned));
  const RGB a = rgb_from_samples(ramp), b = rgb_from_samples(finer);
  EXPECT_NEAR(a.x, b.x, 1e-6);
  // One sample is that value everywhere.
  const std::vector<double> one = {550, 2}, flat = {300, 2, 900, 2};
  EXPECT_EQ(rgb_from_samples(one), rgb_from_samples(flat));
}

TEST(Spectrum, PlanckPeaksWhereWienSays) {
  const double peak = 1e9 * 2.8977721e-3 / 3000;
  EXPECT_GT(planck(peak, 3000), planck(peak * 1.001, 3000));
  EXPECT_GT(planck(peak, 3000), planck(peak * 0.999, 3000));
  // Rayleigh-Jeans: 2 c k T / l^4 at long waves; at 1 mm and 6000 K the error is h c / (2 l k T) = 0.12 %.
  const double l = 1e-3, rayleigh_jeans = 2 * 299792458.0 * 1.3806488e-23 * 6000 / (l * l * l * l);
  EXPECT_NEAR(planck(1e6, 6000) / rayleigh_jeans, 1 - 0.0012, 2e-4);
}

TEST(Spectrum, BlackbodyScalesAndReddens) {
  const RGB warm = rgb_from_blackbody(2700, 1), twice = rgb_from_blackbody(2700, 2),
            cold = rgb_from_blackbody(10000, 1);
  EXPECT_FLOAT_EQ(twice.x, 2 * warm.x);
  EXPECT_FLOAT_EQ(twice.z, 2 * warm.z);
  EXPECT_GT(warm.x / warm.z, 5);
  EXPECT_LT(cold.x / cold.z, 1);
  // At 6504 K the colour is close to D65 white: equal components within 10 %.
  const RGB day = rgb_from_blackbody(6504, 1);
  EXPECT_NEAR(day.x / day.y, 1, 0.1);
  EXPECT_NEAR(day.z / day.y, 1, 0.1);
  // Normalised to its peak, which lies in the visible, the mean is below 1 and not far.
  EXPECT_LT(luminance(day), 1);
  EXPECT_GT(luminance(day), 0.85);
}

class SpdFiles : public ::testing::Test {
 protected:
  std::string write(const std::string& text) {
    const auto path = std::filesystem::path(test::temp_folder()) / "whit_spectrum_test.spd";
    std::ofstream(path) << text;
    return path.string();
  }
};

TEST_F(SpdFiles, NumbersAndComments) {
  const SpdFile f = read_spd_file(write("# header\n400 0.5 # half\n\t700.5 +1e-1\r\n"));
  EXPECT_EQ(f.error, "");
  EXPECT_EQ(f.pairs, (std::vector<double>{400, 0.5, 700.5, 0.1}));
}

TEST_F(SpdFiles, Mistakes) {
  EXPECT_EQ(read_spd_file(write("400 0.5\n500 bright\n")).error, "line 2: expected a number");
  EXPECT_EQ(read_spd_file(write("400 0.5 500")).error, "the last wavelength has no value");
  EXPECT_EQ(read_spd_file(write("# nothing\n")).error, "holds no numbers");
  const SpdFile missing = read_spd_file("/nowhere/missing.spd");
  EXPECT_FALSE(missing.readable);
  EXPECT_EQ(missing.error, "No such file or directory");
  EXPECT_FALSE(read_spd_file("/").readable);
}

}  // namespace
}  // namespace whit
