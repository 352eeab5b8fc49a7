// 1 where a texture reaches a value and exactly 0 elsewhere: what a mask wants as "alpha".
#include "core/plugin/registry.h"

namespace whit {
namespace {

class Threshold : public Texture<float> {
 public:
  Tex<float> value;
  float edge = 0.5f;

  std::optional<float> constant() const override {
    if (!value.is_constant()) return std::nullopt;
    return value.value() >= edge ? 1.0f : 0.0f;
  }
  EffectSet effects() const override { return {}; }
  void evaluate(const ShadingBatch& s, float* const& out) const override {
    const ArenaScope scratch(*s.arena);
    const float* const values = value(s);
    for_lanes(s.n, [&](int i) { out[i] = values[i] >= edge ? 1.0f : 0.0f; });
  }
};

const Register<Threshold> threshold{"threshold",
                                    "1 where a texture is at or above an edge, exactly 0 where it is below.",
                                    param(&Threshold::value, "value", 1.0f, Unit::None, "The texture."),
                                    param(&Threshold::edge, "edge", 0.5f, Unit::None, "The least value that gives 1.")};

}  // namespace
}  // namespace whit
