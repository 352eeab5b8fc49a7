// Pixel filters at points where their formulas are easily worked out.
#include <gtest/gtest.h>

#include <cmath>

#include "core/plugin/filter.h"
#include "tests/plugins/make_plugin.h"

namespace whit {
namespace {

using namespace test;

Made<Filter> make_filter(const char* name, ParameterList parameters = {}) {
  Made<Filter> f = make_plugin<Filter>("filter", name, std::move(parameters));
  EXPECT_TRUE(f.silent());
  EXPECT_TRUE(f.prepare());
  return f;
}

TEST(Filters, DefaultRadii) {
  for (const auto& [name, radius] :
       {std::pair{"box", 0.5f}, {"triangle", 2.0f}, {"gaussian", 2.0f}, {"mitchell", 2.0f}, {"sinc", 4.0f}}) {
    const auto f = make_filter(name);
    EXPECT_EQ(f->x_width, radius) << name;
    EXPECT_EQ(f->y_width, radius) << name;
  }
}

TEST(Filters, Box) {
  const auto f = make_filter("box");
  EXPECT_EQ(f->evaluate(0, 0), 1);
  EXPECT_EQ(f->evaluate(-0.5f, 0.49f), 1);
}

TEST(Filters, Triangle) {
  const auto f = make_filter("triangle", {floats("xwidth", {2}), floats("ywidth", {3})});
  EXPECT_FLOAT_EQ(f->evaluate(0, 0), 6);
  EXPECT_FLOAT_EQ(f->evaluate(-0.5f, 2), 1.5f);
  EXPECT_EQ(f->evaluate(2, 0), 0);
}

TEST(Filters, Gaussian) {
  // (e^(-2 x^2) - e^-8)(e^(-2 y^2) - e^-8)
  const auto f = make_filter("gaussian");
  const double edge = std::exp(-8.0);
  EXPECT_NEAR(f->evaluate(0, 0), (1 - edge) * (1 - edge), 1e-6);
  EXPECT_NEAR(f->evaluate(-1, 0.5f), (std::exp(-2.0) - edge) * (std::exp(-0.5) - edge), 1e-7);
  EXPECT_EQ(f->evaluate(2, 0), 0);
  const auto narrow = make_filter("gaussian", {floats("alpha", {1}), floats("xwidth", {2.5}), floats("ywidth", {1.5})});
  EXPECT_NEAR(narrow->evaluate(1, 1), (std::exp(-1.0) - std::exp(-6.25)) * (std::exp(-1.0) - std::exp(-2.25)), 1e-7);
}

TEST(Filters, Mitchell) {
  // B = C = 1/3: the cubic is 8/9 at 0, 1/18 at 1 (half the radius) and 0 at 2, and it sums to 1 at integer steps.
  const auto f = make_filter("mitchell");
  EXPECT_NEAR(f->evaluate(0, 0), 64.0 / 81, 1e-6);
  EXPECT_NEAR(f->evaluate(1, 0), 8.0 / 9 / 18, 1e-6);
  EXPECT_NEAR(f->evaluate(2, 1), 0, 1e-7);
  EXPECT_LT(f->evaluate(1.5f, 0), 0);
  for (const float x : {0.0f, 0.1f, 0.37f, 0.8f}) {
    const float sum = f->evaluate(x - 2, 0) + f->evaluate(x - 1, 0) + f->evaluate(x, 0) + f->evaluate(x + 1, 0);
    EXPECT_NEAR(sum, 8.0 / 9, 1e-6);
  }
}

TEST(Filters, Sinc) {
  const auto f = make_filter("sinc");
  EXPECT_EQ(f->evaluate(0, 0), 1);
  EXPECT_NEAR(f->evaluate(1, 0), 0, 1e-7);
  const double pi = 3.14159265358979;
  EXPECT_NEAR(f->evaluate(0.5f, 0), std::sin(pi / 2) / (pi / 2) * std::sin(pi / 6) / (pi / 6), 1e-6);
  EXPECT_EQ(f->evaluate(4.01f, 0), 0);
}

TEST(Filters, AllAreSymmetric) {
  for (const char* name : {"box", "triangle", "gaussian", "mitchell", "sinc"}) {
    const auto f = make_filter(name);
    for (const float x : {0.1f, 0.3f, 0.45f}) {
      EXPECT_EQ(f->evaluate(x, 0.2f), f->evaluate(-x, 0.2f)) << name;
      EXPECT_EQ(f->evaluate(x, 0.2f), f->evaluate(0.2f, -x)) << name;
    }
  }
}

TEST(Filters, RadiiMustBePositive) {
  EXPECT_FALSE(make_plugin<Filter>("filter", "box", {floats("xwidth", {0})}).good());
  EXPECT_FALSE(make_plugin<Filter>("filter", "gaussian", {floats("alpha", {-1})}).good());
}

}  // namespace
}  // namespace whit
