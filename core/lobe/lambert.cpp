// Diffuse lobes: Lambert's and Oren and Nayar's. Lambert, Photometria, 1760; Oren and Nayar, Generalization of
// Lambert's Reflectance Model, 1994.
#include "core/lobe/draw.h"
#include "core/lobe/formulas.h"
#include "core/lobe/pair.h"

namespace whit {

namespace {

void eval_reflection(const LobeQuery& q, const LobeValues& out) {
  for_pairs(q, out, [&](int i, const Pair& p, const auto& add_density) {
    accumulate(out.f, i, q.lobe.weight, kInvPi * std::abs(p.zi) * p.reflects);
    add_density(diffuse_density(p));
  });
}

void eval_transmission(const LobeQuery& q, const LobeValues& out) {
  for_pairs(q, out, [&](int i, const Pair& p, const auto& add_density) {
    accumulate(out.f, i, q.lobe.weight, kInvPi * std::abs(p.zi) * p.transmits);
    add_density(diffuse_density_behind(p));
  });
}

void draw_transmission(const LobeDraw& d) {
  draw_lanes(d, [](int, const Vec3f& wo, float u, float v) {
    const Vec3f w = cosine_hemisphere(u, v);
    return Vec3f(w.x, w.y, -w.z * side_of(wo.z));
  });
}

void eval_oren_nayar(const LobeQuery& q, const LobeValues& out) {
  for_pairs(q, out, [&](int i, const Pair& p, const auto& add_density) {
    const float tangential = dot(p.wi - p.n * p.zi, p.wo - p.n * p.zo);
    const float f = oren_nayar(q.lobe.a[i], q.lobe.b[i], std::abs(p.zi), std::abs(p.zo), tangential);
    accumulate(out.f, i, q.lobe.weight, kInvPi * f * std::abs(p.zi) * p.reflects);
    add_density(diffuse_density(p));
  });
}

}  // namespace

const LobeRow lobe_rows::LambertReflection = {
    .name = "Lambert reflection",
    .effect = Effect::Diffuse,
    .reflects = true,
    .transmits = false,
    .eval = eval_reflection,
    .sample = draw_diffuse,
};

const LobeRow lobe_rows::LambertTransmission = {
    .name = "Lambert transmission",
    .effect = Effect::Diffuse,
    .reflects = false,
    .transmits = true,
    .eval = eval_transmission,
    .sample = draw_transmission,
};

const LobeRow lobe_rows::OrenNayar = {
    .name = "Oren-Nayar",
    .effect = Effect::Diffuse,
    .reflects = true,
    .transmits = false,
    .eval = eval_oren_nayar,
    .sample = draw_diffuse,
};

}  // namespace whit
