// What can be said of errors and times from a few measurements, with intervals that hold. Plain numbers: no pictures.
//
// Intervals are of 95 %, bounds one-sided of 95 %. Squared errors are means over pixels and channels of linear values;
// "nRMSE" is their root, divided by the mean radiance. docs/accuracy.md derives the formulas.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/accuracy/cost.h"

namespace whit {

/// The squared error of the reference itself, and how well it is known: it is distributed like its expectation times a
/// chi-square variable of `freedom` degrees over that. halves_noise() of core/accuracy/measures.h makes it.
struct ReferenceNoise {
  double mse = 0;
  double freedom = 1e9;
};

/// An nRMSE with its interval and the bound that it is below with 95 %.
struct ErrorEstimate {
  Estimate nrmse;
  double upper95 = 0;
};

/// The nRMSE expected of one picture, from the squared errors of at least two independent ones against one reference.
/// The reference's noise is subtracted; what is not above it is reported as 0 or more, with a low of 0. `bias` is the
/// nRMSE that the pictures have in common (estimate_bias()), 0 where they have the reference's own limit: how it falls
/// together with the reference's noise is the same for all of them, so that their spread does not show it.
ErrorEstimate estimate_error(std::span<const double> replicate_mse, const ReferenceNoise& reference,
                             double mean_radiance, double bias = 0);

/// Mean products of errors of replicates: products[r * replicates + s] = mean((x_r - ref) (x_s - ref)), as
/// error_products() makes it.
struct ErrorProducts {
  int replicates = 0;
  std::vector<double> products;
};

/// The nRMSE of what the replicates have in common, which more of the same samples do not take away: the bias of a
/// setting against a reference, or, of differences paired by seed (`reference` is then none), of one setting against
/// another. At least three replicates.
Estimate estimate_bias(const ErrorProducts& errors, const ReferenceNoise& reference, double mean_radiance);

/// A level that was measured.
struct ErrorLevel {
  int samples = 0;
  Estimate nrmse;
  double upper95 = 0;
};

/// nRMSE = c * samples^-order, fitted to those levels, of rising samples, whose errors are above the reference's noise.
struct Convergence {
  std::vector<ErrorLevel> levels;  ///< All of them.
  /// With the interval of the fit and the slopes between neighbours, whichever is further. 1/2 within [0, 1] when there
  /// are less than two levels.
  Estimate order{0.5, 0, 1};
  double log_factor = 0;  ///< log c, through the middle of the levels.
};
Convergence fit_order(std::span<const ErrorLevel> levels);

/// nRMSE at a number of samples: measured, between two levels, or up to four times beyond the last, where it is
/// between the fitted slope and samples^-1/2, with a margin. Nothing is said beyond that, or below the first level.
std::optional<ErrorEstimate> predict_error(const Convergence& convergence, int samples);

/// True where predict_error() goes beyond the last level.
bool is_extrapolated(const Convergence& convergence, int samples);

/// A number of samples that leads to an error.
struct SamplesFor {
  int samples = 0;
  ErrorEstimate error;
  bool measured = false;      ///< A level.
  bool extrapolated = false;  ///< Beyond the last.
};

/// The least number of samples whose bound is not above `target` nRMSE. `powers_of_two`: between and beyond the levels
/// only powers of two times a level, for samplers whose blocks of 2^m are better than what is in between.
std::optional<SamplesFor> samples_for(const Convergence& convergence, double target, bool powers_of_two);

/// Seconds = fixed + per_sample * samples, fitted so that relative deviations count alike; neither is negative.
struct AffineFit {
  double fixed = 0, per_sample = 0;
  double spread = 0;                   ///< Relative deviation of a measurement from the line.
  double freedom = 0;                  ///< Degrees of it: measurements less parameters.
  std::array<double, 3> covariance{};  ///< Of fixed, of both, of per_sample.
  /// Seconds of one more run, with the interval that it falls into.
  Estimate predict(double samples) const;
};
AffineFit fit_affine(std::span<const double> samples, std::span<const double> seconds);

/// The mean of differences between things measured in pairs.
struct PairedDifference {
  Estimate difference;
  bool resolved = false;  ///< The interval leaves out zero.
};
/// None with less than two differences.
std::optional<PairedDifference> paired_difference(std::span<const double> differences);

/// Marks the settings for which no other is both nearer and faster in CPU seconds.
void mark_pareto(std::vector<CostSetting>& settings);

}  // namespace whit
