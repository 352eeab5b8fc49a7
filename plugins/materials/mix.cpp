// A blend of two named materials: the lobes of both, weighted. As in pbrt-v3 the first one gives the bump map,
// here the normal map too, and the index of refraction for ray differentials; mixes may be mixed. What is mixed in several
// ways, by mixes of mixes, is asked for its lobes once and gets the sum of its shares: lobes are linear in their weights,
// and a material that is doubled thirty times over is still one.
#include <algorithm>
#include <memory>
#include <unordered_map>
#include <vector>

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
    flatten();
    if (!namedmaterial1) return;
    bump = namedmaterial1->bump;
    normalmap = namedmaterial1->normalmap, normalscale = namedmaterial1->normalscale;
  }

  void lobes(const ShadingBatch& s, LobeSet& out) const override {
    RGBLanes* const shares = s.arena->alloc<RGBLanes>(static_cast<int>(parts_.size()));
    std::uninitialized_value_construct_n(shares, parts_.size());
    const float *const eta_before = out.eta, *eta = out.eta;
    for (size_t k = 0; k < parts_.size(); ++k) {
      const Part& part = parts_[k];
      if (part.mix) {
        const RGBLanes first = weights(part.mix->amount, s), second = one_minus(s, first);
        pass_on(s, shares[k], first, part.first, shares);
        pass_on(s, shares[k], second, part.second, shares);
        continue;
      }
      if (&part == first_) out.eta = eta_before;
      add_share(*part.material, shares[k], s, out);
      if (&part == first_) eta = out.eta;
    }
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
  /// A mix, or a material that is none and has lobes.
  struct Part {
    const Material* material;
    const Mix* mix;               ///< The same, or null.
    int first = -1, second = -1;  ///< Of a mix: the parts it mixes; -1 for one that is missing.
  };

  /// Finds all that is mixed here, each once and behind all that mix it; otherwise in the order of the statements.
  void flatten() {
    // Depth first, the second member before the first and a mix behind both: backwards that is the order. Without
    // recursion, for chains may be long.
    std::unordered_map<const Material*, int> number;
    std::vector<std::pair<const Material*, bool>> open{{this, false}};
    parts_.clear();
    while (!open.empty()) {
      const auto [material, has_members] = open.back();
      open.pop_back();
      const Mix* const mix = dynamic_cast<const Mix*>(material);
      if (!has_members) {
        if (!number.emplace(material, -1).second) continue;
        open.emplace_back(material, true);
        if (!mix) continue;
        for (const auto& member : {mix->namedmaterial1, mix->namedmaterial2})
          if (member) open.emplace_back(member.get(), false);
        continue;
      }
      number[material] = static_cast<int>(parts_.size());
      parts_.push_back({material, mix});
    }
    std::reverse(parts_.begin(), parts_.end());
    const int last = static_cast<int>(parts_.size()) - 1;
    const auto part_of = [&](const std::shared_ptr<Material>& m) { return m ? last - number.at(m.get()) : -1; };
    for (Part& part : parts_)
      if (part.mix) part.first = part_of(part.mix->namedmaterial1), part.second = part_of(part.mix->namedmaterial2);
    first_ = &parts_.front();
    while (first_ && first_->mix) first_ = first_->first < 0 ? nullptr : &parts_[static_cast<size_t>(first_->first)];
  }

  /// A mix's share of the whole (nothing: all of it) times that of a member in the mix, added to what the member has.
  static void pass_on(const ShadingBatch& s, const RGBLanes& of_mix, const RGBLanes& in_mix, int member,
                      RGBLanes* shares) {
    if (member < 0) return;
    const RGBLanes share = of_mix.r ? product(s, in_mix, of_mix) : in_mix;
    RGBLanes& sum = shares[member];
    sum = sum.r ? added(s, sum, share) : share;
  }

  static RGBLanes added(const ShadingBatch& s, const RGBLanes& a, const RGBLanes& b) {
    const RGBLanes out = s.arena->rgb(s.n);
    for_lanes(s.n, [&](int i) { out.set(i, a[i] + b[i]); });
    return out;
  }

  /// Adds a material's lobes with their weights scaled. The weights are not scaled in place: lobes may share them.
  static void add_share(const Material& member, const RGBLanes& share, const ShadingBatch& s, LobeSet& out) {
    const int before = out.count;
    member.lobes(s, out);
    for (int k = before; k < out.count; ++k) out.lobes[k].weight = product(s, out.lobes[k].weight, share);
  }

  std::vector<Part> parts_;
  const Part* first_ = nullptr;  ///< What is met first: its index of refraction counts.
};

const Register<Mix> mix{
    "mix", "A blend of two named materials.",
    param(&Mix::namedmaterial1, "namedmaterial1", Unit::None, "The name of the first material. Required."),
    param(&Mix::namedmaterial2, "namedmaterial2", Unit::None, "The name of the second material. Required."),
    param(&Mix::amount, "amount", RGB(0.5f), Unit::None, "Share of the first material; the rest is the second's.")};

}  // namespace
}  // namespace whit
