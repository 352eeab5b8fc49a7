// Lights that surround the scene, infinitely far away or on a finite sphere: what infinite and skybox share.
#pragma once

#include <memory>

#include "core/plugin/light.h"

namespace whit {

/// Radiance as a function of direction, with a way to draw directions where there is much of it. Directions are unit
/// vectors in light space, +z the zenith of lat-long maps.
class DirectionalRadiance {
 public:
  virtual ~DirectionalRadiance() = default;
  /// The radiance from n directions, and, unless null, the density (per steradian) with which sample() draws them.
  /// The density is positive wherever the radiance is not black.
  virtual void evaluate(int n, const Vec3Lanes& d, const RGBLanes& radiance, float* pdf) const = 0;
  /// n directions for uniform numbers in [0,1).
  virtual void sample(int n, const float* u, const float* v, const Vec3Lanes& d) const = 0;
  /// How much it is on average over all directions (see strength_of()).
  virtual double mean() const = 0;
};

/// The same radiance from everywhere, sampled uniformly.
class UniformRadiance final : public DirectionalRadiance {
 public:
  explicit UniformRadiance(const RGB& radiance) : radiance_(radiance) {}
  void evaluate(int n, const Vec3Lanes& d, const RGBLanes& radiance, float* pdf) const override;
  void sample(int n, const float* u, const float* v, const Vec3Lanes& d) const override;
  double mean() const override { return strength_of(radiance_); }

 private:
  RGB radiance_;
};

/// A light all around. Infinitely far away, its radiance depends on the direction of a ray alone. On a sphere (seen
/// from inside, see set_sphere()) it is that of the direction from the centre to the farther of the two points where
/// the ray's line meets the sphere, if that point is ahead: from inside always, from outside through the whole sphere
/// where the ray meets it at all, and black elsewhere.
///
/// Directions are drawn by what is seen from the centre; on a sphere, from points off its centre, a part of them
/// evenly, because near the wall a small part of the sphere fills half of the view.
///
/// Radiance and density reported by sample(), add_escaped() and pdf() come from one function of point and direction,
/// so they agree to the bit. Any light_to_world that can be inverted is allowed; densities carry its Jacobian.
class EnvironmentLight : public Light {
 public:
  bool is_environment() const override { return true; }

  void sample(const LightSamples& s) const override;
  void add_escaped(int n, const Vec3Lanes& o, const Vec3Lanes& d, const RGBLanes& out, float* pdf) const override;
  float pdf(const Vec3f& p, const Vec3f& d) const override;
  double power(double scene_radius) const override;

 protected:
  /// Sets what is seen; call from prepare().
  void set_radiance(std::unique_ptr<const DirectionalRadiance> radiance) { radiance_ = std::move(radiance); }
  /// Puts the light at infinity. Returns false after reporting that light_to_world cannot be inverted.
  bool set_infinite(const PrepareContext& ctx) { return set_frame(ctx, {0, 0, 0}, 1, false); }
  /// Puts the light on a sphere of light space, radius > 0. Returns false as set_infinite() does.
  bool set_sphere(const PrepareContext& ctx, const Vec3d& center, double radius) {
    return set_frame(ctx, center, radius, true);
  }

 private:
  struct Block;  // Scratch of a run of lanes.

  /// A linear map, by the images of the axes. (Not as an array: that would keep loops over lanes from vectorising.)
  struct Linear {
    Vec3f x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    Vec3f operator()(const Vec3f& v) const {
      return {v.x * x.x + v.y * y.x + v.z * z.x, v.x * x.y + v.y * y.y + v.z * z.y, v.x * x.z + v.y * y.z + v.z * z.z};
    }
  };
  static Linear linear(const Mat4d& m, double scale);

  bool set_frame(const PrepareContext& ctx, const Vec3d& center, double radius, bool finite);
  void find_sky(int n, const Vec3Lanes& p, const Vec3Lanes& d, const Block& b) const;
  void aim(int n, const Vec3Lanes& p, const float* u, const float* v, const Vec3Lanes& wi, float* aimed,
           Block& b) const;

  std::unique_ptr<const DirectionalRadiance> radiance_;
  bool finite_ = false;
  // Sky space is light space moved and scaled so that the sphere is the unit sphere around the origin.
  Linear point_to_sky_;                            ///< Render to sky; plus sky_origin_ for points.
  Linear direction_to_sky_, direction_to_render_;  ///< The same scaled to determinant +-1, and back.
  Vec3f sky_origin_{0, 0, 0};                      ///< The origin of render space in sky space.
  float size_ = 1;                                 ///< direction_to_render_ * size_ takes sky to render space.
};

}  // namespace whit
