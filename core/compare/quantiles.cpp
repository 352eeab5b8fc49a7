#include "core/compare/quantiles.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace whit {

double chi_square_quantile(double freedom, double p) {
  return boost::math::quantile(boost::math::chi_squared(freedom), p);
}

double student_t_quantile(double freedom, double p) {
  return boost::math::quantile(boost::math::students_t(freedom), p);
}

double normal_quantile(double p) { return boost::math::quantile(boost::math::normal(), p); }

double student_t_tails(double freedom, double t) {
  if (std::isinf(t)) return 0;
  return 2 * boost::math::cdf(boost::math::complement(boost::math::students_t(freedom), std::abs(t)));
}

double f_tail(double freedom_above, double freedom_below, double ratio) {
  if (std::isinf(ratio)) return 0;
  return boost::math::cdf(boost::math::complement(boost::math::fisher_f(freedom_above, freedom_below), ratio));
}

}  // namespace whit
