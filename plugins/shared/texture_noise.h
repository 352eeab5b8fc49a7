// What textures made of noise share: points in the space of the texture, and how much of it they see.
#pragma once

#include "core/base/noise.h"
#include "plugins/shared/texture_channels.h"
#include "plugins/shared/texture_mapping.h"

namespace whit {

/// A texture in three dimensions whose detail is limited to the footprint. pbrt's marble has numbers for colours only,
/// so a subclass either gives one number per point (GreyNoise) or fills in evaluate() itself.
template <class T>
class NoiseTexture : public Texture<T> {
 public:
  bool prepare(const PrepareContext& ctx) override {
    map_ = mapping_3d(this->texture_to_world, ctx.space);
    return true;
  }

 protected:
  /// The points of a batch in texture space, in its arena.
  NoisePoints noise_points(const ShadingBatch& s) const {
    const Vec3Lanes p = s.arena->vec3(s.n);
    float* const width2 = s.arena->floats(s.n);
    const AffineMap map = map_;
    for_lanes(s.n, [=](int i) { p.set(i, map.point(s.p[i])), width2[i] = 0; });
    if (s.has_footprint()) {
      for_lanes(s.n, [=](int i) {
        const Vec3f dx = map.vector(s.dpdx[i]), dy = map.vector(s.dpdy[i]);
        width2[i] = max_of(dot(dx, dx), dot(dy, dy));
      });
    }
    return {s.n, p.x, p.y, p.z, width2};
  }

 private:
  AffineMap map_;
};

/// One number per point, the same in every channel.
template <class T>
class GreyNoise : public NoiseTexture<T> {
 public:
  void evaluate(const ShadingBatch& s, const typename Texture<T>::Lanes& out) const final {
    const ArenaScope scratch(*s.arena);
    const NoisePoints points = this->noise_points(s);
    float* const grey = channel(out, 0);
    value(points, *s.arena, grey);
    for (int c = 1; c < kChannels<T>; ++c) {
      float* const copy = channel(out, c);
      for_lanes(s.n, [=](int i) { copy[i] = grey[i]; });
    }
  }

 protected:
  virtual void value(const NoisePoints& points, Arena& scratch, float* out) const = 0;
};

/// The parameters of sums of octaves.
template <class Class>
auto octaves_param(int Class::*member) {
  return param(member, "octaves", 8, Unit::None, "Octaves of noise to add, as far as the footprint shows them.",
               Range{0, kMaxOctaves});
}
template <class Class>
auto roughness_param(float Class::*member) {
  return param(member, "roughness", 0.5f, Unit::None, "Strength of each octave relative to the one before.");
}

}  // namespace whit
