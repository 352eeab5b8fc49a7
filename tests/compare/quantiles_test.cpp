#include "core/compare/quantiles.h"

#include <gtest/gtest.h>

#include <cmath>

namespace whit {
namespace {

TEST(Quantiles, OfChiSquare) {
  // With two degrees of freedom the distribution is 1 - exp(-x / 2).
  EXPECT_NEAR(chi_square_quantile(2, 0.05), -2 * std::log(0.95), 1e-12);
  EXPECT_NEAR(chi_square_quantile(2, 0.99), -2 * std::log(0.01), 1e-12);
  // Of many it is nearly normal with mean n and variance 2 n; a fraction of degrees lies between its neighbours.
  EXPECT_NEAR(chi_square_quantile(1e6, 0.05), 1e6 + normal_quantile(0.05) * std::sqrt(2e6), 2);
  EXPECT_GT(chi_square_quantile(3.5, 0.05), chi_square_quantile(3, 0.05));
  EXPECT_LT(chi_square_quantile(3.5, 0.05), chi_square_quantile(4, 0.05));
}

TEST(Quantiles, OfStudentsT) {
  // One degree of freedom is Cauchy's distribution, whose quantile is tan(pi (p - 1/2)).
  EXPECT_NEAR(student_t_quantile(1, 0.975), std::tan(M_PI * 0.475), 1e-9);
  EXPECT_NEAR(student_t_quantile(1e9, 0.975), normal_quantile(0.975), 1e-6);
}

TEST(Quantiles, OfTheNormalDistribution) {
  EXPECT_DOUBLE_EQ(normal_quantile(0.5), 0);
  // Its distribution function is erfc(-x / sqrt(2)) / 2.
  EXPECT_NEAR(std::erfc(-normal_quantile(0.975) / std::sqrt(2.0)) / 2, 0.975, 1e-12);
}

}  // namespace
}  // namespace whit
