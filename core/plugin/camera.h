// Cameras: batches of film positions to rays.
#pragma once

#include <optional>

#include "core/batch/lanes.h"
#include "core/plugin/param.h"

namespace whit {

/// Rays in camera space: the camera at the origin, looking along +z, y up, x right (left-handed, as in pbrt).
struct CameraRays {
  int n = 0;
  // In.
  const float *film_x = nullptr,
              *film_y = nullptr;  ///< Continuous raster coordinates, pixel (i,j) covers [i,i+1)x[j,j+1).
  const float *lens_u = nullptr, *lens_v = nullptr;  ///< In [0,1); null when the camera needs no lens.
  // Out.
  Vec3Lanes o;              ///< Origin, in scene units.
  Vec3Lanes d;              ///< Unit direction.
  float* weight = nullptr;  ///< Multiplies the radiance; 0 for a ray that does not reach the film.
};

/// What a camera is told of the film before prepare().
struct FilmGeometry {
  Vec2i resolution{0, 0};
  double diagonal = 0.035;  ///< Metres.
};

class Camera : public Plugin {
 public:
  static constexpr const char* kCategory = "camera";
  FilmGeometry film;
  float shutter_open = 0, shutter_close = 1;  ///< Times; transforms of the scene run from time_start to time_end.

  /// Whether rays start at sampled positions of a lens: depth of field.
  virtual bool needs_lens() const { return false; }
  EffectSet effects() const override { return needs_lens() ? EffectSet{Effect::DepthOfField} : EffectSet{}; }
  virtual void generate(const CameraRays& rays) const = 0;
  /// Of generated rays those one pixel further along x (axis 0) or y (axis 1), through the same point of the lens: what
  /// generate() gives there. A camera that may stop the one and not the other says itself what is there instead.
  virtual void generate_neighbours(const CameraRays& rays, int axis, const Vec3Lanes& o, const Vec3Lanes& d) const;
  /// Where points of camera space are in the picture, from (0, 0) at its upper left to (1, 1), for a camera whose picture is
  /// a projection: that of a pinhole in the middle of the lens. After prepare().
  virtual std::optional<Mat4d> to_ndc() const { return {}; }
};

/// The shutter parameters every camera has.
inline auto shutteropen_param() {
  return param(&Camera::shutter_open, "shutteropen", 0.0f, Unit::Seconds, "Time at which the shutter opens.");
}
inline auto shutterclose_param() {
  return param(&Camera::shutter_close, "shutterclose", 1.0f, Unit::Seconds, "Time at which the shutter closes.");
}

}  // namespace whit
