#include "core/batch/shading.h"

namespace whit {

ShadingBatch ShadingBatch::range(int first, int count) const {
  const auto vec = [first](const Vec3Lanes& a) { return a ? a.from(first) : a; };
  const auto one = [first](float* a) { return a ? a + first : a; };
  ShadingBatch out;
  out.n = count;
  out.arena = arena, out.clock = clock, out.texture_values = texture_values;
  out.p = vec(p), out.p_error = vec(p_error), out.wo = vec(wo), out.ng = vec(ng), out.ns = vec(ns);
  out.dpdu = vec(dpdu), out.dpdv = vec(dpdv), out.dndu = vec(dndu), out.dndv = vec(dndv);
  out.u = one(u), out.v = one(v);
  out.dudx = one(dudx), out.dvdx = one(dvdx), out.dudy = one(dudy), out.dvdy = one(dvdy);
  out.dpdx = vec(dpdx), out.dpdy = vec(dpdy);
  out.flips = flips ? flips + first : flips;
  return out;
}

}  // namespace whit
