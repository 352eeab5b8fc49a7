// Case 16: switches of the arithmetic that must not matter. The instruction set of the ray tracer decides how it rounds
// (fused multiply-add from AVX2 on) and in which order packets meet boxes: distances differ in their last digits, 1e-7,
// which the picture shows as 1e-14, squared, but where a sample is on an edge (see case 4). Whole programs for different
// processors are compared in tests/render/instruction_sets_test.py.
#include <fmt/core.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include "tests/accel/instruction_sets.h"
#include "tests/hard/hard_case.h"
#include "tests/hard/render_text.h"
#include "tests/plugins/make_plugin.h"

namespace whit {
namespace {

using namespace test;

/// Meshes and analytic shapes at a scale; glass, mirrors, a rough metal, a soft light and a point light.
std::string scene_at(double scale) {
  return fmt::format(
      "Film \"image\" \"integer xresolution\" 96 \"integer yresolution\" 64\nSampler \"halton\" \"integer "
      "pixelsamples\" 8\n"
      "LookAt 0 2 6  0 0.5 0  0 1 0\nScale {1:.17g} {1:.17g} {1:.17g}\n"
      "Camera \"perspective\" \"float fov\" 40\nWorldBegin Scale {0:.17g} {0:.17g} {0:.17g}\n"
      "AttributeBegin Translate 2 4 3 LightSource \"point\" \"rgb I\" [{2:.9g} {2:.9g} {2:.9g}] AttributeEnd\n"
      "LightSource \"infinite\" \"rgb L\" [.1 .12 .15]\n"
      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [5 5 5] Translate -2 3 0 Shape \"sphere\" AttributeEnd\n"
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [-5 0 -5  -5 0 5  5 0 5  5 0 -5]\n"
      "Translate -1.3 0.5 0 Material \"plastic\" AttributeBegin Scale .5 .5 .5 Shape \"loopsubdiv\" \"integer levels\" "
      "4 "
      "\"integer indices\" [0 1 2 0 2 3 0 3 4 0 4 1 5 2 1 5 3 2 5 4 3 5 1 4] "
      "\"point P\" [0 0 1 1 0 0 0 1 0 -1 0 0 0 -1 0 0 0 -1] AttributeEnd\n"
      "Translate 1.3 0 0 Material \"glass\" Shape \"sphere\" \"float radius\" 0.5\n"
      "Translate 1.3 0 0 Material \"mirror\" Shape \"cylinder\" \"float radius\" 0.3\n"
      "Translate -0.6 -0.5 1.3 Rotate -90 1 0 0 Material \"metal\" Shape \"cone\" \"float radius\" 0.3\nWorldEnd\n",
      scale, 1 / scale, 20 * scale * scale);
}

/// The same geometry in another ray tracer; the scene has neither instances nor curves nor alpha.
void trace_with(Scene& scene, const AccelOptions& options) {
  auto accel = std::make_unique<Accel>(options);
  for (size_t i = 0; i < scene.shapes.size(); ++i) {
    const SceneShape& shape = scene.shapes[i];
    const int index = static_cast<int>(i);
    if (shape.mesh) {
      const Mesh& m = *shape.mesh;
      accel->add_mesh(Accel::kWorld, {m.positions.data(), m.positions.size() / 3, m.indices.data(), m.triangle_count()},
                      index, nullptr);
    } else {
      accel->add_analytic(Accel::kWorld, *shape.analytic, index, nullptr);
    }
  }
  ASSERT_EQ(accel->build(), "");
  scene.accel = std::move(accel);
}

std::vector<float> picture(const BuiltScene& built, int threads = 0) {
  RenderOptions options;
  options.threads = threads;
  const RenderResult result = render(*built.scene, options);
  EXPECT_EQ(result.statistics.invalid_samples, 0);
  return result.picture.rgb;
}

/// Denormal numbers flushed to zero, or not, while it lives.
class FlushMode {
 public:
  explicit FlushMode(bool flush) : saved_(_mm_getcsr()) {
    _MM_SET_FLUSH_ZERO_MODE(flush ? _MM_FLUSH_ZERO_ON : _MM_FLUSH_ZERO_OFF);
    _MM_SET_DENORMALS_ZERO_MODE(flush ? _MM_DENORMALS_ZERO_ON : _MM_DENORMALS_ZERO_OFF);
  }
  ~FlushMode() { _mm_setcsr(saved_); }
  FlushMode(const FlushMode&) = delete;
  FlushMode& operator=(const FlushMode&) = delete;

 private:
  unsigned saved_;
};

constexpr double kScales[] = {1e-12, 1e-6, 1, 1e6, 1e12};

TEST(Hard, InstructionSetsOfTheRayTracer) {
  HardCase worst({16, "Embree's instruction sets, and coherent or single traversal of packets",
                  "SSE2, SSE4.2, AVX, AVX2, AVX-512 where the processor has them; scales of 1e-12 to 1e12",
                  "relMSE against the picture of the default", 1e-6, ""});
  const std::vector<std::string> sets = instruction_sets();
  for (const double scale : kScales) {
    const BuiltScene built(scene_at(scale));
    const std::vector<float> as_is = picture(built);
    for (const std::string& set : sets) {
      for (const double small_scene : {0.0, 1e9}) {
        trace_with(*built.scene, {.robust = true, .small_scene = small_scene, .embree = set});
        worst.see(relative_mse(picture(built), as_is),
                  fmt::format("{} coherent below {} scale {}", set, small_scene, scale));
      }
    }
  }
}

TEST(Hard, FlushingDenormalsAndThreads) {
  // Rendering sets its own mode. What is read and built in the caller's mode is in double, where nothing is as small.
  HardCase worst({16, "denormal numbers flushed to zero or not while the scene is built; threads",
                  "scales of 1e-12 to 1e12; 1 to 5 threads", "relMSE between the pictures", 1e-6, ""});
  for (const double scale : kScales) {
    std::vector<float> kept, flushed;
    {
      const FlushMode mode(false);
      kept = picture(BuiltScene(scene_at(scale)));
    }
    {
      const FlushMode mode(true);
      flushed = picture(BuiltScene(scene_at(scale)));
    }
    worst.see(relative_mse(flushed, kept), fmt::format("flushed, scale {}", scale));
    const BuiltScene built(scene_at(scale));
    for (const int threads : {1, 2, 5}) {
      worst.see(relative_mse(picture(built, threads), kept), fmt::format("{} threads, scale {}", threads, scale));
    }
  }
}

/// Distances along n rays from around the camera into the scene, in calls of `batch` rays at a time; -1 for a miss.
std::vector<float> distances(const Scene& scene, int n, int batch, bool coherent) {
  Triples o(n), d(n);
  for (int i = 0; i < n; ++i) {
    // A spiral over the directions (R. Swinbank and R. J. Purser 2006).
    const double z = 1 - (2 * i + 1.0) / n, across = std::sqrt(1 - z * z), phi = i * 2.399963229728653;
    const Vec3d unit(across * std::cos(phi), across * std::sin(phi), z);
    o.vec3().set(i, {0, 0, 0}), d.vec3().set(i, Vec3f(unit));
  }
  std::vector<float> t(n), u(n), v(n), out(n);
  std::vector<int32_t> shape(n), instance(n);
  std::vector<uint32_t> prim(n);
  for (int first = 0; first < n; first += batch) {
    const Hits hits{t.data() + first,        shape.data() + first, prim.data() + first,
                    instance.data() + first, u.data() + first,     v.data() + first};
    scene.accel->intersect(
        {std::min(batch, n - first), o.vec3().from(first), d.vec3().from(first), nullptr, nullptr, nullptr, {}}, hits,
        coherent);
  }
  for (int i = 0; i < n; ++i) out[i] = shape[i] < 0 ? -1.0f : t[i];
  return out;
}

TEST(Hard, PacketsAndSingleRays) {
  HardCase worst({16, "rays one at a time and in packets, coherent or not, denormal numbers flushed or not",
                  "20000 rays, batches of 1 to 1024, scales of 1e-12 to 1e12", "relMSE of their distances", 1e-6, ""});
  for (const double scale : kScales) {
    const BuiltScene built(scene_at(scale));
    const std::vector<float> one_by_one = distances(*built.scene, 20000, 1, false);
    EXPECT_GT(std::count_if(one_by_one.begin(), one_by_one.end(), [](float t) { return t > 0; }), 2000);
    for (const int batch : {1, 3, 4, 7, 8, 16, 37, 1024}) {
      for (const bool coherent : {false, true}) {
        for (const bool flush : {false, true}) {
          const FlushMode mode(flush);
          worst.see(relative_mse(distances(*built.scene, 20000, batch, coherent), one_by_one),
                    fmt::format("batches of {}, coherent {}, flushed {}, scale {}", batch, coherent, flush, scale));
        }
      }
    }
  }
}

}  // namespace
}  // namespace whit
