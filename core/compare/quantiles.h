// Quantiles and tails of the distributions that error estimates follow.
#pragma once

namespace whit {

/// The value that a chi-square variable of `freedom` > 0 degrees of freedom (any real number) is below with probability
/// p in (0,1).
double chi_square_quantile(double freedom, double p);

/// The same of Student's t.
double student_t_quantile(double freedom, double p);

/// The same of the normal distribution with mean 0 and variance 1.
double normal_quantile(double p);

/// The probability that Student's t of `freedom` > 0 degrees is further from 0 than |t|.
double student_t_tails(double freedom, double t);

/// The probability that a ratio of chi-square variables, each over its degrees of freedom (any real numbers > 0), is above
/// `ratio` >= 0 (Fisher's F).
double f_tail(double freedom_above, double freedom_below, double ratio);

}  // namespace whit
