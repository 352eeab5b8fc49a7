// Lights at a point whose intensity depends on the direction: what spot, goniometric and projection share.
#pragma once

#include <optional>

#include "core/plugin/light.h"
#include "plugins/shared/texture_mapping.h"

namespace whit {

/// A point that sends out I * scale times a factor of the direction; what arrives falls with the square of the
/// distance. Unlike pbrt's "point", it is moved, turned and scaled by the light's whole transform.
class PointSource : public Light {
 public:
  RGB I{1.0f}, scale{1.0f};

  bool is_delta() const override { return true; }
  bool is_black() const override { return whit::is_black(I * scale); }
  void sample(const LightSamples& s) const final;
  LightReach reach() const final;
  std::optional<Vec3d> position() const final { return exact_position_; }
  double power(double scene_radius) const final;

 protected:
  /// The most lanes that factor() is called with.
  static constexpr int kBlock = 128;

  /// Puts the light at a point of light space; call from prepare(). Returns false after reporting that light_to_world
  /// cannot be inverted.
  bool place(const PrepareContext& ctx, const Vec3d& at);
  /// Says that factor() is 0 outside of a cone around a unit axis of light space; call after place(). The angle between
  /// axis and edge is at most 180 degrees.
  void limit_to_cone(const Vec3d& axis, double cosine, double sine);
  /// What the intensity is multiplied with in n directions from the light (light space, not of length 1; 0 at the light
  /// itself).
  virtual void factor(int n, const Vec3Lanes& d, const RGBLanes& out) const = 0;
  /// That summed over all directions of light space, roughly.
  virtual RGB total_factor() const = 0;

 private:
  Vec3d exact_position_{0, 0, 0};  ///< Render space.
  Vec3f position_{0, 0, 0};
  AffineMap direction_to_light_;  ///< Up to a positive factor.
  RGB intensity_{0.0f};
  float to_render_ = 1;  ///< Render lengths per world length.
  std::optional<LightCone> cone_;
};

/// The parameters that all of them have.
inline auto intensity_param() {
  return param(&PointSource::I, "I", RGB{1.0f}, Unit::Intensity, "Intensity: radiance at distance 1.");
}
inline auto intensity_scale_param() {
  return param(&PointSource::scale, "scale", RGB{1.0f}, Unit::None, "Factor of I.");
}

}  // namespace whit
