// A (0,2)-sequence of its own in every pixel, for the film position as for every other pair of dimensions, with nested
// uniform (Owen) scrambling, which converges faster on smooth integrands than pbrt-v3's random flips of bits. Source:
// Kollig and Keller, Efficient Multidimensional Sampling, 2002; Burley, JCGT 9(4), 2020.

#include "core/plugin/registry.h"
#include "plugins/shared/sobol_sampler.h"

namespace whit {
namespace {

class ZeroTwoSequence final : public SobolSampler {
 public:
  int dimensions = 4;  ///< pbrt's; here no dimension is worse than another.
};

const Register<ZeroTwoSequence> zero_two{
    std::vector<std::string>{"lowdiscrepancy"}, "02sequence",
    "Scrambled (0,2)-sequences: every pixel and pair of dimensions evenly covered.",
    pixelsamples_param("Samples per pixel."),
    param(&ZeroTwoSequence::dimensions, "dimensions", 4, Unit::None,
          "Accepted for pbrt's sake; every dimension is as good as the first.")};

}  // namespace
}  // namespace whit
