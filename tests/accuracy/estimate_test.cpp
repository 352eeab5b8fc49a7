#include "core/accuracy/estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/compare/quantiles.h"

namespace whit {
namespace {

constexpr int kTrials = 2000;

// Pictures of n numbers whose errors are normal with variance 1, and a reference of two halves with variance 2 `noise`
// each, so that it has `noise` itself. All have in common an error of `bias`. The truth is then 1 + bias^2.
struct GaussianScene {
  int n = 300;
  int replicates = 8;
  double noise = 1.0 / 16;
  double bias = 0;
};

struct Measured {
  std::vector<double> mse;
  ErrorProducts products;
  ReferenceNoise reference;
};

Measured measure(const GaussianScene& scene, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const auto r_count = static_cast<size_t>(scene.replicates);
  Measured m{std::vector<double>(r_count), {scene.replicates, std::vector<double>(r_count * r_count)}, {}};
  std::vector<double> error(r_count);
  for (int i = 0; i < scene.n; ++i) {
    const double a = std::sqrt(2 * scene.noise) * normal(random), b = std::sqrt(2 * scene.noise) * normal(random);
    m.reference.mse += (a - b) * (a - b) / 4 / scene.n;
    for (double& e : error) e = scene.bias + normal(random) - (a + b) / 2;
    for (size_t r = 0; r < r_count; ++r)
      for (size_t s = 0; s < r_count; ++s) m.products.products[r * r_count + s] += error[r] * error[s] / scene.n;
  }
  for (size_t r = 0; r < r_count; ++r) m.mse[r] = m.products.products[r * r_count + r];
  m.reference.freedom = scene.n;  // Of a sum of so many squares of equal variance.
  return m;
}

struct Coverage {
  double interval = 0, bound = 0;
};

// How often interval and bound hold the truth. Their standard deviation over 2000 trials is 0.5 % at 95 %.
Coverage coverage_of(const GaussianScene& scene) {
  std::mt19937_64 random(1);
  const double truth = std::sqrt(1 + scene.bias * scene.bias) / 2;
  Coverage c;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Measured m = measure(scene, random);
    const ErrorEstimate e = estimate_error(m.mse, m.reference, 2, scene.bias / 2);
    c.interval += (e.nrmse.low <= truth && truth <= e.nrmse.high) / double(kTrials);
    c.bound += (truth <= e.upper95) / double(kTrials);
  }
  return c;
}

TEST(EstimateError, CoversTheTruthOfNormalErrors) {
  for (int replicates : {4, 8})
    for (double noise : {0.0, 1.0 / 16, 1.0}) {
      const Coverage c = coverage_of({.replicates = replicates, .noise = noise});
      EXPECT_GT(c.interval, 0.93) << replicates << " " << noise;
      EXPECT_LT(c.interval, 0.98) << replicates << " " << noise;
      EXPECT_GT(c.bound, 0.93) << replicates << " " << noise;
    }
}

TEST(EstimateError, CoversWhatReplicatesHaveInCommon) {
  // The mean product of bias and the reference's error is the same in all replicates: their spread does not show it.
  for (double bias : {0.5, 3.0}) EXPECT_GT(coverage_of({.bias = bias}).interval, 0.93) << bias;
}

TEST(EstimateError, IsHonestBelowTheNoiseOfTheReference) {
  std::mt19937_64 random(2);
  const GaussianScene scene{.noise = 100};
  int covered = 0, from_zero = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Measured m = measure(scene, random);
    const ErrorEstimate e = estimate_error(m.mse, m.reference, 1);
    EXPECT_GE(e.nrmse.value, 0);
    EXPECT_LE(e.nrmse.low, e.nrmse.value);
    EXPECT_LE(e.nrmse.value, e.nrmse.high);
    EXPECT_LE(e.upper95, e.nrmse.high);
    covered += e.nrmse.low <= 1 && 1 <= e.nrmse.high;
    from_zero += e.nrmse.low == 0;
  }
  EXPECT_GT(covered, 0.93 * 500);
  // 100 +- 12 (sqrt(2 * 2 * 100^2 / 300)) of noise hides 1.
  EXPECT_GT(from_zero, 0.9 * 500);
}

TEST(EstimateError, CoversTheTruthWhereFewPixelsCarryTheError) {
  // 30,000 numbers of which 1 % have errors z 3 exp(y) with normal z and y: mean square 9 exp(2), and the others 1.
  const double truth = std::sqrt(0.99 + 0.01 * 9 * std::exp(2.0));
  for (int replicates : {4, 8}) {
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    std::gamma_distribution<double> others(29700 / 2.0, 2);  // Chi-square of 29,700 degrees.
    double covered = 0, below = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      std::vector<double> mse(static_cast<size_t>(replicates));
      for (double& m : mse) {
        m = others(random);
        for (int i = 0; i < 300; ++i) {
          const double e = 3 * std::exp(normal(random)) * normal(random);
          m += e * e;
        }
        m /= 30000;
      }
      const ErrorEstimate e = estimate_error(mse, {}, 1);
      covered += (e.nrmse.low <= truth && truth <= e.nrmse.high) / double(kTrials);
      below += (truth <= e.upper95) / double(kTrials);
    }
    EXPECT_GT(covered, 0.90) << replicates;
    EXPECT_GT(below, 0.86) << replicates;
  }
}

TEST(EstimateError, IsExactWithoutSpreadOrNoise) {
  const ErrorEstimate e = estimate_error(std::vector<double>{0.25, 0.25, 0.25, 0.25}, {}, 10);
  EXPECT_NEAR(e.nrmse.value, 0.05, 1e-15);
  EXPECT_NEAR(e.nrmse.low, 0.05, 1e-15);
  EXPECT_NEAR(e.upper95, 0.05, 1e-15);
  EXPECT_EQ(estimate_error(std::vector<double>{0, 0}, {}, 10).nrmse, (Estimate{0, 0, 0}));
  // A reference without noise to speak of, known from a single degree of freedom.
  EXPECT_TRUE(std::isfinite(estimate_error(std::vector<double>{1, 1.1}, {1e-6, 1}, 1).nrmse.high));
  EXPECT_TRUE(std::isnan(estimate_error(std::vector<double>{1, NAN}, {}, 1).nrmse.value));
}

TEST(EstimateBias, CoversTheTruth) {
  for (double bias : {0.0, 0.1, 1.0}) {
    std::mt19937_64 random(4);
    int covered = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const Measured m = measure({.bias = bias}, random);
      const Estimate e = estimate_bias(m.products, m.reference, 1);
      covered += e.low <= bias && bias <= e.high;
    }
    EXPECT_GT(covered, 0.93 * kTrials) << bias;
  }
}

ErrorLevel exact_level(int samples, double nrmse) {
  return {samples, {nrmse, nrmse * 0.98, nrmse * 1.02}, nrmse * 1.016};
}

TEST(FitOrder, FindsAPower) {
  std::vector<ErrorLevel> levels;
  for (int n : {4, 16, 64, 256}) levels.push_back(exact_level(n, 0.3 * std::pow(n, -0.7)));
  const Convergence c = fit_order(levels);
  EXPECT_NEAR(c.order.value, 0.7, 1e-12);
  EXPECT_NEAR(std::exp(c.log_factor), 0.3, 1e-12);
  // Levels' logarithms have deviations of 0.0102 each; in logarithms of samples, which are log 4 apart, the squared
  // distances from the middle add up to 5 log(4)^2: 1.96 * 0.0102 / (sqrt(5) log 4) = 0.00645.
  EXPECT_NEAR(c.order.high - c.order.value, 0.00645, 2e-5);
}

TEST(FitOrder, HoldsTheSlopesThatWereSeen) {
  const std::vector<ErrorLevel> levels{exact_level(4, 1), exact_level(16, std::pow(4, -0.8)),
                                       exact_level(64, std::pow(4, -1.3))};
  const Convergence c = fit_order(levels);
  EXPECT_NEAR(c.order.value, 0.65, 1e-9);
  EXPECT_NEAR(c.order.low, 0.5, 1e-9);
  EXPECT_NEAR(c.order.high, 0.8, 1e-9);
}

TEST(FitOrder, KnowsNothingOfFewLevels) {
  EXPECT_EQ(fit_order({}).order, (Estimate{0.5, 0, 1}));
  EXPECT_EQ(fit_order(std::vector<ErrorLevel>{exact_level(4, 1)}).order, (Estimate{0.5, 0, 1}));
  // A level that is lost in the reference's noise says nothing of the slope.
  const std::vector<ErrorLevel> levels{exact_level(4, 1), exact_level(16, 0.5), {64, {0, 0, 0.4}, 0.3}};
  EXPECT_NEAR(fit_order(levels).order.value, 0.5, 1e-12);
  EXPECT_EQ(fit_order(levels).levels.size(), 3u);
}

// A scene as they are: it falls with its own order, which wanders a little from level to level, and levels are known to
// a few percent.
struct Wandering {
  std::vector<ErrorLevel> levels;
  double next = 0;  ///< Truth at four times the last level.
};

Wandering wandering_scene(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> orders(0.43, 0.84);
  const double order = orders(random), spread = 0.02;
  Wandering scene;
  double truth = 1;
  for (int n = 4; n <= 256; n *= 4) {
    const double seen = truth * std::exp(spread * normal(random));
    const double reach = std::exp(1.96 * spread), bound = std::exp(1.645 * spread);
    scene.levels.push_back({n, {seen, seen / reach, seen * reach}, seen * bound});
    truth *= std::pow(4, -order + 0.04 * normal(random));
  }
  scene.next = truth;
  return scene;
}

TEST(PredictError, CoversFourTimesTheLastLevel) {
  std::mt19937_64 random(5);
  double covered = 0, below = 0;
  std::vector<double> widths;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Wandering scene = wandering_scene(random);
    const ErrorEstimate e = *predict_error(fit_order(scene.levels), 1024);
    covered += (e.nrmse.low <= scene.next && scene.next <= e.nrmse.high) / double(kTrials);
    below += (scene.next <= e.upper95) / double(kTrials);
    widths.push_back(e.nrmse.high / e.nrmse.low);
  }
  std::nth_element(widths.begin(), widths.begin() + kTrials / 2, widths.end());
  EXPECT_GT(covered, 0.95);
  EXPECT_GT(below, 0.95);
  EXPECT_LT(widths[kTrials / 2], 2.2);
}

TEST(PredictError, SaysWhatWasMeasuredAndNothingFarAway) {
  std::vector<ErrorLevel> levels;
  for (int n : {4, 16, 64}) levels.push_back(exact_level(n, std::pow(n, -0.5)));
  const Convergence c = fit_order(levels);
  EXPECT_EQ(predict_error(c, 16)->nrmse, levels[1].nrmse);
  EXPECT_NEAR(predict_error(c, 32)->nrmse.value, std::pow(32, -0.5), 1e-12);
  EXPECT_NEAR(predict_error(c, 32)->upper95, 1.016 * std::pow(32, -0.5), 1e-12);
  EXPECT_NEAR(predict_error(c, 256)->nrmse.value, std::pow(256, -0.5), 1e-12);
  EXPECT_FALSE(predict_error(c, 257));
  EXPECT_FALSE(predict_error(c, 3));
  EXPECT_FALSE(predict_error(fit_order({}), 4));
  EXPECT_FALSE(is_extrapolated(c, 64));
  EXPECT_TRUE(is_extrapolated(c, 65));
}

TEST(SamplesFor, FindsTheLeastThatIsSure) {
  std::vector<ErrorLevel> levels;
  for (int n : {4, 16, 64}) levels.push_back(exact_level(n, std::pow(n, -0.5)));
  const Convergence c = fit_order(levels);
  // A level whose bound is the target is enough.
  const SamplesFor exact = *samples_for(c, levels[1].upper95, false);
  EXPECT_EQ(exact.samples, 16);
  EXPECT_TRUE(exact.measured);
  EXPECT_FALSE(exact.extrapolated);
  // 1.016 / sqrt(n) <= 0.2 from n = 25.8.
  const SamplesFor within = *samples_for(c, 0.2, false);
  EXPECT_EQ(within.samples, 26);
  EXPECT_FALSE(within.measured || within.extrapolated);
  EXPECT_EQ(samples_for(c, 0.2, true)->samples, 32);
  EXPECT_EQ(samples_for(c, 2, true)->samples, 4);
  // 103 without the margin of (n / 64)^0.04; with it and a slope of 0.494 at least, (n / 64)^0.454 = 1.27: 109.
  const SamplesFor beyond = *samples_for(c, 0.1, false);
  EXPECT_TRUE(beyond.extrapolated);
  EXPECT_GT(beyond.samples, 106);
  EXPECT_LT(beyond.samples, 112);
  EXPECT_EQ(samples_for(c, 0.1, true)->samples, 128);
  EXPECT_FALSE(samples_for(c, 0.05, false));
}

TEST(FitAffine, FindsALine) {
  const std::vector<double> n{4, 16, 64, 4, 16, 64}, s{1.4, 2.6, 7.4, 1.4, 2.6, 7.4};
  const AffineFit fit = fit_affine(n, s);
  EXPECT_NEAR(fit.fixed, 1, 1e-9);
  EXPECT_NEAR(fit.per_sample, 0.1, 1e-10);
  EXPECT_NEAR(fit.predict(256).value, 26.6, 1e-8);
  // Without spread, what two runs differ by is left: 1.96 * 2 %.
  EXPECT_NEAR(fit.predict(256).high, 26.6 * 1.0392, 1e-3);
}

TEST(FitAffine, NeedsNoFixedPart) {
  // The line through these meets zero at -0.2 s.
  const AffineFit fit = fit_affine(std::vector<double>{4, 16}, std::vector<double>{0.2, 1.4});
  EXPECT_EQ(fit.fixed, 0);
  EXPECT_GT(fit.per_sample, 0.2 / 4);
  EXPECT_LT(fit.per_sample, 1.4 / 16);
  // One level tells nothing of it.
  EXPECT_NEAR(fit_affine(std::vector<double>{4}, std::vector<double>{2}).per_sample, 0.5, 1e-12);
  EXPECT_EQ(fit_affine(std::vector<double>{4, 16}, std::vector<double>{2, 1}).per_sample, 0);
}

TEST(FitAffine, PredictsFourTimesAsManySamples) {
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  double covered = 0, near = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> n, s;
    for (int level : {4, 16, 64})
      for (int r = 0; r < 8; ++r) {
        n.push_back(level);
        s.push_back((1 + 0.1 * level) * (1 + 0.03 * normal(random)));
      }
    const Estimate e = fit_affine(n, s).predict(256);
    const double seen = 26.6 * (1 + 0.03 * normal(random));
    covered += (e.low <= seen && seen <= e.high) / double(kTrials);
    near += (std::abs(e.value / 26.6 - 1) < 0.05) / double(kTrials);
  }
  EXPECT_GT(covered, 0.95);
  EXPECT_GT(near, 0.99);
}

TEST(PairedDifference, IsResolvedOrNot) {
  // Mean 2, deviation 1: 2 +- t(2) / sqrt(3).
  const PairedDifference wide = *paired_difference(std::vector<double>{1, 2, 3});
  EXPECT_NEAR(wide.difference.value, 2, 1e-12);
  EXPECT_NEAR(wide.difference.high, 2 + student_t_quantile(2, 0.975) / std::sqrt(3.0), 1e-9);
  EXPECT_FALSE(wide.resolved);
  EXPECT_TRUE(paired_difference(std::vector<double>{9, 10, 11})->resolved);
  EXPECT_TRUE(paired_difference(std::vector<double>{-9, -10, -11})->resolved);
  EXPECT_FALSE(paired_difference(std::vector<double>{9}));
}

TEST(Pareto, LeavesWhatIsBeaten) {
  std::vector<CostSetting> settings(4);
  const double seconds[] = {1, 2, 2, 4}, errors[] = {0.5, 0.3, 0.6, 0.3};
  for (size_t i = 0; i < 4; ++i) {
    settings[i].cpu_seconds.value = seconds[i];
    settings[i].nrmse.value = errors[i];
  }
  mark_pareto(settings);
  EXPECT_TRUE(settings[0].pareto);
  EXPECT_TRUE(settings[1].pareto);
  EXPECT_FALSE(settings[2].pareto);
  EXPECT_FALSE(settings[3].pareto);
  // Equals do not beat each other.
  settings[3] = settings[1];
  mark_pareto(settings);
  EXPECT_TRUE(settings[1].pareto && settings[3].pareto);
}

}  // namespace
}  // namespace whit
