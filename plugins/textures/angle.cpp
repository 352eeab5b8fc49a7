// The angle of a direction that is kept in two numbers of 0 to 1 for components of -1 to 1, as pictures of brushed metal
// have it.
#include "core/base/fastmath.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

class Angle : public Texture<float> {
 public:
  Tex<float> x, y;
  float offset = 0;

  std::optional<float> constant() const override {
    if (!x.is_constant() || !y.is_constant()) return std::nullopt;
    return degrees(x.value(), y.value());
  }
  EffectSet effects() const override { return {}; }
  void evaluate(const ShadingBatch& s, float* const& out) const override {
    const ArenaScope scratch(*s.arena);
    const float *const xs = x(s), *const ys = y(s);
    for_lanes(s.n, [&](int i) { out[i] = degrees(xs[i], ys[i]); });
  }

 private:
  float degrees(float along_x, float along_y) const {
    const double angle = detail::atan2_kernel(2.0 * along_y - 1, 2.0 * along_x - 1);
    return static_cast<float>(angle * (180 / detail::kPiD)) + offset;
  }
};

const Register<Angle> angle{
    "angle",
    "The angle of a direction, counter-clockwise from +x, whose components of -1 to 1 are two textures of 0 to 1.",
    param(&Angle::x, "x", 1.0f, Unit::None, "The component along x."),
    param(&Angle::y, "y", 0.5f, Unit::None, "The component along y."),
    param(&Angle::offset, "offset", 0.0f, Unit::Degrees, "Added to the angle.")};

}  // namespace
}  // namespace whit
