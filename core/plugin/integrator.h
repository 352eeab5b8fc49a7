// Integrators say what happens to light; the renderer moves the batches. They meet in core/plugin/transport.h.
#pragma once

#include <optional>

#include "core/plugin/light.h"
#include "core/plugin/param.h"

namespace whit {

class Transport;
struct Rays;

/// How many lights are chosen for a point in the place of all, where the integrator says so (docs/speed.md says why).
constexpr int kLightsOfTree = 16;

class Integrator : public Plugin {
 public:
  static constexpr const char* kCategory = "integrator";
  /// What happens to one batch of rays of the same depth. `rays` is the integrator's to change.
  virtual void shade(Rays& rays, Transport& transport) const = 0;

  /// Depths of rays at most, those of the camera counted.
  virtual int max_depth() const = 0;
  /// The effects it can simulate; the plan leaves out what else a scene calls for.
  virtual EffectSet simulates() const { return EffectSet::all() - EffectSet{Effect::Indirect}; }
  /// How many sample dimensions one bounce takes; the first `lights` of them are those of sampling every light.
  virtual int dimensions(int lights) const = 0;
  /// Whether rays after the camera's carry differentials, and whether all carry the density of their direction.
  virtual bool keeps_differentials() const { return true; }
  virtual bool keeps_densities() const { return false; }
  /// How lights are chosen, if it has some chosen for each point,
  virtual std::optional<LightStrategy> light_strategy() const { return {}; }
  /// and how many. Where the scene has no more than that, and that is more than one, all are sampled instead.
  virtual int light_choices() const { return 1; }

  IntegerList bounds;  ///< "pixelbounds".
  /// The part of the picture that rendering is restricted to: x0, x1, y0, y1 in pixels; all by default.
  const std::vector<int>& pixel_bounds() const { return pixel_bounds_; }

  void check(Diagnostics& diagnostics, SourcePos statement) override;

 private:
  std::vector<int> pixel_bounds_;
};

/// The parameter that all integrators have.
inline auto pixelbounds_param() {
  return param(&Integrator::bounds, "pixelbounds", Unit::Pixels,
               "Renders only this part, x0 x1 y0 y1; the rest is black.");
}

}  // namespace whit
