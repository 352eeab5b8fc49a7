// Quantiles of the distributions that error estimates follow.
#pragma once

namespace whit {

/// The value that a chi-square variable of `freedom` > 0 degrees of freedom (any real number) is below with probability
/// p in (0,1).
double chi_square_quantile(double freedom, double p);

/// The same of Student's t.
double student_t_quantile(double freedom, double p);

/// The same of the normal distribution with mean 0 and variance 1.
double normal_quantile(double p);

}  // namespace whit
