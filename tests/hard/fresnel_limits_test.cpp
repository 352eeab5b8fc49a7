// Case 7: where Fresnel's and Snell's formulas are at their limits: at the critical angle, and at no boundary at all.
#include <limits>
#include <vector>

#include "tests/hard/glass.h"
#include "tests/hard/hard_case.h"
#include "tests/lobe/lobe_bench.h"

namespace whit {
namespace {

using namespace test;

/// The directions at angles theta to the normal, from the side `side`.
std::vector<Vec3f> at_angles(const std::vector<double>& thetas, int side) {
  std::vector<Vec3f> all;
  for (const double theta : thetas) {
    const double s = std::sin(theta);
    all.push_back(Vec3f(Vec3d(s * std::cos(1), s * std::sin(1), side * std::cos(theta))));
  }
  return all;
}

/// The weights of both specular lobes at a smooth boundary, and where its refracted rays go.
struct Boundary {
  std::vector<double> reflected, refracted;
  std::vector<Vec3f> wi;

  Boundary(const std::vector<Vec3f>& wo, float index) {
    const int n = static_cast<int>(wo.size());
    Bench bench(n);
    bench.add(LobeType::SpecularReflection, 0, 0, index), bench.add(LobeType::SpecularTransmission, 0, 0, index);
    for (int i = 0; i < n; ++i) bench.s.wo.set(i, wo[static_cast<size_t>(i)]);
    specular_reflection(bench.set, bench.s, nullptr, bench.wi, bench.f);
    for (int i = 0; i < n; ++i) reflected.push_back(static_cast<double>(bench.f.r[i]));
    specular_transmission(bench.set, bench.s, nullptr, bench.wi, bench.f);
    for (int i = 0; i < n; ++i) refracted.push_back(static_cast<double>(bench.f.r[i])), wi.push_back(bench.wi[i]);
  }
};

TEST(Hard, CriticalAngle) {
  // From the dense side at the critical angle, sin = n (far over near, below 1), and 1e-8 to 1e-1 beside it. All light is
  // reflected or refracted, the scaling of radiance by 1 / n^2 taken back: three roundings of numbers up to 1.
  HardCase sum({7, "reflectance + transmittance at the critical angle +- 1e-8 to 1e-1",
                "index 1 + 1e-6 to 1000, from both sides", "deviation from 1", 1e-6, ""});
  // The reflectance has an endless slope there, so it is compared with the exact ones where the squared cosine is 2e-7
  // smaller and larger: n is rounded by up to 3e-8 below 1, n^2 and with it n^2 - 1 by twice that, the squared cosine by
  // 6e-8, and so is their sum.
  HardCase value({7, "reflectance at the critical angle +- 1e-8 to 1e-1", "index 1.001 to 3, from both sides",
                  "error, the squared cosine being known to 2e-7", 2e-6, ""});
  for (const double index : {1.000001, 1.001, 1.1, 1.333, 1.5, 2.4, 3.0, 1000.0}) {
    for (const bool inside : {true, false}) {
      // Seen from inside, with the index; or from outside of something thinner, with its inverse.
      const float eta = static_cast<float>(inside ? index : 1 / index);
      const double n = inside ? 1 / static_cast<double>(eta) : static_cast<double>(eta);
      std::vector<double> thetas = {std::asin(n)};
      for (double delta = 1e-8; delta < 0.2; delta *= std::sqrt(10)) {
        for (const double theta : {std::asin(n) - delta, std::asin(n) + delta}) {
          if (theta > 0 && theta < M_PI / 2) thetas.push_back(theta);
        }
      }
      const std::vector<Vec3f> wo = at_angles(thetas, inside ? -1 : 1);
      const Boundary b(wo, eta);
      for (size_t i = 0; i < wo.size(); ++i) {
        const std::string at =
            fmt::format("index {} angle {} from {}", index, thetas[i], inside ? "inside" : "outside");
        sum.see(std::abs(b.reflected[i] + b.refracted[i] * n * n - 1), at);
        if (index < 1.001 || index > 3) continue;
        const double c = std::abs(static_cast<double>(wo[i].z));
        const double high = reflectance(std::sqrt(std::max(0.0, c * c - 2e-7)), n);
        const double low = reflectance(std::min(1.0, std::sqrt(c * c + 2e-7)), n);
        value.see(std::max({0.0, low - b.reflected[i], b.reflected[i] - high}), at);
      }
    }
  }
}

TEST(Hard, GrazingAngles) {
  // The same sum far from the critical angle, down to the last cosines: from outside of denser matter R goes to 1.
  HardCase sum({7, "reflectance + transmittance at grazing angles", "cosine 1 to 1e-30, index 0.01 to 100, both sides",
                "deviation from 1", 1e-6, ""});
  for (const float index : {0.01f, 0.5f, 0.999999f, 1.000001f, 1.5f, 3.0f, 100.0f}) {
    for (const int side : {1, -1}) {
      std::vector<Vec3f> wo;
      for (double c = 1; c > 1e-30; c *= 0.7) { wo.push_back(Vec3f(Vec3d(std::sqrt((1 - c) * (1 + c)), 0, side * c))); }
      const Boundary b(wo, index);
      const double n = side > 0 ? static_cast<double>(index) : 1 / static_cast<double>(index);
      for (size_t i = 0; i < wo.size(); ++i) {
        sum.see(std::abs(b.reflected[i] + b.refracted[i] * n * n - 1),
                fmt::format("index {} cosine {}", index, wo[i].z));
      }
    }
  }
}

TEST(Hard, IndexOneIsInvisible) {
  // Nothing is reflected, all goes on, and straight: exactly, at every cosine, the smallest numbers and 0 included.
  HardCase lobes({7, "a boundary of index 1: the lobes", "cosines 1 to 1e-45 and 0, both sides",
                  "reflectance, lost transmittance, bend", 1e-6, "reflects everything at cosines below 7e-4"});
  for (const int side : {1, -1}) {
    std::vector<Vec3f> wo;
    for (double c = 1; c > 1e-46; c *= 0.5) wo.push_back(Vec3f(Vec3d(0, std::sqrt((1 - c) * (1 + c)), side * c)));
    const Boundary b(wo, 1);
    for (size_t i = 0; i < wo.size(); ++i) {
      lobes.see(b.reflected[i] + std::abs(b.refracted[i] - 1) + static_cast<double>((b.wi[i] + wo[i]).length()),
                fmt::format("cosine {}", wo[i].z));
    }
  }
}

/// A picture of a sky that differs in every direction, past `shape` of index 1.
Rendered past(const std::string& shape, double height, double fov) {
  return Rendered(
      fmt::format("Film \"image\" \"integer xresolution\" 8 \"integer yresolution\" 8\n"
                  "Sampler \"halton\" \"integer pixelsamples\" 4\nIntegrator \"whitted\" \"integer maxdepth\" 12\n"
                  "LookAt 0 0 {:.17g}  100 0 0  0 0 1\nCamera \"perspective\" \"float fov\" {:.17g}\n"
                  "WorldBegin LightSource \"skybox\" \"rgb L\" [1 1 1]\n{}\nWorldEnd\n",
                  height, fov, shape));
}

TEST(Hard, IndexOneIsInvisibleInPictures) {
  // The camera looks along a plane from a height of 100 cosines, so that its central ray meets it at 100; what is behind,
  // a sky whose colour is its direction, must look as without the plane. The field of view is a tenth of the angle.
  HardCase pictures({7, "index 1 in pictures",
                     "planes (disk, mesh) at cosines 1e-1 to 1e-8, a sphere from inside and at its "
                     "rim, both glasses",
                     "largest difference of a pixel from the empty scene", 1e-6,
                     "black or mirroring at cosines below 7e-4"});
  for (const char* glass : {"glass", "perfectglass"}) {
    const std::string material = fmt::format("Material \"{}\" \"float index\" 1 ", glass);
    const auto compare = [&](const std::string& shape, double height, double fov) {
      const Rendered seen = past(material + shape, height, fov), bare = past("", height, fov);
      EXPECT_GT(seen.result.statistics.refraction_rays, 0) << shape << ' ' << height;  // it was met
      for (size_t i = 0; i < seen.rgb().size(); ++i) {
        pictures.see(std::abs(static_cast<double>(seen.rgb()[i]) - static_cast<double>(bare.rgb()[i])),
                     fmt::format("{} {} at height {}", glass, shape, height));
      }
    };
    for (double cosine = 0.1; cosine > 0.9e-8; cosine *= 0.1) {
      const double fov = 0.1 * cosine * 180 / M_PI;
      compare("Shape \"disk\" \"float radius\" 1000", 100 * cosine, fov);
      compare("Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [-999 -999 0 999 -999 0 0 9999 0]",
              100 * cosine, fov);
      // The rim of a sphere: a line at 1 - cosine^2 / 2 of its radius.
      compare("Translate 50 0 0 Shape \"sphere\" \"float radius\" 10", 10 * (1 - cosine * cosine / 2), 0.1);
    }
    compare("Shape \"sphere\" \"float radius\" 50", 1, 90);
    compare("Translate 50 0 0 Shape \"sphere\" \"float radius\" 10", 1, 90);
  }
}

}  // namespace
}  // namespace whit
