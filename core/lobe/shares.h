// How the lobes of a run share in the samples of each lane.
#pragma once

#include "core/lobe/eval.h"

namespace whit {

/// of[lobe][lane], the probability that a lane samples a lobe; null for lobes of other kinds. A lane's add up to 1, or
/// to 0 where all its lobes are black.
struct LobeShares {
  float** of;
};

/// The shares that sample_lobes() documents, in s.arena.
LobeShares lobe_shares(const LobeSet& set, const ShadingBatch& s, LobeKinds kinds);

/// Values and densities of non-specular lobes, as eval_lobes(), for shares that are known.
void eval_with_shares(const LobeSet& set, const ShadingBatch& s, const LobeFrame& frame, const Vec3Lanes& wi,
                      const LobeShares& shares, const RGBLanes& f, float* pdf);

}  // namespace whit
