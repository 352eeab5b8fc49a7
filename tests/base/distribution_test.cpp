// Discrete distributions: exact probabilities, none lost, drawn as stated.
#include "core/base/distribution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace whit {
namespace {

std::vector<float> cdf_of(const std::vector<double>& weights) {
  std::vector<float> cdf(weights.size() + 1);
  build_cell_cdf(weights, cdf.data());
  return cdf;
}

GridDistribution grid_of(int columns, int rows, const std::vector<double>& weights) {
  GridDistribution grid(columns, rows);
  for (int row = rows; row-- > 0;)  // In any order.
    grid.set_row(row, std::span(weights).subspan(static_cast<size_t>(row * columns), static_cast<size_t>(columns)));
  grid.finish();
  return grid;
}

TEST(CellCdf, ProportionsAndEnds) {
  const auto cdf = cdf_of({1, 0, 3});
  EXPECT_EQ(cdf[0], 0);
  EXPECT_NEAR(cdf[1], 0.25, 1e-6);
  EXPECT_EQ(cdf[2], cdf[1]);
  EXPECT_EQ(cdf[3], 1);
}

TEST(CellCdf, NoPositiveCellIsLost) {
  // 1e-30 of the whole still has a number that leads to it; a trailing black cell has none.
  const auto cdf = cdf_of({1, 1e-30, 1e30, 1e-30, 0});
  for (int i = 0; i < 4; ++i) EXPECT_GE(cdf[i + 1] - cdf[i], 0x1p-24f) << i;
  EXPECT_EQ(cdf[4], 1);
  EXPECT_EQ(cdf[5], 1);
}

TEST(CellCdf, ValuesAreWholeUnits) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> weights(10007);
  for (double& w : weights) w = std::pow(uniform(random), 9);
  const auto cdf = cdf_of(weights);
  for (size_t i = 0; i < cdf.size(); ++i) {
    EXPECT_EQ(cdf[i] * 0x1p24f, std::floor(cdf[i] * 0x1p24f));
    EXPECT_GT(cdf[i], i > 0 ? cdf[i - 1] : -1);
  }
}

TEST(CellCdf, LongRowsAreTheFormulaCellByCell) {
  // One unit of 2^-24 for each of the cells so far that count, and of the rest of the units the share of the sum so far.
  for (const size_t n : {1, 127, 128, 129, 1000}) {
    std::vector<double> weights(n);
    for (size_t i = 0; i < n; ++i) weights[i] = i % 7 == 3 ? 0 : std::pow(1.01 + 0.37 * static_cast<double>(i % 11), 3);
    double sum = 0, positive = 0;
    for (const double w : weights) sum += w, positive += w > 0;
    const auto cdf = cdf_of(weights);
    double running = 0, given = 0;
    for (size_t i = 0; i < n; ++i) {
      running += weights[i], given += weights[i] > 0;
      const double units = given + std::floor((0x1p24 - positive) * (running / sum));
      EXPECT_EQ(cdf[i + 1], static_cast<float>((given == positive ? 0x1p24 : units) * 0x1p-24)) << n << ' ' << i;
    }
  }
}

TEST(CellCdf, AllBlackIsUniform) {
  const auto cdf = cdf_of({0, 0, 0, 0});
  EXPECT_NEAR(cdf[1], 0.25, 1e-6);
  EXPECT_EQ(cdf[4], 1);
}

TEST(GridDistribution, DrawsCellsAsOftenAsItSays) {
  const std::vector<double> weights{1, 2, 0, 4, 0, 0, 0, 0, 3, 0.5, 7, 0.25};
  const GridDistribution grid = grid_of(4, 3, weights);
  constexpr int kSide = 512;  // a regular grid of numbers: frequencies are exact up to the grid's coarseness
  std::vector<float> u(kSide * kSide), v(kSide * kSide), du(kSide * kSide), dv(kSide * kSide);
  std::vector<int> column(kSide * kSide), row(kSide * kSide), count(12);
  for (int i = 0; i < kSide * kSide; ++i) u[i] = (i % kSide + 0.5f) / kSide, v[i] = (i / kSide + 0.5f) / kSide;
  grid.sample(kSide * kSide, u.data(), v.data(), column.data(), row.data(), du.data(), dv.data());
  for (int i = 0; i < kSide * kSide; ++i) {
    ++count[row[i] * 4 + column[i]];
    ASSERT_GE(du[i], 0);
    ASSERT_LT(du[i], 1);
    ASSERT_GE(dv[i], 0);
    ASSERT_LT(dv[i], 1);
  }
  double total = 0;
  for (int c = 0; c < 12; ++c) {
    const double p = static_cast<double>(grid.view().probability(c % 4, c / 4));
    EXPECT_NEAR(count[c] / double(kSide * kSide), p, 2.5 / kSide) << c;
    EXPECT_NEAR(p, weights[c] / 17.75, 1e-6);
    EXPECT_EQ(p > 0, weights[c] > 0);
    total += p;
  }
  EXPECT_NEAR(total, 1, 1e-6);
}

TEST(GridDistribution, NumbersNextToOne) {
  const GridDistribution grid = grid_of(3, 2, {1, 1, 0, 1, 0, 0});
  const float last = 0x1.fffffep-1f;
  int column, row;
  float du, dv;
  grid.sample(1, &last, &last, &column, &row, &du, &dv);
  EXPECT_EQ(row, 1);
  EXPECT_EQ(column, 0);
  EXPECT_LT(du, 1);
  EXPECT_LT(dv, 1);
}

TEST(GridDistribution, ABatchIsItsLanesOneByOne) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<double> weights(64 * 33);
  for (double& w : weights) w = uniform(random);
  const GridDistribution grid = grid_of(64, 33, weights);
  constexpr int kCount = 331;
  std::vector<float> u(kCount), v(kCount), du(kCount), dv(kCount);
  std::vector<int> column(kCount), row(kCount);
  for (int i = 0; i < kCount; ++i) u[i] = uniform(random), v[i] = uniform(random);
  grid.sample(kCount, u.data(), v.data(), column.data(), row.data(), du.data(), dv.data());
  for (int i = 0; i < kCount; ++i) {
    int c, r;
    float x, y;
    grid.sample(1, &u[i], &v[i], &c, &r, &x, &y);
    EXPECT_EQ(std::tie(c, r, x, y), std::tie(column[i], row[i], du[i], dv[i]));
  }
}

}  // namespace
}  // namespace whit
