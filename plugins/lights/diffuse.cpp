// Surfaces that radiate the same in every direction, on their front side or on both, all over or as a texture says.
// Which points of the surface light a given point is the shape's business.

#include "core/plugin/light.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

class Diffuse final : public AreaLight {
 public:
  RGB L{1.0f}, scale{1.0f};
  Tex<RGB> emission_map{RGB(1.0f)};
  bool twosided = false, sampled = true;
  int samples = 1, nsamples = 1;  ///< pbrt knows both names; "samples" goes first.

  RGB radiance() const override { return emission_map.is_constant() ? L * scale * emission_map.value() : L * scale; }
  const Tex<RGB>* map() const override { return emission_map.is_constant() ? nullptr : &emission_map; }
  bool lights() const override { return sampled; }
  bool two_sided() const override { return twosided; }
  int sample_count() const override { return samples != 1 ? samples : nsamples; }
  std::vector<Ineffective> ineffective() const override {
    std::vector<Ineffective> all;
    constexpr const char* why = "\"lights\" is false: other surfaces do not look for its light";
    if (!sampled) all = {{"samples", why}, {"nsamples", why}};
    else if (samples != 1) all = {{"nsamples", "\"samples\" goes before it"}};
    return all;
  }
};

const Register<Diffuse> diffuse{
    std::vector<std::string>{"area"},
    "diffuse",
    "A surface that radiates evenly in all directions.",
    param(&Diffuse::L, "L", RGB{1.0f}, Unit::Radiance, "Emitted radiance."),
    param(&Diffuse::scale, "scale", RGB{1.0f}, Unit::None, "Factor of L."),
    param(&Diffuse::emission_map, "map", RGB{1.0f}, Unit::None,
          "Factor of L that may change over the surface. Triangles over which it is black, filtered, at 16 points are "
          "seen "
          "but not sampled: what shines there is met by chance alone."),
    param(&Diffuse::sampled, "lights", true, Unit::None,
          "Whether other surfaces look for its light. Without, it is seen, also in mirrors, and paths meet it by "
          "chance."),
    param(&Diffuse::twosided, "twosided", false, Unit::None, "Radiates from the back as well."),
    param(&Diffuse::samples, "samples", 1, Unit::None,
          "How often directlighting samples it at each point; of no effect on other integrators.", {1, 1e6}),
    param(&Diffuse::nsamples, "nsamples", 1, Unit::None, "The same by its older name.", {1, 1e6}),
    lightgroup_param<AreaLight>()};

}  // namespace
}  // namespace whit
