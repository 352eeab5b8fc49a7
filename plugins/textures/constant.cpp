// The same value everywhere. It folds away: what uses it holds a constant.
#include "core/plugin/registry.h"

namespace whit {
namespace {

template <class T>
class Constant : public Texture<T> {
 public:
  T value{};

  std::optional<T> constant() const override { return value; }
  EffectSet effects() const override { return {}; }
  void evaluate(const ShadingBatch& s, const typename Texture<T>::Lanes& out) const override {
    for_lanes(s.n, [&](int i) { ValueLanes<T>::set(out, i, value); });
  }
};

constexpr const char* kDoc = "The same value everywhere.";

const Register<Constant<float>> constant_float{"constant", kDoc,
                                               param(&Constant<float>::value, "value", 1.0f, Unit::None, "The value.")};
const Register<Constant<RGB>> constant_spectrum{
    "constant", kDoc, param(&Constant<RGB>::value, "value", RGB(1.0f), Unit::None, "The value.")};

}  // namespace
}  // namespace whit
