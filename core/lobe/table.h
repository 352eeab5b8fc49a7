// What there is to know of each type of lobe: a row that stands at the end of its family's file. Everything that
// depends on the type of a lobe asks its row; a new lobe is a row (docs/add-a-material.md).
#pragma once

#include <span>

#include "core/lobe/lobe.h"

namespace whit {

/// Directions at the points of a lobe.
struct LobeQuery {
  const Lobe& lobe;
  const ShadingBatch& s;
  const LobeFrame& frame;  ///< There where needs_frame() says so.
  const Vec3Lanes& wi;
};

/// Where values and densities of a query are added to.
struct LobeValues {
  RGBLanes f;            ///< f(wo, wi) |wi . ns|
  const float* share;    ///< How many of the lane's samples are the lobe's, in [0, 1].
  float* pdf = nullptr;  ///< share times the density of wi per solid angle; null: nobody asks.
};

/// Directions to be drawn from a lobe by the lanes that have chosen it; other lanes stay as they are.
struct LobeDraw {
  const Lobe& lobe;
  const ShadingBatch& s;
  const LobeFrame& frame;  ///< There where needs_frame() says so, and perhaps elsewhere.
  const int32_t* chosen;   ///< For each lane an index of a lobe ...
  int index;               ///< ... and the one of this lobe.
  const float *u, *v;      ///< In [0, 1); null for specular lobes.
  Vec3Lanes wi;            ///< Unit vectors in render space; the zero vector where none came out.
  RGBLanes weight;         ///< Of specular lobes: f |wi . ns| / pdf, the choice left aside.
  float* eta2 = nullptr;   ///< Of specular lobes, null unless asked for, see LobeSamples.
};

struct LobeRow {
  const char* name;  ///< In the account of --debug-pixel.
  Effect effect;
  bool reflects, transmits;  ///< To which sides light that arrives from wo's side leaves.
  bool specular = false;
  /// Whether eval() and sample() need tangents; null: never. Without them sample() takes any.
  bool (*needs_frame)(const Lobe& lobe) = nullptr;
  /// Multiplies to[i] by about how much of the light a lobe of weight 1 scatters to wo; null: all of it. Above 0 for
  /// lobes that are not specular.
  void (*scale_strength)(const Lobe& lobe, const ShadingBatch& s, float* to) = nullptr;
  /// Adds values, and densities if they are asked for. Null for specular lobes.
  void (*eval)(const LobeQuery& query, const LobeValues& out) = nullptr;
  void (*sample)(const LobeDraw& draw) = nullptr;
};

namespace lobe_rows {
#define LOBE(name) extern const LobeRow name;
#include "core/lobe/lobe_types.inc"
#undef LOBE
}  // namespace lobe_rows

const LobeRow& row_of(LobeType type);

/// All rows, in the order of LobeType.
std::span<const LobeRow* const> all_rows();

}  // namespace whit
