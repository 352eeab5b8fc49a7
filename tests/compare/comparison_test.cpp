// What a comparison is in words.
#include "core/compare/comparison.h"

#include <gtest/gtest.h>

#include <limits>

namespace whit {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

Failure failure(const std::string& measure, double value, double limit, const std::string& words = "") {
  return {measure, "", value, limit, "", {}, words};
}

Failure in_channel(const std::string& layer, const std::string& channel) {
  Failure f = failure("block", 0.5, 0.25);
  f.layer = layer;
  f.channel = channel;
  return f;
}

TEST(FailureText, NamesALayerOnce) {
  EXPECT_EQ(failure_text(in_channel("normal", "normal.R")), "block 0.5 is above 0.25 in normal.R");
  EXPECT_EQ(failure_text(in_channel("A", "A")), "block 0.5 is above 0.25 in A");
  EXPECT_EQ(failure_text(in_channel("normal", "")), "block 0.5 is above 0.25 in layer normal");
  EXPECT_EQ(failure_text(in_channel("normal", "normals.R")), "block 0.5 is above 0.25 in layer normal in normals.R");
  EXPECT_EQ(failure_text(in_channel("", "R")), "block 0.5 is above 0.25 in R");
}

TEST(FailureText, SaysHowAPictureIsTurned) {
  EXPECT_EQ(failure_text(failure("shift", kInfinite, 0.1, "mirrored left to right")),
            "the picture is mirrored left to right");
  EXPECT_EQ(failure_text(failure("shift", 2, 0.1, "+2.00 right, +0.00 down")),
            "shift 2 is above 0.1 (+2.00 right, +0.00 down)");
}

TEST(FailureText, CountsOne) {
  Failure f{"nonfinite", "", 1, 0, "G", Vec2i(3, 2), "nan in a.exr"};
  EXPECT_EQ(failure_text(f), "a number is NaN or infinite in G at (3, 2) (nan in a.exr)");
  f.value = 2;
  EXPECT_EQ(failure_text(f), "2 numbers are NaN or infinite, the first in G at (3, 2) (nan in a.exr)");
}

// 9.996 and 12.34567 times as bright.
TEST(FailureText, HasNoExponentsInShares) {
  EXPECT_EQ(failure_text(failure("ratio", 8.996, 0.01)), "the mean is off by 900 %, more than 1 %,");
  EXPECT_EQ(failure_text(failure("ratio", 9.996, 0.01)), "the mean is off by 1000 %, more than 1 %,");
  EXPECT_EQ(failure_text(failure("ratio", 11.34567, 0.011)), "the mean is off by 1135 %, more than 1.1 %,");
  EXPECT_EQ(failure_text(failure("fail-pixels", 0.99996, 0.5)),
            "100 % of the pixels are off, more than 50 %, the first");
}

TEST(VerdictText, CountsOne) {
  Comparison c;
  c.differing_pixels = 1;
  EXPECT_EQ(verdict_text(c), "same: a pixel differs within the limits");
  c.differing_pixels = 2;
  EXPECT_EQ(verdict_text(c), "same: 2 pixels differ within the limits");
}

}  // namespace
}  // namespace whit
