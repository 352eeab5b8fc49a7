// Bump and normal maps: what tilts the shading frame.
#pragma once

#include "core/batch/shading.h"
#include "core/plugin/texture.h"

namespace whit {

/// Replaces s.ns, s.dpdu and s.dpdv, in place, by those of the displaced surface. `displacement` is in scene
/// units; `scale` is RenderSpace::scale, render units per scene unit. Does nothing for a constant
/// displacement, whose slope is zero. Source: PBR book, 3rd ed., 9.3; forward differences over half the
/// footprint, or 0.0005 in (u, v) where there is none. The new normal is on the side of s.ng.
void apply_bump(const Tex<float>& displacement, float scale, ShadingBatch& s);

/// Replaces s.ns by the normals of a map, 2 c - 1 in the frame of s.dpdu, s.dpdv (both made unit vectors) and s.ns, the
/// first two components scaled; after a bump map, whose frame it tilts. A normal that leaves the side of s.ng is lifted
/// until it is just above the surface. s.dpdu and s.dpdv lose what they have along the new normal.
void apply_normal_map(const Tex<RGB>& map, float scale, ShadingBatch& s);

}  // namespace whit
