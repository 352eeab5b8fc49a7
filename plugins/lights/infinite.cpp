// Light from infinitely far away all around, constant or from a lat-long map, importance sampled by the map.
// Source: Pharr, Jakob, Humphreys, Physically Based Rendering, 3rd ed., 12.6 and 14.2.4. The map is neither flipped nor
// gamma decoded, and is read bilinearly.

#include "core/plugin/registry.h"
#include "plugins/shared/environment.h"
#include "plugins/shared/latlong_map.h"

namespace whit {
namespace {

class InfiniteLight final : public EnvironmentLight, public NeedsMemory {
 public:
  RGB L{1.0f}, scale{1.0f};
  FileName map;
  int samples = 1, nsamples = 1;  ///< pbrt knows both names; "samples" goes first.

  int sample_count() const override { return samples != 1 ? samples : nsamples; }
  bool is_black() const override { return whit::is_black(L * scale); }
  std::vector<Ineffective> ineffective() const override {
    if (samples == 1) return {};
    return {{"nsamples", "\"samples\" goes before it"}};
  }

  MemoryNeed memory_need(const MeshAttributes&) const override { return latlong_need(map.path, LatLongRule::Pbrt); }

  bool prepare(const PrepareContext& ctx) override {
    std::unique_ptr<const DirectionalRadiance> radiance;
    if (map.empty()) {
      radiance = std::make_unique<UniformRadiance>(L * scale);
    } else {
      radiance = read_latlong_map(map.path, L * scale, LatLongRule::Pbrt, ctx);
    }
    if (!radiance) return false;
    set_radiance(std::move(radiance));
    return set_infinite(ctx);
  }
};

const Register<InfiniteLight> infinite{
    std::vector<std::string>{"exinfinite"},
    "infinite",
    "Light from infinitely far away all around, constant or from a map.",
    param(&InfiniteLight::L, "L", RGB{1.0f}, Unit::Radiance, "Radiance, or factor of the map."),
    param(&InfiniteLight::scale, "scale", RGB{1.0f}, Unit::None, "Factor of L."),
    param(&InfiniteLight::map, "mapname", Unit::None,
          "Lat-long map; +z of light space is at its top. Without one, the same in all directions."),
    param(&InfiniteLight::samples, "samples", 1, Unit::None,
          "How often directlighting samples it at each point; of no effect on other integrators.", {1, 1e6}),
    param(&InfiniteLight::nsamples, "nsamples", 1, Unit::None, "The same by its older name.", {1, 1e6}),
    lightgroup_param()};

}  // namespace
}  // namespace whit
