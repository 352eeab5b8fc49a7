// How much of the light a lobe scatters in all, tabulated: what layers below it are left with.
#pragma once

#include <array>

#include "core/base/fastmath.h"
#include "core/lobe/formulas.h"

namespace whit {

/// A function of a cosine in [0, 1] and of how rough a surface is, as a position in [0, 1]: bilinear between nodes that
/// are equally spaced in the position and in the root of the cosine, because facets hide one another at cosines of
/// about their alpha, however small that is.
class AlbedoTable {
 public:
  static constexpr int kCosines = 48, kPositions = 32;

  float& node(int position, int cosine) { return nodes_[static_cast<size_t>(position * kCosines + cosine)]; }
  float node(int position, int cosine) const { return nodes_[static_cast<size_t>(position * kCosines + cosine)]; }
  static float cosine_of(int node) {
    const float root = static_cast<float>(node) / (kCosines - 1);
    return root * root;
  }

  /// The mean of the interpolated function over the hemisphere, weighted by the cosine, for a node's position.
  double mean(int position) const;

  float operator()(float cosine, float position) const {
    const Between x = between((kCosines - 1) * std::sqrt(clamp_to(cosine, 0.0f, 1.0f)), kCosines);
    const Between y = between_positions(position);
    const float* const at = nodes_.data() + (y.node * kCosines + x.node);
    return lerp(y.part, lerp(x.part, at[0], at[1]), lerp(x.part, at[kCosines], at[kCosines + 1]));
  }

  /// A node that has another one above, and how far x is on the way there.
  struct Between {
    int node;
    float part;
  };
  static Between between_positions(float position) {
    return between((kPositions - 1) * clamp_to(position, 0.0f, 1.0f), kPositions);
  }

 private:
  static Between between(float x, int nodes) {
    const int below = static_cast<int>(x), node = below < nodes - 1 ? below : nodes - 2;
    return {node, x - static_cast<float>(node)};
  }

  std::array<float, static_cast<size_t>(kCosines* kPositions)> nodes_{};
};

/// The albedo of Trowbridge-Reitz facets, light that meets one facet only, whose reflectance is Schlick's f0 + (f90 -
/// f0) (1 - cos)^5. It is linear in both, so that two tables have it all.
class FacetAlbedo {
 public:
  FacetAlbedo();

  /// Where facets are in the tables: at 0 the perfectly smooth ones, of alpha 0, then those from kMinAlpha to 1, equally
  /// spaced in the logarithm.
  static float position(float alpha) {
    const float steps = 1 + (AlbedoTable::kPositions - 2) * (1 - log_of(max_of(alpha, kMinAlpha)) / log_of(kMinAlpha));
    return alpha > 0 ? steps / (AlbedoTable::kPositions - 1) : 0.0f;
  }

  float operator()(float cosine, float position, float f0, float f90) const {
    return f0 * of_f0_(cosine, position) + f90 * of_f90_(cosine, position);
  }
  /// Its mean over the hemisphere, weighted by the cosine: exactly that of what is interpolated.
  float mean(float position, float f0, float f90) const {
    const AlbedoTable::Between y = AlbedoTable::between_positions(position);
    const float *const a = mean_f0_.data() + y.node, *const b = mean_f90_.data() + y.node;
    return f0 * lerp(y.part, a[0], a[1]) + f90 * lerp(y.part, b[0], b[1]);
  }

 private:
  AlbedoTable of_f0_, of_f90_;
  std::array<float, AlbedoTable::kPositions> mean_f0_{}, mean_f90_{};
};

/// Made when first asked for, in a few milliseconds.
const FacetAlbedo& facet_albedo();

/// The albedo of CharlieSheen, above 1 at grazing angles for roughnesses below 0.2. As late as that.
const AlbedoTable& sheen_albedo();
/// Where fibres are in it. Those that stand straighter than the least roughness are seen at grazing angles alone, where
/// there would be more of them than light: they stand like that.
inline constexpr float kLeastSheenRoughness = 0.07f;
inline float sheen_position(float roughness) {
  return (clamp_to(roughness, kLeastSheenRoughness, 1.0f) - kLeastSheenRoughness) / (1 - kLeastSheenRoughness);
}

}  // namespace whit
