// Surfaces that radiate the same in every direction, on their front side or on both.
// Which points of the surface light a given point is the shape's business.

#include "core/plugin/light.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

class Diffuse final : public AreaLight {
 public:
  RGB L{1.0f}, scale{1.0f};
  bool twosided = false;
  int samples = 1, nsamples = 1;  ///< pbrt knows both names; "samples" goes first.

  RGB radiance() const override { return L * scale; }
  bool two_sided() const override { return twosided; }
  int sample_count() const override { return samples != 1 ? samples : nsamples; }
};

const Register<Diffuse> diffuse{
    std::vector<std::string>{"area"},
    "diffuse",
    "A surface that radiates evenly in all directions.",
    param(&Diffuse::L, "L", RGB{1.0f}, Unit::Radiance, "Emitted radiance."),
    param(&Diffuse::scale, "scale", RGB{1.0f}, Unit::None, "Factor of L."),
    param(&Diffuse::twosided, "twosided", false, Unit::None, "Radiates from the back as well."),
    param(&Diffuse::samples, "samples", 1, Unit::None,
          "How often directlighting samples it at each point; of no effect on other integrators.", {1, 1e6}),
    param(&Diffuse::nsamples, "nsamples", 1, Unit::None, "The same by its older name.", {1, 1e6}),
    lightgroup_param<AreaLight>()};

}  // namespace
}  // namespace whit
