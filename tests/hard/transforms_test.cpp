// Case 13: transforms that are singular, nearly singular, sheared, mirrored, deeply nested or turning.
#include <fmt/core.h>

#include <random>

#include "core/scene/bake.h"
#include "tests/hard/hard_case.h"
#include "tests/hard/render_text.h"

namespace whit {
namespace {

using namespace test;

std::string statement(const char* name, const Mat4d& m) {
  std::string text = std::string(name) + " [";
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) text += fmt::format("{:.17g} ", m[r][c]);
  }
  return text + "]\n";
}

/// Those of `text` in a world block, as parsed.
ParseResult parsed(const std::string& text, Sources& sources) {
  return parse_text(sources, "test.pbrt", "WorldBegin\n" + text + "Shape \"sphere\"\nWorldEnd\n", "");
}

TEST(Hard, SingularTransforms) {
  // A matrix that flattens everything to a plane, a line or a point, turned before and after: what should be zero is
  // rounding noise of 1e-16 of the largest element. One that is as flat as 1e-10, turned likewise, is regular: a million
  // roundings away from singular.
  HardCase taken({13, "singular transforms", "flattened in 1, 2 and 3 axes, 200 rotations before and after each",
                  "how many are not refused", 0, ""});
  HardCase refused({13, "transforms of determinant 1e-20 to 1e-10",
                    "flattened as far in 1 and 2 axes, turned as before", "how many are refused", 0, ""});
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-1, 1);
  const auto turn = [&] {
    return fmt::format("Rotate {} {} {} {}\n", 180 * u(random), u(random), u(random), u(random));
  };
  for (int i = 0; i < 200; ++i) {
    const std::string before = turn(), after = turn();
    for (int axes = 1; axes < 8; ++axes) {
      const auto flat = [&](double z) {
        const Mat4d m = Mat4d().setScale(Vec3d(axes & 1 ? z : 1, axes & 2 ? z : 1, axes & 4 ? z : 1));
        return before + statement("ConcatTransform", m) + after;
      };
      Sources sources;
      const auto is_refused = [&](double z) {
        const ParseResult result = parsed(flat(z), sources);
        const SceneDescription& scene = result.scenes.at(0);
        return scene.is_singular(scene.shapes.at(0).transform);
      };
      taken.see(is_refused(0) ? 0 : 1, before);
      const int flattened = __builtin_popcount(static_cast<unsigned>(axes));
      refused.see(flattened < 3 && is_refused(1e-10) ? 1 : 0, before);
    }
  }
}

TEST(Hard, NestedTransformsCancel) {
  // 400 products of matrices, each of 4 roundings of 1.1e-16 in an element: 400 x 4 x 1.1e-16 = 1.8e-13 if they all agree.
  HardCase worst({13, "200 nested pairs of Rotate and Scale, and what undoes them",
                  "50 random sequences, in two orders", "largest element of the difference from the identity", 1e-12,
                  ""});
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int sequence = 0; sequence < 50; ++sequence) {
    std::string nested, undone, in_pairs;
    for (int i = 0; i < 200; ++i) {
      const double angle = 180 * u(random), scale = std::exp2(u(random));
      const std::string axis = fmt::format("{} {} {}", u(random), u(random), u(random));
      const std::string in = fmt::format("Rotate {0:.17g} {1} Scale {2:.17g} {2:.17g} {2:.17g}\n", angle, axis, scale);
      const std::string out =
          fmt::format("Scale {0:.17g} {0:.17g} {0:.17g} Rotate {1:.17g} {2}\n", 1 / scale, -angle, axis);
      nested += in, undone = out + undone;
      // Not the same along all axes, which nested 200 times would make a needle of 2^200.
      const double flat = std::exp2(u(random));
      in_pairs += in + fmt::format("Scale {:.17g} 1 1 Scale {:.17g} 1 1\n", flat, 1 / flat) + out;
    }
    for (const std::string& text : {nested + undone, in_pairs}) {
      Sources sources;
      const ParseResult result = parsed(text, sources);
      ASSERT_FALSE(result.diagnostics.has_errors());
      const SceneDescription& scene = result.scenes.at(0);
      const Mat4d m = scene.transforms[static_cast<size_t>(scene.shapes.at(0).transform)].start;
      for (int r = 0; r < 4; ++r) {
        for (int c = 0; c < 4; ++c)
          worst.see(std::abs(m[r][c] - (r == c ? 1 : 0)), fmt::format("sequence {}", sequence));
      }
    }
  }
}

// ---- Instances and baked meshes ----

/// A lumpy ball with normals, all of whose numbers a transform may be applied to here rather than in the renderer.
struct Ball {
  std::vector<Vec3d> points, normals;
  std::vector<int> indices;

  Ball() {
    for (int row = 0; row <= kRows; ++row) {
      for (int column = 0; column < kColumns; ++column) {
        const double theta = M_PI * (row + 0.1) / (kRows + 0.2), phi = 2 * M_PI * column / kColumns;
        const Vec3d n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
        normals.push_back(n), points.push_back(n * (0.8 + 0.15 * std::sin(3 * phi) * std::sin(theta)));
      }
    }
    for (int row = 0; row < kRows; ++row) {
      for (int column = 0; column < kColumns; ++column) {
        const int a = row * kColumns + column, b = row * kColumns + (column + 1) % kColumns;
        for (const int i : {a, a + kColumns, b, b, a + kColumns, b + kColumns}) indices.push_back(i);
      }
    }
  }

  void transform(const Mat4d& m) {
    const Mat4d to_normals = m.inverse().transposed();
    for (Vec3d& p : points) p = transform_point(m, p);
    // Their lengths differ now, and stay: normals are interpolated before they are made unit vectors.
    for (Vec3d& n : normals) n = transform_vector(to_normals, n);
    // The order of corners says which side is which, so it turns round with a mirroring.
    for (size_t i = 0; swaps_handedness(m) && i < indices.size(); i += 3) std::swap(indices[i], indices[i + 1]);
  }

  std::string shape() const {
    std::string text = "Shape \"trianglemesh\" \"integer indices\" [";
    for (const int i : indices) text += std::to_string(i) + ' ';
    text += "] \"point P\" [";
    for (const Vec3d& p : points) text += fmt::format("{:.17g} {:.17g} {:.17g} ", p.x, p.y, p.z);
    text += "] \"normal N\" [";
    for (const Vec3d& n : normals) text += fmt::format("{:.9g} {:.9g} {:.9g} ", n.x, n.y, n.z);
    return text + "]\n";
  }

 private:
  static constexpr int kRows = 8, kColumns = 16;
};

std::string picture_text(const std::string& material, const std::string& shape) {
  return "Film \"image\" \"integer xresolution\" 48 \"integer yresolution\" 48\n"
         "Sampler \"halton\" \"integer pixelsamples\" 4\nLookAt 0.3 -5 1.5  0 0 0  0 0 1\n"
         "Camera \"perspective\" \"float fov\" 40\nWorldBegin\n"
         "AttributeBegin Translate -3 -4 5 LightSource \"point\" \"rgb I\" [50 50 50] AttributeEnd\n"
         "LightSource \"infinite\" \"rgb L\" [.2 .25 .3]\nMaterial \"" +
         material + "\"\n" + shape + "WorldEnd\n";
}

std::vector<float> picture_of(const std::string& material, const std::string& shape) {
  return Rendered(picture_text(material, shape)).rgb();
}

TEST(Hard, InstancesAndBakedMeshes) {
  // The same numbers, rounded to float in the object's space, in render space, or after arithmetic in double here: off by
  // 1e-7 of the picture, which only a sample on an edge sees (see case 4).
  HardCase worst(
      {13, "an instance, a mesh under the transform, and one whose numbers were transformed",
       "7 transforms with shear and mirroring, each with determinants of 1, 1e-20 and 1e20; plastic and glass",
       "relMSE", 1e-6, ""});
  const Mat4d shear(1, 0.4, 0.2, 0, 0, 1, -0.7, 0, 0.3, 0, 1, 0, 0, 0, 0, 1);
  const Mat4d turn = Mat4d().rotate(Vec3d(1, 2, 3)), wide = Mat4d().setScale(Vec3d(1.2, 0.3, 0.9));
  const Mat4d mirror = Mat4d().setScale(Vec3d(1, -1, 1)), inside_out = Mat4d().setScale(-1.0);
  const Mat4d rest = Mat4d().setTranslation(Vec3d(0.2, 0.1, -0.1));
  for (const Mat4d& shape : {rest, mirror * rest, inside_out * rest, shear * rest, mirror * shear, wide * shear,
                             turn * wide * turn * mirror}) {
    for (const Vec3d& size : {Vec3d(1, 1, 1), Vec3d(1e-10, 1, 1e-10), Vec3d(1e-10, 1e-5, 1e-5), Vec3d(1e7, 1e6, 1e7)}) {
      // The ball is as much larger as the transform makes it smaller.
      Ball ball, baked;
      ball.transform(Mat4d().setScale(Vec3d(1 / size.x, 1 / size.y, 1 / size.z)));
      baked.transform(shape);
      const std::string m = statement("ConcatTransform", Mat4d().setScale(size) * shape);
      for (const std::string material : {"plastic", "glass"}) {
        const auto numbers = picture_of(material, baked.shape());
        const std::string at = fmt::format("{} size {} {} {}", material, size.x, size.y, size.z);
        worst.see(relative_mse(picture_of(material, m + ball.shape()), numbers), at + " under it");
        const std::string object = "ObjectBegin \"o\"\n" + ball.shape() + "ObjectEnd\n" + m + "ObjectInstance \"o\"\n";
        worst.see(relative_mse(picture_of(material, object), numbers), at + " instance");
      }
    }
  }
}

TEST(Hard, InstancesFlatterThanFloats) {
  // Up to 1e10 they are drawn, above. From 1e16 on they are refused; between, either may be, but the program lives.
  HardCase worst({13, "instances that flatten their object", "by 1e16 to 1e30, in one axis and in all",
                  "how many are not refused", 0, ""});
  for (const double by : {1e16, 1e18, 1e20, 1e25, 1e30}) {
    for (const char* axes : {"{0:g} 1 1", "{0:g} {0:g} {0:g}"}) {
      Planned planned(picture_text("matte", "Shape \"sphere\" ObjectBegin \"o\" Shape \"sphere\" ObjectEnd Scale " +
                                                fmt::format(fmt::runtime(axes), 1 / by) + " ObjectInstance \"o\"\n"));
      const BuiltWorld built = build_world(std::move(planned.world));
      worst.see(built.scene == nullptr && built.said.has_errors() ? 0 : 1, fmt::format("{} {}", axes, by));
    }
  }
}

// ---- Turning while the shutter is open ----

/// A pointer that starts at 20 degrees, seen along the axis or askew; `turning` comes before the shape's own statements.
std::string pointer(int samples, const std::string& camera, const std::string& turning, const std::string& shape) {
  return fmt::format(
      "Film \"image\" \"integer xresolution\" 12 \"integer yresolution\" 12\n"
      "Sampler \"halton\" \"integer pixelsamples\" {}\n{}"
      "Camera \"orthographic\" \"float screenwindow\" [-1.2 1.2 -1.2 1.2] \"float shutteropen\" 0 \"float "
      "shutterclose\" 1\n"
      "WorldBegin LightSource \"distant\" \"point from\" [0 0 5] \"point to\" [0 0 0] \"rgb L\" [3 3 "
      "3]\n{}{}WorldEnd\n",
      samples, camera, turning, shape);
}

constexpr char kPointer[] =
    "Rotate 20 0 0 1 Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [-.3 -.2 0  1 0 0  -.3 .3 0]\n";
constexpr char kView[] = "LookAt 0 0 5  0 0 0  0 1 0\n";

/// The mean of pictures in which the pointer stands still, at the middles of equal stretches of time.
std::vector<float> time_average(double by, const std::string& axis) {
  constexpr int kTimes = 180;
  std::vector<double> sum;
  for (int i = 0; i < kTimes; ++i) {
    const std::string turned = fmt::format("Rotate {:.17g} {}\n", by * (i + 0.5) / kTimes, axis);
    BuildOptions build;
    build.seed = static_cast<uint32_t>(i);
    const Rendered picture(pointer(16, kView, turned, kPointer), build);
    sum.resize(picture.rgb().size());
    for (size_t k = 0; k < sum.size(); ++k) sum[k] += static_cast<double>(picture.rgb()[k]) / kTimes;
  }
  return {sum.begin(), sum.end()};
}

TEST(Hard, TurningWhileTheShutterIsOpen) {
  // Brightness is at most 0.5 (Kd 0.5, irradiance 3: 0.48), so a pixel's variance is at most 0.24^2; with 4096 samples, and
  // 16 at each of 180 times (0.24^2 / 2880) in what is compared with, (r^2 + 0.01) of at least 0.07 where that variance is
  // reached: 0.058 (1 / 4096 + 1 / 2880) / 0.07 = 5e-4. Samplers are better than chance, so that is a bound.
  HardCase worst({13, "a pointer that turns while the shutter is open: as a shape, an instance and by the camera",
                  "0 to 359 degrees, about two axes", "relMSE against the mean of 180 still pictures", 5e-4, ""});
  for (const std::string axis : {"0 0 1", "1 -2 3"}) {
    for (const double degrees : {0., 1., 30., 90., 135., 179., 180., 181., 200., 270., 330., 359.}) {
      // As pbrt: the shorter way round. Half a turn has two, and rounding chooses.
      const auto still = time_average(degrees <= 180 ? degrees : degrees - 360, axis);
      const auto other = degrees == 180 ? time_average(-180, axis) : still;
      const auto error = [&](const std::string& camera, const std::string& turning, const std::string& shape) {
        const Rendered moving(pointer(4096, camera, turning, shape));
        return std::min(relative_mse(moving.rgb(), still), relative_mse(moving.rgb(), other));
      };
      const std::string turn = fmt::format("ActiveTransform EndTime Rotate {} {} ActiveTransform All\n", degrees, axis);
      const std::string object = std::string("ObjectBegin \"o\"\n") + kPointer + "ObjectEnd\n";
      const std::string at = fmt::format("{} degrees about {}", degrees, axis);
      worst.see(error(kView, turn, kPointer), at + " shape");
      worst.see(error(kView, object + turn, "ObjectInstance \"o\"\n"), at + " instance");
      // The light does not turn with the camera: about the view's own axis that makes no difference.
      if (axis != "0 0 1") continue;
      worst.see(error(kView + turn, "", kPointer), at + " camera");
    }
  }
}

}  // namespace
}  // namespace whit
