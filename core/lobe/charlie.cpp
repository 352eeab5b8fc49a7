// The sheen of cloth: fibres that stand on end, more or less. Conty Estevez and Kulla, Production Friendly Microfacet
// Sheen BRDF, 2017, as KHR_materials_sheen has it.
#include <array>

#include "core/batch/lanes.h"
#include "core/lobe/albedo_table.h"
#include "core/lobe/draw.h"
#include "core/lobe/microfacet.h"

namespace whit {

namespace {

inline float charlie_alpha(float roughness) {
  const float r = clamp_to(roughness, kLeastSheenRoughness, 1.0f);
  return r * r;
}

/// The logarithm of Lambda between cosines of 0 and 0.5, fitted by its authors.
inline float log_lambda(float x, float alpha) {
  const float t = (1 - alpha) * (1 - alpha);
  const float a = lerp(t, 21.5473f, 25.3245f), b = lerp(t, 3.82987f, 3.32435f), c = lerp(t, 0.19823f, 0.16801f);
  const float d = lerp(t, -1.97760f, -1.27393f), e = lerp(t, -4.32054f, -4.85967f);
  return a / (1 + b * pow_of(max_of(x, 1e-20f), c)) + d * x + e;
}

/// Smith's Lambda of a direction at an absolute cosine.
inline float charlie_lambda(float cosine, float alpha) {
  const float c = min_of(cosine, 1.0f);
  const float half = log_lambda(0.5f, alpha), there = log_lambda(c < 0.5f ? c : 1 - c, alpha);
  return exp_of(c < 0.5f ? there : 2 * half - there);
}

/// Fibres by the squared sine of their angle to the normal, per steradian of projected area.
inline float charlie_distribution(float sin2, float alpha) {
  const float inv = 1 / alpha;
  return (2 + inv) * pow_of(max_of(sin2, 1e-20f), 0.5f * inv) * (0.5f * kInvPi);
}

/// Masking and shadowing over 4 cos cos, at most 1, as the extension's reference has it: it has no bound by itself.
inline float charlie_visibility(float zi, float zo, float lambda_i, float lambda_o) {
  const float below = (1 + lambda_i + lambda_o) * 4 * zi * zo;
  return below > 1 ? 1 / below : 1.0f;
}

void eval(const LobeQuery& q, const LobeValues& out) {
  const float* const roughness = q.lobe.a;
  for_pairs(q, out, [&](int i, const Pair& p, const auto& add_density) {
    const float alpha = charlie_alpha(roughness[i]), zi = std::abs(p.zi), zo = std::abs(p.zo);
    const float sin2 = min_of(across2(normalize(p.wo + p.wi), p.n), 1.0f);
    const float visible = charlie_visibility(zi, zo, charlie_lambda(zi, alpha), charlie_lambda(zo, alpha));
    const float reflects = reflects_in_front(q, p, i);
    accumulate(out.f, i, q.lobe.weight, charlie_distribution(sin2, alpha) * visible * zi * reflects);
    add_density(p.zo * p.zi > 0 ? 0.5f * kInvPi : 0.0f);
  });
}

/// Most of it is at grazing angles, to which few cosine-distributed directions go.
void draw(const LobeDraw& d) {
  draw_lanes(d, [](int, const Vec3f& wo, float u, float v) {
    const Vec3f w = uniform_hemisphere(u, v);
    return Vec3f(w.x, w.y, w.z * side_of(wo.z));
  });
}

void scale_strength(const Lobe& lobe, const ShadingBatch& s, float* to) {
  const AlbedoTable& albedo = sheen_albedo();
  for_lanes(s.n, [&](int i) { to[i] *= max_of(albedo(abs_dot(s.wo[i], s.ns[i]), sheen_position(lobe.a[i])), 0.05f); });
}

/// The integral over the hemisphere, by midpoints of a grid over the roots of cosines and half a turn.
class SheenIntegral {
 public:
  explicit SheenIntegral(float roughness) : alpha_(charlie_alpha(roughness)) {
    for (int k = 0; k < kUp; ++k) lambda_[static_cast<size_t>(k)] = charlie_lambda(cosine(k), alpha_);
    for (int k = 0; k < kAround; ++k) {
      cos_phi_[static_cast<size_t>(k)] = sin_cos_2pi(0.5f * (static_cast<float>(k) + 0.5f) / kAround).cos;
    }
  }

  double operator()(float zo) const {
    const float lambda_o = charlie_lambda(zo, alpha_), so = safe_sqrt((1 - zo) * (1 + zo));
    std::array<float, kUp * kAround> value;
    for_lanes(kUp * kAround, [&](int i) {
      const int up = i / kAround;
      const float zi = cosine(up), si = safe_sqrt((1 - zi) * (1 + zi));
      const float across = so * so + si * si + 2 * so * si * cos_phi_[static_cast<size_t>(i % kAround)];
      const float sin2 = max_of(across, 0.0f) / (max_of(across, 0.0f) + (zi + zo) * (zi + zo));
      const float visible = charlie_visibility(zi, zo, lambda_[static_cast<size_t>(up)], lambda_o);
      // The root of the cosine is even: dzi is twice the root.
      value[static_cast<size_t>(i)] = charlie_distribution(sin2, alpha_) * visible * zi * 2 * root(up);
    });
    double sum = 0;
    for (const float v : value) sum += static_cast<double>(v);
    return sum * 2 * detail::kPiD / (kUp * kAround);
  }

 private:
  static constexpr int kUp = 32, kAround = 16;
  static float root(int k) { return (static_cast<float>(k) + 0.5f) / kUp; }
  static float cosine(int k) { return root(k) * root(k); }

  float alpha_;
  std::array<float, kUp> lambda_;
  std::array<float, kAround> cos_phi_;
};

AlbedoTable tabulate() {
  AlbedoTable table;
  for (int y = 0; y < AlbedoTable::kPositions; ++y) {
    const float position = static_cast<float>(y) / (AlbedoTable::kPositions - 1);
    const SheenIntegral integral(lerp(position, kLeastSheenRoughness, 1));
    for (int x = 0; x < AlbedoTable::kCosines; ++x) {
      table.node(y, x) = static_cast<float>(integral(AlbedoTable::cosine_of(x)));
    }
  }
  return table;
}

}  // namespace

const AlbedoTable& sheen_albedo() {
  static const AlbedoTable table = tabulate();
  return table;
}

const LobeRow lobe_rows::CharlieSheen = {
    .name = "Charlie sheen",
    .effect = Effect::Diffuse,
    .reflects = true,
    .transmits = false,
    .scale_strength = scale_strength,
    .eval = eval,
    .sample = draw,
};

}  // namespace whit
