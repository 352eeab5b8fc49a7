// The product of two textures.
#include "core/plugin/registry.h"
#include "plugins/shared/texture_channels.h"

namespace whit {
namespace {

template <class T>
class Scale : public Texture<T> {
 public:
  Tex<T> tex1, tex2;

  std::optional<T> constant() const override {
    if (tex1.is_constant() && tex2.is_constant()) return tex1.value() * tex2.value();
    for (const Tex<T>* factor : {&tex1, &tex2}) {
      if (factor->is_constant() && factor->value() == T(0.0f)) return T(0.0f);
    }
    return std::nullopt;
  }
  EffectSet effects() const override { return {}; }
  void evaluate(const ShadingBatch& s, const typename Texture<T>::Lanes& out) const override {
    const ArenaScope scratch(*s.arena);
    const auto a = tex1(s), b = tex2(s);
    for (int c = 0; c < kChannels<T>; ++c) {
      const float *const x = channel(a, c), *const y = channel(b, c);
      float* const result = channel(out, c);
      for_lanes(s.n, [&](int i) { result[i] = x[i] * y[i]; });
    }
  }
};

constexpr const char* kDoc = "The product of two textures.";

const Register<Scale<float>> scale_float{"scale", kDoc,
                                         param(&Scale<float>::tex1, "tex1", 1.0f, Unit::None, "First factor."),
                                         param(&Scale<float>::tex2, "tex2", 1.0f, Unit::None, "Second factor.")};
const Register<Scale<RGB>> scale_spectrum{"scale", kDoc,
                                          param(&Scale<RGB>::tex1, "tex1", RGB(1.0f), Unit::None, "First factor."),
                                          param(&Scale<RGB>::tex2, "tex2", RGB(1.0f), Unit::None, "Second factor.")};

}  // namespace
}  // namespace whit
