// Lights: batches of points ask a light for directions, radiance and densities; escaped rays ask for radiance.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/batch/arena.h"
#include "core/plugin/light_reach.h"
#include "core/plugin/param.h"

namespace whit {

/// One sample of one light for each of n points, structure of arrays, render space.
struct LightSamples {
  int n = 0;
  // In.
  Arena* arena = nullptr;                  ///< Scratch.
  Vec3Lanes p;                             ///< Reference points.
  const float *u = nullptr, *v = nullptr;  ///< Uniform numbers in [0,1); null for a delta light.
  // Out.
  Vec3Lanes wi;               ///< Unit direction from p towards the light.
  float* distance = nullptr;  ///< Along wi to the sampled point; infinity for lights at infinity.
  RGBLanes radiance;          ///< Incident radiance divided by pdf; 0 where the light does not reach p.
  Vec3Lanes q;                ///< Unless null: the sampled points. Of emitting triangles only.
  float* pdf = nullptr;       ///< Unless null: per solid angle at p; 0 where there is no radiance.
};

/// What a ray has met that may emit; render space.
struct LightHit {
  Vec3f o, d;   ///< The ray; d is a unit vector.
  float t = 0;  ///< How far along it.
  Vec3f p, ng;  ///< The point and the unit normal there, which points to the front.
};

/// How the light is chosen that is sampled at a point where only one is.
enum class LightStrategy : uint8_t {
  Spatial,  ///< By how much may arrive at the point.
  Uniform,  ///< All alike.
  Power,    ///< In proportion to their power.
};

/// How much a colour counts where light is shared out: its luminance, in double because floats could overflow; of
/// magnitudes, because colours out of gamut have negative parts.
inline double strength_of(const RGB& c) {
  const auto part = [](float x) { return std::abs(static_cast<double>(x)); };
  return 0.212671 * part(c.x) + 0.715160 * part(c.y) + 0.072169 * part(c.z);
}

class Light : public Plugin {
 public:
  static constexpr const char* kCategory = "light";
  /// Light-to-world, set by the builder before prepare().
  Mat4d light_to_world;
  std::string group;  ///< "lightgroup".

  /// By what it says below: which lights go when --without switches a kind of them off.
  EffectSet effects() const override {
    if (is_environment()) return {Effect::EnvironmentLights};
    return {is_delta() ? Effect::DeltaLights : Effect::AreaLights};
  }

  /// Delta lights need no random numbers.
  virtual bool is_delta() const { return false; }
  virtual void sample(const LightSamples& s) const = 0;

  /// Lights at infinity are seen by rays that leave the scene.
  virtual bool is_environment() const { return false; }
  /// Surfaces that emit are seen by rays that meet them: the radiance that goes back along the ray.
  virtual RGB emitted(const LightHit&) const { return RGB(0.0f); }
  /// Unless null, what these are to be multiplied by, at the point of the surface.
  virtual const Tex<RGB>* emission_map() const { return nullptr; }
  /// Whether such a surface has two fronts.
  virtual bool is_two_sided() const { return false; }
  /// Adds the radiance arriving along n escaped rays (origin o, unit direction d, render space) to out. Unless null,
  /// `pdf` becomes that of the directions, as below.
  virtual void add_escaped(int /*n*/, const Vec3Lanes& /*o*/, const Vec3Lanes& /*d*/, const RGBLanes& /*out*/,
                           float* /*pdf*/) const {}
  /// Density (solid angle) with which sample() would choose unit direction d from point p: for tests and
  /// multiple importance sampling. 0 for delta lights.
  virtual float pdf(const Vec3f& /*p*/, const Vec3f& /*d*/) const { return 0; }
  /// The same from a ray's origin for the direction in which it met the light's surface.
  virtual float pdf(const LightHit& hit) const { return pdf(hit.o, hit.d); }
  /// How often the scene wants it sampled at each point, by integrators that sample all lights (pbrt's "samples").
  virtual int sample_count() const { return 1; }
  /// Where sample() finds light. Asked after prepare(); the default rules nothing out.
  virtual LightReach reach() const { return {}; }
  /// The point of render space from which all its light comes, if there is one. Asked after prepare().
  virtual std::optional<Vec3d> position() const { return {}; }
  /// About how much light it sends into a scene of that radius, as pbrt-v3 has it: the luminance of radiance times solid
  /// angle times area, lengths as in render space. Asked after prepare(), and only where lights are chosen by it; may
  /// read pictures.
  virtual double power(double scene_radius) const = 0;
  /// The group in whose layer its light is, where AOVs ask for groups; "" for none.
  virtual const std::string& light_group() const { return group; }
  /// True when the light gives nothing anywhere (power 0), so that the plan drops it.
  virtual bool is_black() const { return false; }
};

/// The emission of a surface (AreaLightSource): what the shape it sits on radiates. Where to sample is the
/// shape's business.
class AreaLight : public Plugin {
 public:
  static constexpr const char* kCategory = "area light";
  std::string group;  ///< "lightgroup".
  /// Emitted radiance, the same in every direction of the emitting side(s).
  virtual RGB radiance() const = 0;
  /// Unless null, by what it is to be multiplied at each point of the surface.
  virtual const Tex<RGB>* map() const { return nullptr; }
  /// Whether other surfaces look for its light. Else it is only seen.
  virtual bool lights() const { return true; }
  virtual bool two_sided() const = 0;
  /// As Light::sample_count().
  virtual int sample_count() const { return 1; }
};

/// The parameter that all lights have.
template <class AnyLight = Light>
auto lightgroup_param() {
  return param(&AnyLight::group, "lightgroup", "", Unit::None,
               "Name of the group in whose layer its light is, with --aov lightgroups; by default in none.");
}

}  // namespace whit
