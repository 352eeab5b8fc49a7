// A scene ready to be traced: live plugins, geometry in render space, lights, and the ray tracer over it all.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/accel/accel.h"
#include "core/base/render_space.h"
#include "core/base/stopwatch.h"
#include "core/image/texture_store.h"
#include "core/scene/bound_scene.h"
#include "core/scene/effect_plan.h"
#include "core/scene/light_choice.h"

namespace whit {

/// A triangle mesh baked into its group's space, as float.
struct Mesh {
  std::vector<float> positions;  ///< 3 per vertex, and one of padding that Embree may read.
  std::vector<uint32_t> indices;
  std::vector<float> normals;          ///< 3 per vertex or empty; not unit: interpolated before normalising, as pbrt.
  std::vector<float> tangents;         ///< 3 per vertex or empty.
  std::vector<float> bitangent_signs;  ///< 1 or -1 per vertex, with `tangents`, or empty.
  std::vector<float> uvs;              ///< 2 per vertex or empty.
  std::vector<float> uvs1;             ///< A second set, or empty.
  std::vector<float> colors;           ///< 4 per vertex or empty: linear red, green, blue and alpha.
  /// The triangles in double, or empty: those of a mesh of huge ones, which alone are in it (core/scene/huge.h).
  std::vector<ExactTriangle> exact;
  size_t triangle_count() const { return indices.size() / 3; }
  Vec3f position(uint32_t i) const { return {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]}; }
  Vec3f normal(uint32_t i) const { return {normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]}; }
  Vec3f tangent(uint32_t i) const { return {tangents[3 * i], tangents[3 * i + 1], tangents[3 * i + 2]}; }
  Vec2f uv(uint32_t i) const { return {uvs[2 * i], uvs[2 * i + 1]}; }
  const uint32_t* corners(uint32_t triangle) const { return &indices[3 * static_cast<size_t>(triangle)]; }
  Vec3d corner(size_t triangle, size_t k) const {
    if (exact.empty()) return Vec3d(position(indices[3 * triangle + k]));
    const ExactTriangle& t = exact[triangle];
    return k == 0 ? t.a : k == 1 ? t.b : t.c;
  }
  size_t bytes() const;
};

/// Curves in a space of their own: their object space, moved to their middle. Widths are measured there.
struct Curves {
  std::vector<float> control_points;  ///< 4 x (x, y, z, half width) per segment.
  std::vector<float> normals;         ///< 4 x 3 per segment, ribbons only.
  std::vector<float> u_range;         ///< 2 per segment.
  CurveData::Kind kind = CurveData::Kind::Flat;
  int split_depth = 0;
  Mat4d to_group, from_group;
  size_t segment_count() const { return control_points.size() / 16; }
  CurveView view() const {
    return {control_points.data(), segment_count(), normals.empty() ? nullptr : normals.data(),
            split_depth,           to_group,        from_group};
  }
};

/// One shape as shading sees it. Exactly one of mesh, curves and analytic is set.
struct SceneShape {
  const Mesh* mesh = nullptr;
  const Curves* curves = nullptr;
  const AnalyticShape* analytic = nullptr;
  int material = 0;      ///< Index into Scene::materials.
  int sort_key = 0;      ///< Equal for shapes that are shaded alike: same material, same kind of geometry.
  int emitter = -1;      ///< Index into Scene::emitters: of the only one, or of the first of a mesh.
  int first_light = -1;  ///< Index into Scene::lights of the same; -1 where it is not sampled.
  /// Where not null, not all triangles of an emitting mesh are sampled: those of each triangle, -1 of those that are not.
  /// `emitter` is then what is seen of these.
  const std::vector<int32_t>* light_of_prim = nullptr;
  float unit = 1;               ///< The length of a world unit in the shape's group.
  SourcePos where;              ///< Its statement.
  bool flips = false;           ///< ReverseOrientation XOR handedness (meshes with normals: alone): normals flip.
  bool passes_through = false;  ///< Its material is an interface: rays go on.
};

/// A placed object: which of Scene::instance_keys take its group's space to render space, at evenly spaced times.
/// Small, because a scene may have millions.
struct SceneInstance {
  uint32_t first_key = 0, key_count = 0;
};

/// A light that can be sampled: a Light plugin, or one emitting primitive of a shape.
struct SceneLight {
  const Light* light = nullptr;
  int shape = -1;  ///< Of an emitting primitive.
  uint32_t prim = 0;
  int dimension = -1;  ///< Offset of its two sample dimensions within a bounce; -1 for a delta light.
  int samples = 1;     ///< For each point, where the integrator samples every light as often as the scene wants.
  LightReach reach{};
  RayEnd end{};  ///< Of its shadow rays.
};

/// A light at infinity, which rays see that leave the scene.
struct SceneEnvironment {
  const Light* light = nullptr;
  int number = -1;  ///< Index into Scene::lights; -1 where it is not sampled.
};

class KeptGeometry;

/// The numbers of the render that the command line may override.
struct BuildOptions {
  int samples_per_pixel = 0;  ///< 0: the scene's.
  int footprint_samples = 0;  ///< Scene::footprint_samples; 0: the scene's own number of samples.
  uint32_t seed = 0;
  bool quick = false;  ///< pbrt's --quick: a quarter of the resolution, one sample.
  bool robust_traversal = true;
  bool keep_going = false;       ///< Build what is usable despite errors.
  bool only_check = false;       ///< Only for what there is to say: nothing can be traced.
  KeptGeometry* kept = nullptr;  ///< Meshes of earlier builds, for later ones: core/scene/kept_geometry.h.
};

/// Where the time went that build_scene() took. The parts are all of it.
struct BuildTimes {
  Elapsed
      inputs;  ///< Files that decide whether textures and materials can be used, and tables of samplers and filters.
  Elapsed geometry;    ///< Reading and making it.
  Elapsed materials;   ///< And textures.
  Elapsed placing;     ///< Geometry to render space, copies to their places; surfaces that lie in one another.
  Elapsed pictures;    ///< Reading those that lights are made of.
  Elapsed lights;      ///< All else of lights, and the camera.
  Elapsed ray_tracer;  ///< Its own structures, and what shadow rays end on.
};

struct Scene {
  RenderSpace space;
  BoundScene bound;
  EffectPlan plan;
  std::vector<std::shared_ptr<const Mesh>> meshes;
  std::vector<std::unique_ptr<Curves>> curves;
  std::vector<std::unique_ptr<AlphaTest>> alpha_tests;
  std::vector<const Material*> materials;
  std::vector<SceneShape> shapes;
  std::vector<std::unique_ptr<const Light>> emitters;                        ///< Emitting primitives of shapes.
  std::vector<std::unique_ptr<const std::vector<int32_t>>> lights_of_prims;  ///< SceneShape::light_of_prim
  bool has_emission_maps = false;                                            ///< Some Light::emission_map().
  std::vector<SceneInstance> instances;
  std::vector<Mat4d> instance_keys;
  std::vector<SceneLight> lights;
  bool skip_lights = true;  ///< Leave lights out that cannot reach any point of a batch. The picture is the same.
  std::vector<SceneEnvironment> environments;  ///< Lights that escaped rays see.
  std::vector<Mat4d> camera_keys;              ///< Camera to render space at evenly spaced times.
  double time_start = 0, time_end = 1;         ///< Times of the first and last key.
  bool any_touched = false;                    ///< Whether the end of some light is (RayEnd::touched).
  int light_dimensions = 0;                    ///< Sample dimensions that sampling lights uses in one bounce.
  int samples_per_pixel = 1;
  /// Camera rays' footprints are a pixel's, shrunk by the square root of this (in area by this). The number of samples
  /// that the scene asks for, whatever is rendered: pictures of any number of samples converge to the same.
  int footprint_samples = 1;
  int sort_keys = 0;           ///< Number of different SceneShape::sort_key; hits are sorted by it where there are two.
  bool has_instances = false;  ///< Points are taken to render space.
  MeshAttributes attributes;   ///< That are asked for, and that some mesh has.
  std::unique_ptr<LightChoice> light_choice;  ///< Null where the integrator samples every light.
  int chosen_lights = 0;                      ///< How many of them it chooses for each point, with replacement.
  std::unique_ptr<Accel> accel;
  BuildTimes build_times;

  const Camera& camera() const { return *bound.camera.plugin; }
  const Film& film() const { return *bound.film.plugin; }
  const Filter& filter() const { return *bound.filter.plugin; }
  const Sampler& sampler() const { return *bound.sampler.plugin; }
  const Integrator& integrator() const { return *bound.integrator.plugin; }

  std::span<const Mat4d> keys_of(const SceneInstance& i) const {
    return {instance_keys.data() + i.first_key, i.key_count};
  }

  size_t triangle_count() const;
  size_t geometry_bytes() const;  ///< Meshes and acceleration structure.
};

/// Builds a planned scene: reads meshes, prepares what the plan keeps, builds the ray tracer. Problems go to
/// `diagnostics`. Null when nothing can be rendered.
std::unique_ptr<Scene> build_scene(BoundScene bound, EffectPlan plan, const BuildOptions& options,
                                   TextureStore& textures, Diagnostics& diagnostics);

}  // namespace whit
