// The albedo of microfacets, by integration over the facets that a direction sees.
#include <vector>

#include "core/batch/lanes.h"
#include "core/lobe/albedo_table.h"
#include "core/lobe/microfacet.h"

namespace whit {

namespace {

/// Midpoints of a grid over the numbers that visible facets are drawn by. Facets on either side of the plane of
/// incidence reflect the same, so that one side is enough.
constexpr int kAcross = 48, kAround = 24, kFacets = kAcross * kAround;

struct Facets {
  std::array<float, kFacets> u, v;
  Facets() {
    for (size_t k = 0; k < kFacets; ++k) {
      u[k] = (static_cast<float>(k / kAround) + 0.5f) / kAcross;
      v[k] = 0.5f * (static_cast<float>(k % kAround) + 0.5f) / kAround;
    }
  }
};

struct Parts {
  double f0, f90;
};

/// What facets reflect of f0 and of f90: the mean of G(wo, wi) / G1(wo) over those that wo sees. Heitz 2014.
Parts integrate(const Facets& facets, float z, float alpha) {
  const Vec3f wo(safe_sqrt((1 - z) * (1 + z)), 0, z);
  std::array<float, kFacets> reflected, grazing;
  for_lanes(kFacets, [&](int i) {
    const auto k = static_cast<size_t>(i);
    const Vec3f h = sample_visible_normal(wo, alpha, alpha, facets.u[k], facets.v[k]);
    const float c = dot(wo, h), zi = 2 * c * h.z - z;
    const Isotropic d{alpha};
    const float so = d.smith(wo, z), si = d.smith(wo, zi), sum = so * zi + si * z;
    reflected[k] = zi > 0 && sum > 0 ? zi * (z + so) / sum : 0.0f;
    grazing[k] = schlick_weight(clamp_to(c, 0.0f, 1.0f));
  });
  Parts parts{0, 0};
  for (size_t k = 0; k < kFacets; ++k) {
    const double all = reflected[k], share = grazing[k];
    parts.f0 += all * (1 - share), parts.f90 += all * share;
  }
  return {parts.f0 / kFacets, parts.f90 / kFacets};
}

/// A mirror's.
Parts smooth(float cosine) {
  const double grazing = schlick_weight(cosine);
  return {1 - grazing, grazing};
}

/// The alpha that a node of the tables stands for, see FacetAlbedo::position().
float alpha_of(int node) {
  return pow_of(kMinAlpha, 1 - static_cast<float>(node - 1) / static_cast<float>(AlbedoTable::kPositions - 2));
}

}  // namespace

double AlbedoTable::mean(int position) const {
  // With x the root of the cosine, 2 mu dmu is 4 x^3 dx; the function is linear in x between nodes.
  double sum = 0;
  for (int c = 0; c + 1 < kCosines; ++c) {
    const double a = static_cast<double>(c) / (kCosines - 1), b = static_cast<double>(c + 1) / (kCosines - 1);
    const double a4 = a * a * a * a, b4 = b * b * b * b;
    const double all = b4 - a4, rising = (0.8 * (b4 * b - a4 * a) - a * all) / (b - a);
    sum += static_cast<double>(node(position, c)) * (all - rising);
    sum += static_cast<double>(node(position, c + 1)) * rising;
  }
  return sum;
}

FacetAlbedo::FacetAlbedo() {
  const Facets facets;
  for (int y = 0; y < AlbedoTable::kPositions; ++y) {
    for (int x = 0; x < AlbedoTable::kCosines; ++x) {
      const float cosine = AlbedoTable::cosine_of(x);
      const Parts parts = y == 0 ? smooth(cosine) : integrate(facets, cosine, alpha_of(y));
      of_f0_.node(y, x) = static_cast<float>(parts.f0), of_f90_.node(y, x) = static_cast<float>(parts.f90);
    }
    mean_f0_[static_cast<size_t>(y)] = static_cast<float>(of_f0_.mean(y));
    mean_f90_[static_cast<size_t>(y)] = static_cast<float>(of_f90_.mean(y));
  }
}

const FacetAlbedo& facet_albedo() {
  static const FacetAlbedo albedo;
  return albedo;
}

}  // namespace whit
