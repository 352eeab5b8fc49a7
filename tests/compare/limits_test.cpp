#include "core/compare/limits.h"

#include <cmath>
#include <limits>

#include "tests/compare/pictures.h"

namespace whit {
namespace {

std::vector<std::string> failed(const Comparison& c) {
  std::vector<std::string> names;
  for (const Failure& f : c.failed) names.push_back(f.measure);
  return names;
}

std::string added(const std::string& text, bool below = false) {
  Limits limits;
  return add_limit(text, below, limits);
}

TEST(Limits, AreReadWithTheirMeasure) {
  Limits limits;
  EXPECT_EQ(add_limit("mse=0.25", false, limits), "");
  EXPECT_EQ(add_limit("block=inf", false, limits), "");
  EXPECT_EQ(add_limit("psnr=40", true, limits), "");
  EXPECT_EQ(limits.of["mse"], 0.25);
  EXPECT_TRUE(std::isinf(limits.of["block"]));
  EXPECT_EQ(limits.of["psnr"], 40);
}

TEST(Limits, MistakesNameTheRemedy) {
  EXPECT_EQ(added("psnr=40"), "psnr falls as pictures differ: use --fail-below");
  EXPECT_EQ(added("mse=1", true), "mse rises as pictures differ: use --fail-above");
  EXPECT_NE(added("relms=1").find("did you mean relmse?"), std::string::npos);
  EXPECT_NE(added("mse").find("needs a value, as in mse=1"), std::string::npos);
  for (const char* bad : {"mse=", "mse=nan", "mse=1x", "mse=-1"})
    EXPECT_NE(added(bad).find("must be a number that is not below 0 (inf switches it off)"), std::string::npos) << bad;
  EXPECT_NE(added("psnr=x", true).find("must be a number (-inf switches it off)"), std::string::npos);
}

TEST(Limits, NameWhatIsBeyondAndWhere) {
  // One pixel of 64 twice as bright: the mean by 1/64, which is above 1 %; the block likewise over 1.1: below 8 %.
  const PicturePlanes ref = grey(8, 8, 1);
  PicturePlanes out = ref;
  for (size_t c = 0; c < 3; ++c) at(out, c, 5, 6) = 2;
  const Comparison c = compared(out, ref);
  EXPECT_EQ(failed(c), std::vector<std::string>{"ratio"});
  EXPECT_NEAR(c.failed[0].value, 1.0 / 64, 1e-9);
  EXPECT_EQ(c.failed[0].limit, 0.01);
  Limits own;
  own.of = {{"ratio", 0.02}, {"block", 0.01}, {"max", 1}};
  const Comparison other = compared(out, ref, own);
  EXPECT_EQ(failed(other), std::vector<std::string>{"block"});
  own.of = {{"ratio", std::numeric_limits<double>::infinity()}};
  EXPECT_TRUE(compared(out, ref, own).same());
  own.hard_fail = 0.5;
  const Comparison hard = compared(out, ref, own);
  EXPECT_EQ(failed(hard), std::vector<std::string>{"hard-fail"});
  EXPECT_EQ(*hard.failed[0].at, Vec2i(5, 6));
}

TEST(Limits, ShareOfPixels) {
  const PicturePlanes ref = grey(10, 10, 1);
  PicturePlanes out = ref;
  for (int x = 0; x < 4; ++x)
    at(out, 1, x, 3) = 1 + 0.001f * static_cast<float>(x);  // Three differ, two by 2e-3 or more.
  Limits limits;
  limits.fail_pixels = 0.02;
  Comparison c = compared(out, ref, limits);
  ASSERT_EQ(failed(c), std::vector<std::string>{"fail-pixels"});
  EXPECT_EQ(c.failed[0].value, 0.03);
  EXPECT_EQ(*c.failed[0].at, Vec2i(1, 3));
  limits.pixel_error = 0.0015;
  EXPECT_TRUE(compared(out, ref, limits).same());
}

TEST(Limits, ExactIsEveryNumber) {
  PicturePlanes a = picture(4, 4, {"R", "samples"}, [](size_t, int, int) { return 1.0f; }), b = a;
  Limits exact;
  exact.exact = true;
  EXPECT_TRUE(compared(a, b, exact).same());
  at(a, 1, 2, 3) = 2;
  EXPECT_TRUE(compared(a, b).same());  // A statistic is no part of the picture.
  const Comparison c = compared(a, b, exact);
  ASSERT_EQ(failed(c), std::vector<std::string>{"exact"});
  EXPECT_EQ(c.failed[0].layer, "samples");
  EXPECT_EQ(*c.failed[0].at, Vec2i(2, 3));
}

TEST(Limits, NonFiniteFailsAlways) {
  const PicturePlanes ref = grey(8, 8, 1);
  PicturePlanes out = ref;
  at(out, 2, 4, 1) = std::nanf("");
  Limits loose;
  for (const char* measure : {"relmse_robust", "ratio", "block", "shift"}) loose.of[measure] = 1e9;
  for (const PicturePlanes& other : {ref, out}) {
    const Comparison c = compared(out, other, loose);
    ASSERT_EQ(failed(c), std::vector<std::string>{"nonfinite"});
    EXPECT_EQ(c.nonfinite[0].channel, "B");
    EXPECT_EQ(c.nonfinite[0].at, Vec2i(4, 1));
    EXPECT_EQ(c.nonfinite[0].side, Side::A);
    EXPECT_EQ(value_of(c, "mse"), 0);  // Of the other pixels.
  }
  loose.allow_nonfinite = true;
  EXPECT_TRUE(compared(out, ref, loose).same());
  loose.exact = true;
  EXPECT_TRUE(compared(out, out, loose).same());
  EXPECT_FALSE(compared(out, ref, loose).same());
}

TEST(Limits, ALimitOfNothingIsNone) {
  Limits limits;
  limits.of["flip"] = 0.01;
  const auto depth = picture(8, 8, {"Z"}, [](size_t, int, int) { return 1.0f; });
  EXPECT_EQ(compared(depth, depth, limits).cannot,
            "there is a limit of flip, and no layer of colours to measure it of");
  // The first layer with colours stands in where there is none without a name.
  const auto beauty =
      picture(16, 16, {"beauty.R", "beauty.G", "beauty.B"}, [](size_t, int x, int) { return x < 8 ? 0.1f : 0.9f; });
  EXPECT_EQ(compared(beauty, beauty, limits).cannot, "");
  EXPECT_NE(compared(beauty, beauty, limits).find("flip", "beauty"), nullptr);
}

TEST(Limits, AHardFailSeesWhatIsGone) {
  Limits limits;
  limits.hard_fail = 0.001;
  PicturePlanes a = picture(40, 40, {"Z"}, [](size_t, int, int) { return 2.0f; }), b = a;
  at(a, 0, 3, 3) = std::numeric_limits<float>::infinity();
  EXPECT_EQ(failed(compared(a, b, limits)), std::vector<std::string>{"hard-fail"});
}

TEST(Limits, ExactlyEqualHasTheSamePixels) {
  PicturePlanes a = grey(8, 8, 1), b = grey(4, 4, 1);
  b.full_width = b.full_height = 8;
  Limits exact;
  exact.exact = true;
  EXPECT_EQ(failed(compared(b, a, exact)), std::vector<std::string>{"exact"});
  EXPECT_TRUE(compared(b, a).same());
}

TEST(Limits, TheWorstIsFirst) {
  const Comparison c = compared(grey(8, 8, 2), grey(8, 8, 1));
  // relMSE 1 / 1.01 of 0.02 is 49.5 times over, the mean 1 of 0.01 a hundred times, the block 1 / 1.1 of 0.08 11.4 times, of 0.16 half as often.
  EXPECT_EQ(failed(c), (std::vector<std::string>{"ratio", "relmse_robust", "block", "channel_block"}));
  EXPECT_NEAR(times_over(c.failed[0]), 100, 1e-6);
  EXPECT_NEAR(badness(c), 100, 1e-6);
  EXPECT_EQ(verdict_text(c), "differs: the mean is off by 100 %, more than 1 %, in R; 3 more");
}

}  // namespace
}  // namespace whit
