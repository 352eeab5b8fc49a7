#include "core/accuracy/quantiles.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace whit {

double chi_square_quantile(double freedom, double p) {
  return boost::math::quantile(boost::math::chi_squared(freedom), p);
}

double student_t_quantile(double freedom, double p) {
  return boost::math::quantile(boost::math::students_t(freedom), p);
}

double normal_quantile(double p) { return boost::math::quantile(boost::math::normal(), p); }

}  // namespace whit
