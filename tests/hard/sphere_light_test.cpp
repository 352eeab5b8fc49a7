// Case 6: the light of spheres, from far away and from right at their surface. A sphere of radius R and radiance L whose
// centre is D away lights a surface, when all of it is above the horizon, like a disk that fills its cone: the irradiance
// is pi L (R / D)^2 cos, so a wall of reflectance 0.5 shows 0.5 L (R / D)^2 cos, whatever D is.
#include <fmt/core.h>

#include "tests/hard/hard_case.h"
#include "tests/hard/render_text.h"
#include "tests/plugins/make_plugin.h"

namespace whit {
namespace {

using namespace test;

/// A wall in the plane z = 0 at the origin, seen by a camera that looks at a spot a thousand times smaller than `size`.
std::string wall_at_origin(double size, const std::string& world) {
  return fmt::format(
      "Film \"image\" \"integer xresolution\" 2 \"integer yresolution\" 2\n"
      "Sampler \"halton\" \"integer pixelsamples\" 1024\nLookAt {0:.17g} 0 {0:.17g}  0 0 0  0 1 0\n"
      "Camera \"orthographic\" \"float screenwindow\" [{1:.9g} {2:.9g} {1:.9g} {2:.9g}]\nWorldBegin\n"
      "AttributeBegin Material \"matte\" \"rgb Kd\" [.5 .5 .5] Shape \"disk\" \"float radius\" {3:.9g} AttributeEnd\n"
      "{4}\nWorldEnd\n",
      size / 2, -size / 1000, size / 1000, size * 9, world);
}

TEST(Hard, SphereLightsFarAway) {
  HardCase worst({6, "a wall lit by a sphere, its power compensated",
                  "distance 2 to 1e6 radii, radius 1e-6 to 1e6, at 0 and 45 degrees", "relative error against 0.5",
                  5e-3, "0.514 at 1000, 0.434 at 2000, 0.876 at 4000, 0 from 6000"});
  for (const double distance : {2., 3., 5., 10., 30., 100., 1e3, 2e3, 4e3, 6e3, 1e4, 1e5, 3e5, 1e6}) {
    for (const double radius : {1e-6, 1.0, 1e6}) {
      for (const double cosine : {1.0, std::sqrt(0.5)}) {
        const double across = distance * radius * std::sqrt(1 - cosine * cosine);
        const Rendered picture(wall_at_origin(
            radius, fmt::format("AreaLightSource \"diffuse\" \"rgb L\" [{0:.9g} {0:.9g} {0:.9g}]\n"
                                "Translate 0 {1:.17g} {2:.17g} Shape \"sphere\" \"float radius\" {3:.9g}",
                                distance * distance / cosine, across, distance * radius * cosine, radius)));
        for (const float v : picture.rgb()) {
          worst.see(std::abs(static_cast<double>(v) / 0.5 - 1),
                    fmt::format("distance {} radius {} cosine {}", distance, radius, cosine));
        }
      }
    }
  }
}

/// The light that arrives at a point near a sphere of radiance 1: its solid angle and the vector of its irradiance, by
/// midpoints of strata; and how far the sampled points are from the sphere, in radii.
struct Arriving {
  double solid_angle = 0, off_the_surface = 0;
  Vec3d vector{0, 0, 0};

  Arriving(const AnalyticShape& sphere, double radius, const Vec3f& at) {
    for (int row = 0; row < kStrata; ++row) add_row(sphere, radius, at, (row + 0.5f) / kStrata);
  }

 private:
  static constexpr int kStrata = 128;
  void add_row(const AnalyticShape& sphere, double radius, const Vec3f& at, float u0) {
    Triples ref(kStrata), wi(kStrata);
    std::vector<float> u(kStrata, u0), v(kStrata), distance(kStrata), cosine(kStrata), pdf(kStrata);
    for (int i = 0; i < kStrata; ++i) ref.vec3().set(i, at), v[i] = (i + 0.5f) / kStrata;
    sphere.sample_lanes(
        {kStrata, ref.vec3(), u.data(), v.data(), wi.vec3(), distance.data(), cosine.data(), pdf.data()});
    for (int i = 0; i < kStrata; ++i) {
      if (pdf[i] == 0) continue;
      const Vec3d direction(wi[i]), end = Vec3d(at) + direction * static_cast<double>(distance[i]);
      const double weight = 1 / (static_cast<double>(pdf[i]) * kStrata * kStrata);
      solid_angle += weight, vector += direction * weight;
      const double off = std::abs(end.length() / radius - 1) + std::abs(direction.length() - 1);
      off_the_surface = std::isfinite(off + weight) ? std::max(off_the_surface, off) : INFINITY;
    }
  }
};

TEST(Hard, PointsAtTheSurfaceOfSphereLights) {
  HardCase angle({6, "the solid angle of a sphere from just above and just below its surface",
                  "gaps of 1e-7 to 0.3 radii, radius 0.01 to 100, 4 directions", "relative error", 5e-3, ""});
  HardCase vector({6, "the light of a sphere, as a vector, at the same points", "as above", "error, of pi", 5e-3, ""});
  HardCase off({6, "sampled points, at the same points", "as above", "distance from the sphere, in radii", 1e-5, ""});
  for (const double radius : {0.01, 1.0, 100.0}) {
    const auto sphere = make_plugin<AnalyticShape>("shape", "sphere", {floats("radius", {radius})});
    for (const bool inward : {false, true}) {
      sphere->place(Mat4d(), inward);
      const double exact = static_cast<double>(static_cast<float>(radius));
      for (const double gap : {1.2e-7, 1e-6, 1e-4, 0.01, 0.3, -1.2e-7, -1e-6, -1e-4, -0.01, -0.3}) {
        for (const Vec3d& d : {Vec3d(0, 0, 1), Vec3d(-1, 0, 0), Vec3d(.6, .48, .64), Vec3d(.48, -.6, -.64)}) {
          const Vec3f at(d * exact * (1 + gap));
          // The float is where it is: from there, the formulas in double.
          const double distance = Vec3d(at).length(), gap_now = distance - exact;
          const double cosine = gap_now > 0 ? std::sqrt(gap_now * (distance + exact)) / distance : -1;
          const double solid_angle = 2 * M_PI * (1 - cosine), sine = exact / distance;
          // Around a point inside, light comes from everywhere alike: the sum of its directions is 0.
          const Vec3d sum = gap_now > 0 ? -Vec3d(at) / distance * M_PI * sine * sine : Vec3d(0, 0, 0);
          const Arriving found(*sphere.plugin, exact, at);
          const std::string where = fmt::format("radius {} gap {} towards {} {} {}", radius, gap, d.x, d.y, d.z);
          angle.see(std::abs(found.solid_angle / solid_angle - 1), where);
          vector.see((found.vector - sum).length() / M_PI, where);
          off.see(found.off_the_surface, where);
        }
      }
    }
  }
}

TEST(Hard, WallsAtTheSurfaceOfSphereLights) {
  // Above: the light is not seen, for its material is none, but it shines; the camera is inside of it, and looks at a wall that
  // almost touches it. The wall's normal points to the centre, so it shows 0.5 (1 / (1 + gap))^2. Below: the sphere shines
  // inwards, and wherever the wall looks it sees radiance 1, so it shows 0.5.
  HardCase worst({6, "walls that nearly touch a sphere that lights them",
                  "gaps of 1e-7 to 0.1 radii, outside and inside", "relative error of a pixel", 5e-3, ""});
  for (const double radius : {1e-3, 1.0, 1e3}) {
    for (const double gap : {1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 0.01, 0.1}) {
      const auto light = [&](const char* kind, double at) {
        return fmt::format(
            "Translate 0 0 {:.17g} AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n{} \"float radius\" {:.9g}", at, kind,
            radius);
      };
      const Rendered above(
          wall_at_origin(radius / 10, light("Material \"none\" Shape \"sphere\"", radius * (1 + gap))));
      for (const float v : above.rgb()) {
        const double expected = 0.5 / ((1 + gap) * (1 + gap));
        worst.see(std::abs(static_cast<double>(v) / expected - 1), fmt::format("radius {} above by {}", radius, gap));
      }
      // A wall small enough to be inside; the camera stands nearer to it than its far side is.
      const double room = std::min(std::sqrt(gap), 0.1) * radius;
      const Rendered below(wall_at_origin(room / 9, light("ReverseOrientation Shape \"sphere\"", radius * (1 - gap))));
      for (const float v : below.rgb()) {
        worst.see(std::abs(static_cast<double>(v) / 0.5 - 1), fmt::format("radius {} below by {}", radius, gap));
      }
    }
  }
}

}  // namespace
}  // namespace whit
