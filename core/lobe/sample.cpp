// Importance sampling of the non-specular lobes. Plain scalar code, lane by lane: the Whitted integrator
// samples lights and delta lobes only.
#include "core/lobe/disney.h"
#include "core/lobe/eval.h"
#include "core/lobe/formulas.h"
#include "core/lobe/fourier.h"
#include "core/lobe/hair.h"

namespace whit {

namespace {

/// One lane in the local frame (ss, ts, ns).
struct Local {
  Vec3f ss, ts, n, wo;
  Vec3f to_local(const Vec3f& w) const { return {dot(w, ss), dot(w, ts), dot(w, n)}; }
  Vec3f to_render(const Vec3f& w) const { return normalize(ss * w.x + ts * w.y + n * w.z); }
};

/// The half vector of two directions of render space in the local frame. In double, because of nearly smooth facets it
/// has to be known to a small part of alpha, and at grazing angles it is a small sum of two large vectors.
Vec3f half_vector(const Local& l, const Vec3f& wo, const Vec3f& wi) {
  const Vec3d sum = Vec3d(wo) + Vec3d(wi);
  const Vec3d local(sum.dot(Vec3d(l.ss)), sum.dot(Vec3d(l.ts)), sum.dot(Vec3d(l.n)));
  return Vec3f(local.normalized());
}

Local local_frame(const ShadingBatch& s, const LobeFrame& frame, int i) {
  Local l{frame.ss[i], frame.ts[i], s.ns[i], {}};
  l.wo = l.to_local(s.wo[i]);
  return l;
}

bool is_active(const Lobe& lobe, int i) { return !is_specular(lobe.type) && !is_black(lobe.weight[i]); }

/// The density of visible normals: D G1(wo) |wo . h| / |cos wo|. Heitz 2014.
float visible_normal_pdf(const Vec3f& wo, const Vec3f& h, float ax, float ay) {
  const float x = h.x / ax, y = h.y / ay;
  const float density = trowbridge_reitz(h.z * h.z + x * x + y * y, ax * ay);
  const float c = std::abs(wo.z);
  const float sx = wo.x * ax, sy = wo.y * ay;
  // G1 / |cos| = 2 / (|cos| + |cos| (1 + 2 Lambda))
  return density * abs_dot(wo, h) * 2 / (c + smith_term(c, sx * sx + sy * sy));
}

/// Samples the visible normals of the side wo is on. Heitz, Sampling the GGX Distribution of Visible Normals,
/// JCGT 2018.
Vec3f sample_visible_normal(const Vec3f& wo, float ax, float ay, float u, float v) {
  const float side = wo.z < 0 ? -1.0f : 1.0f;
  const Vec3f up = wo * side;
  const Vec3f stretched = normalize({ax * up.x, ay * up.y, up.z});
  const float r = safe_sqrt(u);
  const SinCos phi = sin_cos_2pi(v);
  const float t1 = r * phi.cos;
  const float weight = 0.5f * (1 + stretched.z);
  // A basis around the view whose first tangent is horizontal, as the projected half-disk needs.
  const float across = stretched.x * stretched.x + stretched.y * stretched.y;
  const float inv = across > 0 ? 1 / std::sqrt(across) : 0.0f;
  const Vec3f a = across > 0 ? Vec3f(-stretched.y * inv, stretched.x * inv, 0) : Vec3f(1, 0, 0);
  const Vec3f b = cross(stretched, a);
  const float t2 = lerp(weight, safe_sqrt(1 - t1 * t1), r * phi.sin);
  const Vec3f h = a * t1 + b * t2 + stretched * safe_sqrt(1 - t1 * t1 - t2 * t2);
  return normalize({ax * h.x, ay * h.y, max_of(h.z, 0.0f)}) * side;
}

/// `h` is the half vector, see half_vector().
float reflection_pdf(const Vec3f& wo, const Vec3f& wi, const Vec3f& h, float ax, float ay) {
  if (wo.z * wi.z <= 0) return 0;
  const float c = abs_dot(wo, h);
  return c > 0 ? visible_normal_pdf(wo, h, ax, ay) / (4 * c) : 0.0f;
}

float transmission_pdf(const Vec3f& wo, const Vec3f& wi, float ax, float ay, float eta) {
  if (wo.z * wi.z >= 0) return 0;
  const float n = relative_index(wo.z, eta);
  const Vec3f sum = wo + wi * n, h = normalize(sum);
  const float length2 = dot(sum, sum), oh = dot(wo, h), ih = dot(wi, h);
  // Facets seen from behind are not visible, hence never sampled.
  if (length2 == 0 || oh * ih > 0 || oh * h.z * wo.z <= 0) return 0;
  return visible_normal_pdf(wo, h, ax, ay) * n * n * std::abs(ih) / length2;
}

float lobe_pdf(const Lobe& lobe, int i, const Vec3f& wo, const Vec3f& wi, const Vec3f& h) {
  const float cosine = std::abs(wi.z) * kInvPi;
  switch (lobe.type) {
    case LobeType::LambertReflection:
    case LobeType::DisneyDiffuse:
    case LobeType::DisneyFakeSubsurface:
    case LobeType::DisneyRetro:
    case LobeType::DisneySheen:
    case LobeType::OrenNayar: return wo.z * wi.z > 0 ? cosine : 0.0f;
    case LobeType::LambertTransmission: return wo.z * wi.z < 0 ? cosine : 0.0f;
    case LobeType::DisneyReflection:
    case LobeType::MicrofacetReflection: return reflection_pdf(wo, wi, h, lobe.a[i], lobe.b[i]);
    case LobeType::FresnelBlend:
      return wo.z * wi.z > 0 ? 0.5f * (cosine + reflection_pdf(wo, wi, h, lobe.a[i], lobe.b[i])) : 0.0f;
    case LobeType::DisneyClearcoat: return clearcoat_pdf(lobe.a[i], wo, wi);
    case LobeType::Hair: return hair_pdf(lobe, i, wo, wi);
    case LobeType::Fourier: return fourier_pdf(*lobe.table, wo, wi);
    case LobeType::DisneyTransmission:
    case LobeType::MicrofacetTransmission: return transmission_pdf(wo, wi, lobe.a[i], lobe.b[i], lobe.eta[i]);
    case LobeType::SpecularReflection:
    case LobeType::SpecularTransmission: break;
  }
  return 0;
}

/// The density of a lane's direction wi, which is in render space.
float lane_pdf(const LobeSet& set, int i, const Local& l, const Vec3f& render_wo, const Vec3f& render_wi) {
  const Vec3f wo = l.wo, wi = l.to_local(render_wi), h = half_vector(l, render_wo, render_wi);
  float sum = 0;
  int count = 0;
  for (int k = 0; k < set.count; ++k) {
    if (!is_active(set.lobes[k], i)) continue;
    sum += lobe_pdf(set.lobes[k], i, wo, wi, h);
    ++count;
  }
  return count > 0 && wo.z != 0 ? sum / static_cast<float>(count) : 0.0f;
}

Vec3f cosine_hemisphere(float u, float v) {
  const float r = safe_sqrt(u);
  const SinCos phi = sin_cos_2pi(v);
  return {r * phi.cos, r * phi.sin, safe_sqrt(1 - u)};
}

/// The refraction of wo at facet normal h, which is on wo's side; zero in total internal reflection.
Vec3f refract_at(const Vec3f& wo, const Vec3f& h, float n) {
  const float c = dot(wo, h);
  const Refraction r = snell(c, n);
  if (r.g2 <= 0 || c <= 0) return {0, 0, 0};
  return (h * (-r.k / (r.c + r.g)) - wo) * (1 / n);
}

/// A direction by the lobe's own density; the zero vector when none comes out.
Vec3f sample_lobe(const Lobe& lobe, int i, const Vec3f& wo, float u, float v) {
  const float side = wo.z < 0 ? -1.0f : 1.0f;
  switch (lobe.type) {
    case LobeType::LambertReflection:
    case LobeType::DisneyDiffuse:
    case LobeType::DisneyFakeSubsurface:
    case LobeType::DisneyRetro:
    case LobeType::DisneySheen:
    case LobeType::OrenNayar: {
      const Vec3f w = cosine_hemisphere(u, v);
      return {w.x, w.y, w.z * side};
    }
    case LobeType::LambertTransmission: {
      const Vec3f w = cosine_hemisphere(u, v);
      return {w.x, w.y, -w.z * side};
    }
    case LobeType::FresnelBlend: {
      // Half of the samples for the diffuse part, half for the coat, whose first number is stretched again.
      if (u < 0.5f) {
        const Vec3f w = cosine_hemisphere(2 * u, v);
        return {w.x, w.y, w.z * side};
      }
      const Vec3f h = sample_visible_normal(wo, lobe.a[i], lobe.b[i], 2 * u - 1, v);
      const Vec3f wi = h * (2 * dot(wo, h)) - wo;
      return wi.z * wo.z > 0 ? wi : Vec3f(0, 0, 0);
    }
    case LobeType::DisneyReflection:
    case LobeType::MicrofacetReflection: {
      const Vec3f h = sample_visible_normal(wo, lobe.a[i], lobe.b[i], u, v);
      const Vec3f wi = h * (2 * dot(wo, h)) - wo;
      return wi.z * wo.z > 0 ? wi : Vec3f(0, 0, 0);
    }
    case LobeType::DisneyClearcoat: return sample_clearcoat(lobe.a[i], wo, u, v);
    case LobeType::Hair: return sample_hair(lobe, i, wo, u, v);
    case LobeType::Fourier: return sample_fourier(*lobe.table, wo, u, v);
    case LobeType::DisneyTransmission:
    case LobeType::MicrofacetTransmission: {
      const Vec3f h = sample_visible_normal(wo, lobe.a[i], lobe.b[i], u, v);
      const Vec3f wi = refract_at(wo, h, relative_index(wo.z, lobe.eta[i]));
      return wi.z * wo.z < 0 ? wi : Vec3f(0, 0, 0);
    }
    case LobeType::SpecularReflection:
    case LobeType::SpecularTransmission: break;
  }
  return {0, 0, 0};
}

/// Samples one lane; the zero vector when no direction comes out.
Vec3f sample_lane(const LobeSet& set, int i, const Vec3f& wo, float lobe_u, float u, float v) {
  int count = 0;
  for (int k = 0; k < set.count; ++k) count += is_active(set.lobes[k], i);
  if (count == 0 || wo.z == 0) return {0, 0, 0};
  int chosen = static_cast<int>(min_of(lobe_u * static_cast<float>(count), static_cast<float>(count - 1)));
  int k = 0;
  while (!is_active(set.lobes[k], i) || chosen-- > 0) ++k;
  return sample_lobe(set.lobes[k], i, wo, u, v);
}

}  // namespace

void pdf_lobes(const LobeSet& set, const ShadingBatch& s, const LobeFrame& frame, const Vec3Lanes& wi, float* pdf) {
  for (int i = 0; i < s.n; ++i) {
    const Local l = local_frame(s, frame, i);
    pdf[i] = lane_pdf(set, i, l, s.wo[i], wi[i]);
  }
}

void sample_lobes(const LobeSet& set, const ShadingBatch& s, const LobeFrame& frame, const float* lobe_u,
                  const float* u, const float* v, const Vec3Lanes& wi, const RGBLanes& f, float* pdf) {
  for (int i = 0; i < s.n; ++i) {
    const Local l = local_frame(s, frame, i);
    const Vec3f w = sample_lane(set, i, l.wo, lobe_u[i], u[i], v[i]);
    const bool sampled = dot(w, w) > 0;
    wi.set(i, sampled ? l.to_render(w) : -s.wo[i]);
    pdf[i] = sampled ? lane_pdf(set, i, l, s.wo[i], wi[i]) : 0.0f;
  }
  eval_lobes(set, s, frame, wi, f);
  for_lanes(s.n, [&](int i) {
    const float on = pdf[i] > 0 ? 1.0f : 0.0f;
    f.r[i] *= on, f.g[i] *= on, f.b[i] *= on;
  });
}

}  // namespace whit
