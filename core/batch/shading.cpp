#include "core/batch/shading.h"

#include "core/batch/fields.h"

namespace whit {

ShadingBatch ShadingBatch::range(int first, int count) const {
  ShadingBatch out = from_lane(*this, first);
  out.n = count;
  return out;
}

}  // namespace whit
