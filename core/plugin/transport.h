// Light transport as values: an integrator is written over batches that it can see, and each step is a function of this
// interface, whose inputs and outputs are its arguments.
//
//   Rays --intersect--> Hits --surfaces--> Points --shade--> lobes
//     \--escaped--> Seen       \--emitted--> Seen    \--sample, scatter, visible--> light that arrives
//                                                     \--mirrored, refracted, sampled--> Onward --send--> Rays
//
// Arrays live until the batch is done, but for those made between two lights of lights(): these live until the next.
#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "core/batch/rays.h"
#include "core/batch/shading.h"
#include "core/lobe/eval.h"
#include "core/plugin/light.h"

namespace whit {

struct MaterialRun;
struct PointNotes;

/// Surface points that rays have met, grouped by material.
struct Points {
  int n = 0;
  ShadingBatch at;
  Rays rays;                         ///< The rays that met them, in the order of the points,
  Hits hits;                         ///< and their hits.
  const int32_t* ray = nullptr;      ///< Which lane of the batch of rays each was; ascending within a material.
  RGBLanes radiance;                 ///< What was found of the radiance that goes back along the rays.
  std::span<MaterialRun> materials;  ///< With their lobes, once shade() has been called.
  PointNotes* notes = nullptr;       ///< The renderer's.
};

/// Radiance that some rays of a batch get from what they meet: lights at infinity, or points that emit.
struct Seen {
  int n = 0;
  const int32_t* lane = nullptr;   ///< Of the rays, or of the points.
  RGBLanes radiance;               ///< Times the weight, where the rays carry densities.
  const int32_t* light = nullptr;  ///< The light's number, -1 for one that is not sampled; null when they are several.
  const RGBLanes* environments = nullptr;  ///< The shares of the scene's lights at infinity; null unless asked for.
};

/// Two uniform numbers in [0,1) for every point.
struct Uniform2 {
  float *u = nullptr, *v = nullptr;
};

/// A sample of light for every point: of one light, or of one that was chosen for each point.
struct DirectSamples : LightSamples {
  static constexpr int kNone = -1;
  int light = kNone;  ///< Number of the light; kNone when it is another for each point, or no light at all.
  const int32_t* lights = nullptr;  ///< Numbers by point, or null.
};

/// Lights that were chosen for each point: `of` arrays of n, one after the other.
struct ChosenLights {
  int of = 0;                       ///< How many for each point; the same light may be among them several times.
  const int32_t* light = nullptr;   ///< Their numbers,
  const float* expected = nullptr;  ///< and how often, on average, each of them is chosen for its point.
  Uniform2 numbers;                 ///< For the points on them, by point: of the first, from which the others' follow.
};

/// What the lobes do with a direction.
struct Scattered {
  RGBLanes f;            ///< f |wi . ns|, of the lobes that are not specular.
  float* pdf = nullptr;  ///< With which sampled() would choose it; null unless asked for.
};

/// Directions in which light is followed from every point. Black weights are lanes that send no ray.
struct Onward {
  enum class Kind : uint8_t { Mirrored, Refracted, Sampled };
  Kind kind = Kind::Mirrored;
  Vec3Lanes wi;           ///< Null: from no point.
  RGBLanes weight;        ///< f |wi . ns| / pdf.
  float* pdf = nullptr;   ///< Per solid angle; infinite for specular lobes. Null: they all are.
  float* eta2 = nullptr;  ///< Factor of Rays::eta2; null where rays carry none.
  RayDifferentials differentials;
  explicit operator bool() const { return static_cast<bool>(wi); }
};

/// Rays::via: how the sample left its first surface. Of sampled directions, by those that are not of a specular lobe.
enum class Via : int32_t { Camera, Mirrored, Refracted, Sampled };

/// Weight of a sample of density `pdf`, where another way to come by the same light has the density `other`.
using Heuristic = float (*)(float pdf, float other);

/// The power heuristic with exponent 2, one sample of each kind. Veach, Robust Monte Carlo Methods for Light Transport
/// Simulation, 1997, section 9.2.4. Written as a ratio, for squares of densities overflow.
inline float power_heuristic(float pdf, float other) {
  if (pdf == std::numeric_limits<float>::infinity()) return 1;
  const float ratio = pdf > 0 ? other / pdf : std::numeric_limits<float>::infinity();
  return 1 / (1 + ratio * ratio);
}

class Transport {
 public:
  virtual ~Transport() = default;

  // ---- What rays meet ----

  /// The nearest surfaces. Surfaces of interface materials are passed through: the rays then begin behind them.
  virtual Hits intersect(Rays& rays) = 0;
  /// The radiance of the lights at infinity along rays that hit nothing. With a heuristic, weighed against samples of the
  /// lights where the rays carry densities.
  virtual Seen escaped(const Rays& rays, const Hits& hits, Heuristic heuristic = nullptr) = 0;

  enum class Which : bool { All, Emitting };
  /// The points of the hits, or only of those on surfaces that emit, with normals, derivatives and error bounds.
  virtual Points surfaces(const Rays& rays, const Hits& hits, Which which = Which::All) = 0;
  /// The radiance that the points emit back along their rays. With a heuristic, weighed likewise.
  virtual Seen emitted(const Points& points, Heuristic heuristic = nullptr) = 0;
  /// Tilts normals by bump maps and asks materials for the lobes of the points.
  virtual void shade(Points& points) = 0;

  // ---- Light that points are sent ----

  /// The number of the first light from `light` on that may reach one of the points; -1 when there is none. Ends the
  /// life of all arrays that were made since the last call.
  virtual int next_light(const Points& points, int light) = 0;
  /// A sample of one light, the number-th of several that are wanted for each point: radiance is divided by all of them,
  /// and multiplied into the density.
  virtual DirectSamples sample(const Points& points, int light, int number = 0, int of = 1, bool densities = false) = 0;
  /// How many samples of a light the scene wants.
  virtual int samples_of(int light) const = 0;
  /// Some lights for each point, chosen by the number of `dimension`, to be sampled by those of the two after it. None
  /// where nothing scatters or shines, and none where the integrator is to sample all of them.
  virtual ChosenLights choose_lights(const Points& points, int dimension) = 0;
  /// A sample of the number-th of these for each point. The probability of the choice is part of the density, by which
  /// radiance is divided.
  virtual DirectSamples sample(const Points& points, const ChosenLights& chosen, int number) = 0;
  /// What the lobes send back along the rays of light from wi.
  virtual Scattered scatter(const Points& points, const Vec3Lanes& wi, bool densities = false,
                            LobeKinds kinds = LobeKinds::All) = 0;
  /// `light` where nothing is between a point and its sample, which is looked for where it is not black; else 0. In
  /// place.
  virtual RGBLanes visible(const Points& points, const DirectSamples& samples, const RGBLanes& light) = 0;

  // ---- Where light is followed to ----

  /// By the points' mirrors, and through their smooth boundaries. The number of `dimension` chooses where a point has
  /// several such lobes.
  virtual Onward mirrored(const Points& points, int dimension) = 0;
  virtual Onward refracted(const Points& points, int dimension) = 0;
  /// By one of the lobes, chosen by the number of `dimension`, sampled by those of the two after it.
  virtual Onward sampled(const Points& points, int dimension, LobeKinds kinds = LobeKinds::All) = 0;
  /// Ends paths at random where what they carry is below the threshold, and strengthens the others: pbrt-v3's rule.
  virtual void roulette(const Points& points, const Onward& onward, int dimension, float threshold) = 0;
  /// The rays of one kind, to be followed here and now, with their densities.
  virtual Rays rays(const Points& points, const Onward& onward) = 0;
  /// Queues rays for the next depth; those of one point in the order of the arguments.
  virtual void send(const Points& points, const Onward& onward, const Onward& also = {}) = 0;

  // ---- What it comes to ----

  /// Adds to the radiance of the rays' samples, or to what the points send back along their rays.
  virtual void add(const Rays& rays, const Seen& seen) = 0;
  virtual void add(const Points& points, const Seen& seen) = 0;
  virtual void add(const Points& points, const DirectSamples& samples, const RGBLanes& light) = 0;

  // ---- What is there, and numbers ----

  /// Whether the scene calls for an effect.
  virtual bool live(Effect effect) const = 0;

  /// Arrays for values of the integrator's own.
  virtual Arena& arena() = 0;
  /// Sample dimensions that sampling lights takes in one bounce, each of them or some that are chosen. The integrator's
  /// own come after these.
  virtual int light_dimensions() const = 0;
  virtual const float* draw_1d(const Points& points, int dimension) = 0;
  virtual Uniform2 draw_2d(const Points& points, int dimension) = 0;
};

/// A direction without end from every point, towards no light of the scene, for Transport::visible().
inline DirectSamples directions(const Points& points, const Vec3Lanes& wi, Arena& arena) {
  DirectSamples s;
  s.n = points.n, s.wi = wi, s.distance = arena.floats(points.n);
  std::fill_n(s.distance, points.n, std::numeric_limits<float>::infinity());
  return s;
}

/// What the lobes send on of sampled light, in place of what they would send of any. Where both have densities, as far as
/// no sampled direction finds the light.
inline RGBLanes arriving(const DirectSamples& light, const Scattered& scattered) {
  const RGBLanes f = scattered.f;
  const bool weighed = light.pdf && scattered.pdf;
  for_lanes(light.n, [&](int i) {
    const float weight = weighed ? power_heuristic(light.pdf[i], scattered.pdf[i]) : 1.0f;
    f.r[i] *= light.radiance.r[i] * weight;
    f.g[i] *= light.radiance.g[i] * weight;
    f.b[i] *= light.radiance.b[i] * weight;
  });
  return f;
}

/// for (int light : lights(t, points)): the numbers of the lights that may reach one of the points.
class LightRange {
 public:
  LightRange(Transport& t, const Points& points) : t_(t), points_(points) {}
  class Iterator {
   public:
    Iterator(const LightRange& range, int light) : range_(range), light_(light) {}
    int operator*() const { return light_; }
    void operator++() { light_ = range_.t_.next_light(range_.points_, light_ + 1); }
    bool operator!=(const Iterator& o) const { return light_ != o.light_; }

   private:
    const LightRange& range_;
    int light_;
  };
  Iterator begin() const { return {*this, t_.next_light(points_, 0)}; }
  Iterator end() const { return {*this, -1}; }

 private:
  Transport& t_;
  const Points& points_;
};
inline LightRange lights(Transport& t, const Points& points) { return {t, points}; }

}  // namespace whit
