// Lights in groups of groups, by where they are and whither they shine, so that few looks tell which of them matter at
// a point. Source: Conty Estevez and Kulla, Importance Sampling of Many Lights with Adaptive Tree Splitting, 2018.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/fastmath.h"
#include "core/base/vec.h"
#include "core/batch/lanes.h"

namespace whit {

/// A light with a place, or several: where light comes from, whither, and how much.
struct LightCluster {
  Box3d box;                ///< Render space; not empty.
  Vec3d axis{0, 0, 1};      ///< Unit. What shines is turned away from it by `spread` at most.
  double spread = 0;        ///< Radians; pi where light goes everywhere.
  double edge = 0;          ///< Of what is turned some way, how far to the side light goes: half pi of surfaces.
  bool flat = false;        ///< All of it lies in a plane across the axis.
  bool two_fronts = false;  ///< What shines along some direction does so against it too.
  double strength = 0;      ///< Radiant intensity to where it is greatest (see strength_of()).
  bool several = false;     ///< Whether it is of flat ones, and of nothing else;
  Vec3d mean{0, 0, 0};      ///< then the mean of their normals, by strength: the shorter, the more they differ.

  bool of_surfaces() const { return flat || several; }
};

/// Adds the lights of `b` to those of `a`.
void add_to(LightCluster& a, const LightCluster& b);

/// The same in floats, as the chance is computed from it: by a ball around the box.
struct LightBall {
  Vec3f center;
  float radius;
  Vec3f axis;
  float cos_spread, sin_spread, cos_edge, strength;
  float fronts;  ///< 1 or 2.
  float slab;    ///< Unless 0, one over the height above a flat one from which on it shines in full.
  Vec3f mean;    ///< Of the normals of several surfaces,
  float vary;    ///< and the variance of their cosines with a direction; below 0 of all else.
};

/// What may arrive from the ball at p, at most as far as the light's direction goes: intensity by distance squared. Never
/// 0: where the light seems to shine elsewhere rounding may have the say, and a light must not be left out.
inline float irradiance_from(const LightBall& b, const Vec3f& p) {
  // One over the square of the distance to what is all over a cube, from its middle and on average, is 6 by that of the
  // half diagonal. (Counting it by 1, so as never to be too much, triples the variance among 10,000 lights.) And squares
  // of what is nearer or smaller could be 0.
  constexpr float kMiddle = 1 / 6.0f, kNearest = 1e-10f;
  constexpr float kTurnedAway = 1e-4f, kLeast = 1e-30f;
  const Vec3f to = p - b.center;
  const float squared = dot(to, to), wall = b.radius * b.radius;
  const float inverse = 1 / std::sqrt(max_of(squared, max_of(kMiddle * wall, kNearest * kNearest)));
  // The angle between axis and p, less that of the ball seen from p and of the spread.
  const float sin_ball = b.radius * inverse, cos_ball = safe_sqrt(1 - sin_ball * sin_ball);
  const float cos_free = b.cos_spread * cos_ball - b.sin_spread * sin_ball;
  const float sin_free = b.sin_spread * cos_ball + b.cos_spread * sin_ball;
  const float above = dot(b.axis, to), height = b.fronts > 1 ? std::abs(above) : above, cosine = height * inverse;
  const float beyond = cosine * cos_free + safe_sqrt(1 - cosine * cosine) * sin_free;
  const bool anywhere = (squared <= wall) | ((sin_free <= 0) & (cos_free < 0)) | (cosine >= cos_free);
  const float most = anywhere ? 1.0f : beyond;
  // Of many surfaces, what their cosines are on average where positive, as if they were normally distributed. (By the
  // most that they can be, one light of a bumpy ball of triangles has the relative variance 1.2, and 0.1 so.)
  constexpr float kOfVariance = 0.64f, kOfBall = 1 / 3.0f;
  const float toward = dot(b.mean, to) * inverse, middle = b.fronts > 1 ? std::abs(toward) : toward;
  const float off = kOfVariance * (b.vary + kOfBall * min_of(sin_ball * sin_ball, 1.0f));
  const float average = 0.5f * (middle + safe_sqrt(middle * middle + off));
  const float of_ball = ((b.vary >= 0) & (most >= b.cos_edge)) ? average : most;
  // What is flat does not light itself, nor what lies in its plane.
  const float of_plane = min_of(of_ball, height * b.slab);
  const float turned = b.slab > 0 ? of_plane : of_ball;
  const float lit = max_of(turned, kTurnedAway);
  const float share = most >= b.cos_edge ? lit : kTurnedAway;
  return max_of(b.strength * share * inverse * inverse, kLeast);
}

/// The ball around a cluster, its strength in multiples of `unit`.
LightBall ball_around(const LightCluster& cluster, double unit);

/// Several balls, structure of arrays. What is not set weighs next to nothing.
template <int N>
struct LightBalls {
  using Lanes = std::array<float, N>;
  alignas(32) Lanes x{}, y{}, z{}, radius{}, axis_x{}, axis_y{}, axis_z{}, cos_spread{},
      sin_spread{}, cos_edge{}, strength{}, fronts{}, slab{}, mean_x{}, mean_y{}, mean_z{}, vary{};

  LightBall operator[](size_t k) const {
    return {{x[k], y[k], z[k]},
            radius[k],
            {axis_x[k], axis_y[k], axis_z[k]},
            cos_spread[k],
            sin_spread[k],
            cos_edge[k],
            strength[k],
            fronts[k],
            slab[k],
            {mean_x[k], mean_y[k], mean_z[k]},
            vary[k]};
  }
  void set(size_t k, const LightBall& b) {
    x[k] = b.center.x, y[k] = b.center.y, z[k] = b.center.z, radius[k] = b.radius;
    axis_x[k] = b.axis.x, axis_y[k] = b.axis.y, axis_z[k] = b.axis.z;
    cos_spread[k] = b.cos_spread, sin_spread[k] = b.sin_spread, cos_edge[k] = b.cos_edge;
    strength[k] = b.strength, fronts[k] = b.fronts, slab[k] = b.slab;
    mean_x[k] = b.mean.x, mean_y[k] = b.mean.y, mean_z[k] = b.mean.z, vary[k] = b.vary;
  }
  /// irradiance_from() of all of them.
  void weigh(const Vec3f& p, Lanes& out) const {
    for_lanes(N, [&](int i) {
      const auto k = static_cast<size_t>(i);
      out[k] = irradiance_from((*this)[k], p);
    });
  }
};

/// A tree over clusters, with some children a node, all of which are weighed at once.
class LightTree {
 public:
  static constexpr int kWidth = 8;
  /// So deep at most, whatever the lights are.
  static constexpr int kDeepest = 72;

  LightTree() = default;
  /// Leaves are numbers of `clusters`. `unit` is that of strengths.
  LightTree(const std::vector<LightCluster>& clusters, double unit);

  bool empty() const { return nodes_.empty(); }

  /// What arrives at a point from each child of a node.
  struct Weights {
    alignas(32) LightBalls<kWidth>::Lanes each;
    double total;
  };
  /// A leaf and the probability that take() comes to it.
  struct Leaf {
    int cluster;
    double probability;
  };

  Weights weigh_root(const Vec3f& p) const { return weigh(nodes_[0], p); }
  /// The leaf for a number u in [0,1), given the root's weights.
  Leaf take(const Vec3f& p, double u, const Weights& root) const;
  /// The probability of a leaf, to the bit that of take().
  double probability(int cluster, const Vec3f& p, const Weights& root) const;

 private:
  struct Node {
    LightBalls<kWidth> balls;
    std::array<int32_t, kWidth> child{};  ///< Another node, or ~ a cluster.
    int32_t count = 0, parent = -1, slot = 0;
  };
  struct Place {
    int32_t node, slot;
  };
  class Builder;

  static Weights weigh(const Node& node, const Vec3f& p);

  std::vector<Node> nodes_;
  std::vector<Place> places_;  ///< Of the clusters.
};

}  // namespace whit
