// A blend of two named materials: the lobes of both, weighted. As in pbrt-v3 the first one gives the bump map,
// here the normal map too, and the index of refraction for ray differentials; mixes may be mixed.
#include <memory>

#include "core/plugin/registry.h"
#include "plugins/shared/material_inputs.h"

namespace whit {
namespace {

struct Mix : Material {
  std::shared_ptr<Material> namedmaterial1, namedmaterial2;
  Tex<RGB> amount;

  void check(Diagnostics& diagnostics, SourcePos statement) override {
    if (!namedmaterial1) diagnostics.error(statement, "mix needs the name of a material as \"namedmaterial1\"");
    if (!namedmaterial2) diagnostics.error(statement, "mix needs the name of a material as \"namedmaterial2\"");
    if (!namedmaterial1) return;
    bump = namedmaterial1->bump;
    normalmap = namedmaterial1->normalmap, normalscale = namedmaterial1->normalscale;
  }

  void lobes(const ShadingBatch& s, LobeSet& out) const override {
    const RGBLanes first = weights(amount, s), second = one_minus(s, first);
    if (namedmaterial1) add_share(*namedmaterial1, first, s, out);
    const float* const eta = out.eta;
    if (namedmaterial2) add_share(*namedmaterial2, second, s, out);
    out.eta = eta;
  }

  std::vector<Ineffective> ineffective() const override {
    const RGB a = amount.value();
    if (!amount.is_constant()) return {};
    if (a.x >= 1 && a.y >= 1 && a.z >= 1) return {{"namedmaterial2", "the \"amount\" of the first material is 1"}};
    if (is_black(amount)) return {{"namedmaterial1", "its \"amount\" is 0"}};
    return {};
  }

 private:
  /// Adds a material's lobes with their weights scaled. The weights are not scaled in place: lobes may share them.
  static void add_share(const Material& member, const RGBLanes& share, const ShadingBatch& s, LobeSet& out) {
    const int before = out.count;
    member.lobes(s, out);
    for (int k = before; k < out.count; ++k) out.lobes[k].weight = product(s, out.lobes[k].weight, share);
  }
};

const Register<Mix> mix{
    "mix", "A blend of two named materials.",
    param(&Mix::namedmaterial1, "namedmaterial1", Unit::None, "The name of the first material. Required."),
    param(&Mix::namedmaterial2, "namedmaterial2", Unit::None, "The name of the second material. Required."),
    param(&Mix::amount, "amount", RGB(0.5f), Unit::None, "Share of the first material; the rest is the second's.")};

}  // namespace
}  // namespace whit
