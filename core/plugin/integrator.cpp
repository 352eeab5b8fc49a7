#include "core/plugin/integrator.h"

namespace whit {

void Integrator::check(Diagnostics& diagnostics, SourcePos) {
  if (!bounds.given) return;
  if (bounds.values.size() != 4) {
    diagnostics.error(bounds.where, "\"pixelbounds\" needs four integers: x0 x1 y0 y1");
    return;
  }
  pixel_bounds_.assign(bounds.values.begin(), bounds.values.end());
}

}  // namespace whit
