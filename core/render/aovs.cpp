// The table of AOVs. Another one is another row, and where its values come from.

#include "core/render/aovs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/base/sampling.h"
#include "core/lobe/eval.h"
#include "core/render/points.h"
#include "core/scene/motion.h"

namespace whit {
namespace {

// ---- Values of the first surface ----

template <class Value>
void write(const FirstSurfaces& at, SampleValues to, const Value& value) {
  const int32_t* const slot = at.points.rays.slot;
  for (int i = 0; i < at.points.n; ++i) {
    const auto v = value(i);
    constexpr int kChannels = sizeof v / sizeof(float);
    for (int c = 0; c < kChannels; ++c) to[c][slot[i]] = (&v.x)[c];
  }
}
struct One {
  float x;
};

void shading_normal(const FirstSurfaces& at, SampleValues to) {
  write(at, to, [&](int i) { return at.points.at.ns[i]; });
}

void geometric_normal(const FirstSurfaces& at, SampleValues to) {
  write(at, to, [&](int i) { return at.points.at.ng[i]; });
}

void position(const FirstSurfaces& at, SampleValues to) {
  const Mat4d to_world = at.scene.space.to_world();
  write(at, to, [&](int i) { return Vec3f(transform_point(to_world, Vec3d(at.points.at.p[i]))); });
}

void parameters(const FirstSurfaces& at, SampleValues to) {
  write(at, to, [&](int i) { return Vec2f(at.points.at.u[i], at.points.at.v[i]); });
}

void depth(const FirstSurfaces& at, SampleValues to) {
  const float* const time = at.points.rays.time;
  const Mat4d still = at.scene.camera_keys.front().inverse();
  const bool moves = time && at.scene.camera_keys.size() > 1;
  write(at, to, [&](int i) {
    const Mat4d to_camera = moves ? interpolate_keys(at.scene.camera_keys, time[i]).inverse() : still;
    return One{static_cast<float>(transform_point(to_camera, Vec3d(at.points.at.p[i])).z)};
  });
}

/// A time in seconds, over the interval in which transforms move.
double shutter_time(const Scene& scene, float seconds) {
  const double span = scene.time_end - scene.time_start;
  return span != 0 ? std::clamp((static_cast<double>(seconds) - scene.time_start) / span, 0.0, 1.0) : 0.0;
}

/// How far a point goes through the picture, with its shape and the camera, while the shutter is open.
void screen_motion(const FirstSurfaces& at, SampleValues to) {
  const Scene& scene = at.scene;
  const std::optional<Mat4d> to_ndc = scene.camera().to_ndc();
  const float* const time = at.points.rays.time;
  if (!time || !to_ndc) return;
  const double open = shutter_time(scene, scene.camera().shutter_open);
  const double close = shutter_time(scene, scene.camera().shutter_close);
  const Vec2d pixels(scene.camera().film.resolution);
  write(at, to, [&](int i) {
    const Vec3d p(at.points.at.p[i]);
    const int instance = at.points.hits.instance[i];
    const auto shape_to_render = [&](double when) {
      return instance < 0 ? Mat4d()
                          : interpolate_keys(scene.keys_of(scene.instances[static_cast<size_t>(instance)]), when);
    };
    const Vec3d on_shape = transform_point(shape_to_render(static_cast<double>(time[i])).inverse(), p);
    const auto pixel_at = [&](double when) {
      const Mat4d to_camera = interpolate_keys(scene.camera_keys, when).inverse();
      const Vec3d ndc = transform_point(shape_to_render(when) * to_camera * *to_ndc, on_shape);
      return Vec2d(ndc.x, ndc.y) * pixels;
    };
    return Vec2f(pixel_at(close) - pixel_at(open));
  });
}

/// Adds to `sum` the share of even light that one lobe of a run sends back: the mean of fixed samples.
void add_lobe(const MaterialRun& run, const Lobe& lobe, Arena& arena, const RGBLanes& sum) {
  constexpr int kSamples = 16;
  const int n = run.points.n;
  LobeSet alone(arena);
  alone.add(lobe);
  alone.eta = run.lobes.eta;
  const RGBLanes weight = arena.rgb(n);
  float *const zero = arena.floats(n), *const u = arena.floats(n), *const v = arena.floats(n);
  std::fill_n(zero, n, 0.0f);
  const LobeSamples samples{arena.vec3(n), weight, arena.floats(n), arena.floats(n)};
  for (int k = 0; k < kSamples; ++k) {
    const ArenaScope scratch(arena);
    const Vec2f at = lattice_point({0.5f, 0.5f}, k);
    for_lanes(n, [&](int i) { u[i] = at.x, v[i] = at.y; });
    sample_lobes(alone, run.points, run.frame, zero, u, v, LobeKinds::All, samples);
    // Refraction concentrates radiance; no light is made or lost by that.
    for_lanes(n, [&](int i) { sum.set(i, sum[i] + weight[i] * (samples.eta2[i] / kSamples)); });
  }
}

/// Lobe by lobe: which of several a fixed sample chooses would change in steps.
RGBLanes sum_of_lobes(const MaterialRun& run, Arena& arena) {
  const RGBLanes sum = arena.rgb(run.points.n);
  for_lanes(run.points.n, [&](int i) { sum.set(i, RGB(0.0f)); });
  for (int l = 0; l < run.lobes.count; ++l) {
    const ArenaScope scratch(arena);
    add_lobe(run, run.lobes.lobes[l], arena, sum);
  }
  return sum;
}

void albedo(const FirstSurfaces& at, SampleValues to) {
  for (const MaterialRun& run : at.points.materials) {
    const ArenaScope scratch(*run.points.arena);
    const RGBLanes sum = sum_of_lobes(run, *run.points.arena);
    const int32_t* const slot = at.points.rays.slot + run.first;
    for (int i = 0; i < run.points.n; ++i) {
      for (int c = 0; c < 3; ++c) to[c][slot[i]] = std::clamp(sum[i][c], 0.0f, 1.0f);
    }
  }
}

// ---- Numbers that stand for something ----

void material_number(const FirstSurfaces& at, SampleValues to) {
  write(at, to, [&](int i) {
    return One{static_cast<float>(at.scene.shapes[static_cast<size_t>(at.points.hits.shape[i])].material)};
  });
}

void shape_number(const FirstSurfaces& at, SampleValues to) {
  write(at, to, [&](int i) { return One{static_cast<float>(at.points.hits.shape[i])}; });
}

/// Gives each a name that no other statement's has: what it is called; else with its line; else with its column.
class Names {
 public:
  void add(const std::string& called, const std::string& where) {
    const std::string line = where.substr(0, where.rfind(':'));
    const std::string at = called.empty() ? "" : called + "@";
    for (const std::string& name : {called, at + line, at + where}) {
      if (name.empty() || (!taken_.insert(name).second && name != at + where)) continue;
      names.push_back({name, where});
      return;
    }
    names.push_back({called, where});
  }
  std::vector<IdName> names;

 private:
  std::set<std::string> taken_;
};

std::vector<IdName> material_names(const Scene& scene, const StatementPlace& place) {
  const std::vector<MaterialDescription>& described = scene.bound.description->materials;
  Names names;
  for (size_t i = 0; i < scene.bound.materials.size(); ++i) {
    // Beyond the description's are those whose shapes say something else of them.
    const SourcePos at = scene.bound.materials[i].where;
    const std::string where = i == 0 ? "" : place(at);
    const bool described_here = i < described.size();
    if (described_here && !described[i].name.empty()) {
      names.add(described[i].name, where);
    } else {
      const std::string plugin = described_here ? described[i].plugin : "material";
      names.add(i == 0 ? "default" : plugin + "@" + where.substr(0, where.rfind(':')), where);
    }
  }
  return std::move(names.names);
}

std::vector<IdName> shape_names(const Scene& scene, const StatementPlace& place) {
  Names names;
  for (const SceneShape& shape : scene.shapes) names.add("", place(shape.where));
  return std::move(names.names);
}

// ---- Of a pixel's samples together ----

void variance_of_mean(const PixelStatistics& of, float* to) {
  for (int c = 0; c < 3; ++c) to[c] = static_cast<float>(of.variance[c]);
}

void sample_count(const PixelStatistics& of, float* to) { *to = static_cast<float>(of.n); }

// ---- The table ----

AovRow of_surface(const char* name, std::vector<std::string> channels, AovPixel pixel, const char* doc,
                  void (*value)(const FirstSurfaces&, SampleValues)) {
  return {
      .name = name, .channels = std::move(channels), .pixel = pixel, .full_float = true, .doc = doc, .surface = value};
}

std::vector<std::string> rgb(const std::string& layer) { return {layer + ".R", layer + ".G", layer + ".B"}; }
std::vector<std::string> xyz(const std::string& layer) { return {layer + ".X", layer + ".Y", layer + ".Z"}; }

AovRow of_light(const char* name, LightPart part, const char* doc) {
  return {.name = name, .channels = rgb(name), .pixel = AovPixel::Mean, .full_float = false, .doc = doc, .part = part};
}

AovRow with_nothing(AovRow row, float value) {
  row.nothing = value;
  return row;
}

AovRow with_names(AovRow row, const char* matte, decltype(AovRow::names) names) {
  row.nothing = -1, row.matte = matte, row.names = names;
  return row;
}

AovRow as_colour(AovRow row) {
  row.full_float = false;
  return row;
}

const std::vector<AovRow>& table() {
  using enum AovPixel;
  static const std::vector<AovRow> rows{
      as_colour(
          of_surface("albedo", rgb("Albedo"), SurfaceMean,
                     "Share of even light from all around that the surface sends to the camera, its mirrors and "
                     "boundaries included: by 16 fixed samples of each lobe, 0 to 1. Of integrators that ask for no "
                     "materials 0.",
                     albedo)),
      of_surface("N", xyz("N"), SurfaceDirection, "Shading normal in the world, with bumps.", shading_normal),
      of_surface("Ng", xyz("Ng"), SurfaceDirection, "Geometric normal in the world.", geometric_normal),
      of_surface("P", xyz("P"), Nearest, "Point in the world; 0 where there is none.", position),
      with_nothing(
          of_surface("Z", {"Z"}, Nearest,
                     "Depth along the camera's axis, in the world's units; infinite where there is nothing.", depth),
          std::numeric_limits<float>::infinity()),
      of_surface("uv", {"uv.U", "uv.V"}, Nearest, "Surface parameters, which textures are laid out by.", parameters),
      of_surface(
          "motion", {"motion.X", "motion.Y"}, Nearest,
          "Pixels by which the point moves, right and down, from the shutter's opening to its closing; of cameras "
          "whose picture is no projection 0.",
          screen_motion),
      with_names(of_surface("material", {"material.id"}, Nearest,
                            "Number of the material, -1 for none. The header's whit:materials says what it stands for; "
                            "with cryptomattes.",
                            material_number),
                 "CryptoMaterial", material_names),
      with_names(
          of_surface("shape", {"shape.id"}, Nearest,
                     "Number of the shape's statement, -1 for none. The header's whit:shapes says what it stands "
                     "for; with cryptomattes.",
                     shape_number),
          "CryptoShape", shape_names),
      of_light("emission", LightPart::Emission, "Light of emitters and the sky that the camera sees itself."),
      of_light("direct", LightPart::Direct, "Light that the first surface gets from lights."),
      of_light("reflection", LightPart::Reflection, "Light that comes by a perfect mirror of the first surface."),
      of_light("refraction", LightPart::Refraction, "Light that comes through the first surface's smooth boundary."),
      of_light("indirect", LightPart::Indirect, "Other light that the first surface gets from surfaces."),
      {.name = "lightgroups",
       .channels = {".R", ".G", ".B"},
       .pixel = Mean,
       .full_float = false,
       .doc = "For each group of lights, the light that comes from it: layers lightgroup.NAME.",
       .by_light_group = true},
      {.name = "variance",
       .channels = rgb("variance"),
       .pixel = Statistic,
       .full_float = true,
       .doc = "Variance of the pixel's value, by four blocks of its samples: unbiased for the random sampler, a little "
              "too "
              "high for those that spread samples evenly; infinite with fewer than two samples.",
       .statistic = variance_of_mean,
       .blocks = true},
      {.name = "samples",
       .channels = {"samples"},
       .pixel = Statistic,
       .full_float = true,
       .doc = "How many of the pixel's own samples are numbers.",
       .statistic = sample_count},
  };
  return rows;
}

}  // namespace

const char* pixel_text(AovPixel pixel) {
  switch (pixel) {
    case AovPixel::Mean: return "mean of all samples, weighed by the filter";
    case AovPixel::SurfaceMean: return "mean of the samples that meet a surface, weighed by the filter";
    case AovPixel::SurfaceDirection:
      return "mean of the samples that meet a surface, weighed by the filter, as a unit vector";
    case AovPixel::Nearest: return "the pixel's own sample nearest to its middle";
    case AovPixel::Statistic: return "all of the pixel's samples";
  }
  return "";
}

std::span<const AovRow> all_aovs() { return table(); }

const AovRow* find_aov(const std::string& name) {
  for (const AovRow& row : table()) {
    if (row.name == name) return &row;
  }
  return nullptr;
}

std::string unknown_aov(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const AovRow& row : table()) known.emplace_back(row.name);
  for (const std::string& name : names) {
    if (find_aov(name)) continue;
    const std::string remedy = did_you_mean(name, known);
    return fmt::format("there is no AOV \"{}\"; {}", name,
                       remedy.empty() ? fmt::format("there are {}", fmt::join(known, ", ")) : remedy);
  }
  return "";
}

}  // namespace whit
