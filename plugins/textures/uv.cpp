// Texture coordinates as colours: red is the fraction of s, green that of t. For finding out how a surface is
// mapped.
#include <cmath>

#include "plugins/shared/texture_mapping.h"

namespace whit {
namespace {

class Uv : public Texture2D<RGB> {
 public:
  EffectSet effects() const override { return {}; }
  void evaluate(const ShadingBatch& s, const RGBLanes& out) const override {
    const ArenaScope scratch(*s.arena);
    const MappedPoints m = map_.map(s);
    for_lanes(s.n, [&](int i) {
      out.r[i] = m.s[i] - std::floor(m.s[i]);
      out.g[i] = m.t[i] - std::floor(m.t[i]);
      out.b[i] = 0;
    });
  }
};

const Register2D<Uv, RGB> uv{"uv", "Texture coordinates as colours: red s, green t."};

}  // namespace
}  // namespace whit
