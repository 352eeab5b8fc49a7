// Every sample within the radii counts the same. With the default radius of half a pixel no sample is shared between
// pixels. Source: Pharr, Jakob, Humphreys, Physically Based Rendering, 3rd ed., 7.8.1.

#include "core/plugin/filter.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

class BoxFilter final : public Filter {
 public:
  float evaluate(float, float) const override { return 1; }
};

const Register<BoxFilter> box{"box", "Every sample counts the same.", xwidth_param(0.5f), ywidth_param(0.5f)};

}  // namespace
}  // namespace whit
