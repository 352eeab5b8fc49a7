// Bump mapping: tilts the shading frame by a displacement along the normal.
#pragma once

#include "core/batch/shading.h"
#include "core/plugin/texture.h"

namespace whit {

/// Replaces s.ns, s.dpdu and s.dpdv, in place, by those of the displaced surface. `displacement` is in scene
/// units; `scale` is RenderSpace::scale, render units per scene unit. Does nothing for a constant
/// displacement, whose slope is zero. Source: PBR book, 3rd ed., 9.3; forward differences over half the
/// footprint, or 0.0005 in (u, v) where there is none. The new normal is on the side of s.ng.
void apply_bump(const Tex<float>& displacement, float scale, ShadingBatch& s);

}  // namespace whit
