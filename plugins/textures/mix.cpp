// A linear blend of two textures.
#include "core/plugin/registry.h"
#include "plugins/shared/texture_channels.h"

namespace whit {
namespace {

template <class T>
class Mix : public Texture<T> {
 public:
  Tex<T> tex1, tex2;
  Tex<float> amount;

  std::optional<T> constant() const override {
    if (tex1.is_constant() && tex2.is_constant() && tex1.value() == tex2.value()) return tex1.value();
    if (amount.is_constant() && amount.value() == 0 && tex1.is_constant()) return tex1.value();
    if (amount.is_constant() && amount.value() == 1 && tex2.is_constant()) return tex2.value();
    if (tex1.is_constant() && tex2.is_constant() && amount.is_constant())
      return blend(tex1.value(), tex2.value(), amount.value());
    return std::nullopt;
  }
  EffectSet effects() const override { return {}; }
  void evaluate(const ShadingBatch& s, const typename Texture<T>::Lanes& out) const override {
    const ArenaScope scratch(*s.arena);
    // At either end the other is not asked for.
    const auto share_is = [this](float share) { return amount.is_constant() && amount.value() == share; };
    const auto first = (share_is(1) ? tex2 : tex1)(s);
    const auto second = share_is(0) || share_is(1) ? first : tex2(s);
    blend<T>(s.n, first, second, amount(s), out);
  }
};

constexpr const char* kDoc = "A linear blend: (1 - amount) tex1 + amount tex2.";
constexpr const char* kAmount = "Share of tex2.";

const Register<Mix<float>> mix_float{"mix", kDoc,
                                     param(&Mix<float>::tex1, "tex1", 0.0f, Unit::None, "Value at amount 0."),
                                     param(&Mix<float>::tex2, "tex2", 1.0f, Unit::None, "Value at amount 1."),
                                     param(&Mix<float>::amount, "amount", 0.5f, Unit::None, kAmount)};
const Register<Mix<RGB>> mix_spectrum{"mix", kDoc,
                                      param(&Mix<RGB>::tex1, "tex1", RGB(0.0f), Unit::None, "Value at amount 0."),
                                      param(&Mix<RGB>::tex2, "tex2", RGB(1.0f), Unit::None, "Value at amount 1."),
                                      param(&Mix<RGB>::amount, "amount", 0.5f, Unit::None, kAmount)};

}  // namespace
}  // namespace whit
