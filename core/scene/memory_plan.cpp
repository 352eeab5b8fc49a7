#include "core/scene/memory_plan.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <utility>

#include "core/plugin/memory_limit.h"
#include "core/plugin/memory_need.h"
#include "core/scene/motion.h"

namespace whit {
namespace {

/// Bytes of things that others make, as they were measured: docs/memory.md has how, and tools/check-memory measures anew.
struct Measured {
  static constexpr double kTriangle = 57, kPiece = 85;  ///< In Embree's trees: of a mesh, of a curve.
  static constexpr double kBuilding = 32;               ///< Of each of these beside, while the trees are made.
  static constexpr double kInstance = 525;
  static constexpr double kKey = 360;     ///< Of an instance that moves, beyond the first of its keyframes.
  static constexpr double kGroup = 4200;  ///< Of what is placed as a whole: an object, a shape that moves.
  static constexpr double kShape = 2100;  ///< Of any kind: its plugin, its geometry for Embree, its surface.
  static constexpr double kLight = 1400;  ///< Of a statement; and each triangle, or other shape, that shines is one.
};

struct UseText {
  const char *text, *key, *remedy;
};
constexpr UseText kUses[kMemoryUses] = {
    {"program and scene text", "program", "meshes in PLY files take less than lists in the scene's text"},
    {"meshes", "meshes", "fewer triangles or levels of subdivision; objects that are placed many times are there once"},
    {"curves", "curves", "fewer curves; objects that are placed many times are there once"},
    {"shapes and lights", "shapes", "fewer of them: meshes instead of many small ones"},
    {"instances", "instances", "fewer of them, fewer things that move, or several objects in one that is placed"},
    {"ray tracer", "ray_tracer", "fewer triangles, or of curves a smaller \"splitdepth\""},
    {"textures", "textures", "smaller pictures"},
    {"light maps", "light_maps", "a smaller map"},
    {"tables of materials", "tables", "a smaller table"},
    {"film", "film", "a smaller resolution, a part of it (--cropwindow), fewer AOVs or a narrower filter"},
    {"workers", "workers", "fewer threads (--nthreads)"},
    {"output", "output", "a smaller resolution, a part of it (--cropwindow) or fewer AOVs"},
    {"denoiser", "denoiser", "a smaller resolution, a part of it (--cropwindow), or no --denoise"},
};

constexpr const char* kSteps[kMemorySteps][2] = {{"reading materials", "materials"},
                                                 {"reading shapes", "reading"},
                                                 {"placing shapes", "placing"},
                                                 {"reading light maps", "lights"},
                                                 {"building the ray tracer", "ray_tracer"},
                                                 {"rendering", "rendering"},
                                                 {"finishing the picture", "finishing"},
                                                 {"writing files", "writing"},
                                                 {"denoising", "denoising"}};

constexpr size_t index_of(MemoryStep step) { return static_cast<size_t>(step); }

/// So many bytes from one step on, to the last.
StepBytes from(MemoryStep first, double bytes) {
  StepBytes out{};
  std::fill(out.begin() + static_cast<std::ptrdiff_t>(index_of(first)), out.end(), bytes);
  return out;
}

/// What shapes and pictures will need, in the order of their statements; of all at once, for files are opened for it.
template <class T>
std::vector<MemoryNeed> needs_of(const std::vector<Bound<T>>& all, const std::vector<uint8_t>& live,
                                 const MeshAttributes& attributes) {
  std::vector<MemoryNeed> needs(all.size());
  tbb::parallel_for(size_t{0}, all.size(), [&](size_t i) {
    const auto* plugin = live[i] ? dynamic_cast<const NeedsMemory*>(all[i].plugin.get()) : nullptr;
    if (plugin) needs[i] = plugin->memory_need(attributes);
  });
  return needs;
}

/// The sum of the largest few of some numbers: what so many threads may do at once.
double sum_of_largest(std::vector<double> numbers, int few) {
  const auto n = std::min(numbers.size(), static_cast<size_t>(std::max(few, 1)));
  std::partial_sort(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(n), numbers.end(), std::greater<>());
  return std::accumulate(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(n), 0.0);
}

/// Of a shape: as it is read, and as it is traced.
struct ShapeBytes {
  double read = 0, placed = 0, making = 0, tree = 0, tree_making = 0;
  bool curves = false;
};

ShapeBytes bytes_of(const MemoryNeed& need) {
  const auto vertices = static_cast<double>(need.vertices), triangles = static_cast<double>(need.triangles);
  const auto segments = static_cast<double>(need.segments), floats = 4.0 * static_cast<double>(need.floats);
  ShapeBytes b;
  b.curves = need.segments > 0;
  const double ribbon = need.ribbon ? 48 : 0;
  b.read = vertices * ((need.owns_vertices ? 24 : 0) + floats) + 12 * triangles + segments * (96 + 16 + 8 + ribbon);
  b.placed = vertices * (12 + floats) + 12 * triangles + segments * (64 + 8 + ribbon);
  // Triangles are sorted by corners, to find those that are there twice.
  b.making = static_cast<double>(need.making) + 4 * (vertices + triangles);
  const double pieces = segments * static_cast<double>(need.pieces);
  b.tree = triangles * Measured::kTriangle + pieces * Measured::kPiece;
  b.tree_making = (triangles + pieces) * Measured::kBuilding;
  return b;
}

std::string name_of(const ShapeDescription& shape, const MemoryNeed& need) {
  if (need.segments > 0) return fmt::format("{} of {} segments", shape.plugin, need.segments);
  return fmt::format("{} of {} triangles", shape.plugin, need.triangles);
}

/// Shapes are read all before they are placed, in order, each giving back what it was read as.
double most_while_placing(const std::vector<ShapeBytes>& shapes) {
  double now = 0, most = 0;
  for (const ShapeBytes& s : shapes) now += s.read;
  for (const ShapeBytes& s : shapes) {
    now += s.placed;
    most = std::max(most, now);
    now -= s.read;
  }
  return most;
}

void plan_shapes(const BoundScene& bound, const EffectPlan& plan, int threads, MemoryPlan& memory) {
  const auto& shapes = bound.description->shapes;
  const std::vector<MemoryNeed> needs = needs_of(bound.shapes, plan.shape_live, plan.attributes);
  std::vector<ShapeBytes> meshes, curves;
  std::vector<double> making;
  double emitters = 0, count = 0;
  for (size_t i = 0; i < needs.size(); ++i) {
    if (!plan.shape_live[i]) continue;
    ++count;
    const ShapeBytes b = bytes_of(needs[i]);
    const MemoryPart part{b.read + b.placed, shapes[i].where, name_of(shapes[i], needs[i])};
    (b.curves ? curves : meshes).push_back(b);
    making.push_back(b.making);
    const MemoryUse use = b.curves ? MemoryUse::Curves : MemoryUse::Meshes;
    StepBytes bytes = from(MemoryStep::Lights, b.placed);
    bytes[index_of(MemoryStep::Reading)] = b.read;
    memory.add(use, bytes, part);
    memory.add_from(MemoryStep::Reading, use, static_cast<double>(needs[i].mapped));
    StepBytes tree = from(MemoryStep::RayTracer, b.tree);
    tree[index_of(MemoryStep::RayTracer)] += b.tree_making;
    memory.add(MemoryUse::RayTracer, tree, {b.tree, part.where, part.what});
    if (shapes[i].area_light >= 0) emitters += std::max(1.0, static_cast<double>(needs[i].triangles));
  }
  StepBytes placing{};
  placing[index_of(MemoryStep::Placing)] = most_while_placing(meshes);
  memory.add(MemoryUse::Meshes, placing);
  placing[index_of(MemoryStep::Placing)] = most_while_placing(curves);
  memory.add(MemoryUse::Curves, placing);
  StepBytes reading{};
  reading[index_of(MemoryStep::Reading)] = sum_of_largest(std::move(making), threads);
  memory.add(MemoryUse::Meshes, reading);
  memory.add_from(MemoryStep::Reading, MemoryUse::Shapes, count * Measured::kShape);
  memory.add_from(MemoryStep::Lights, MemoryUse::Shapes, emitters * Measured::kLight);
}

/// Tables are read before anything else is.
void plan_materials(const BoundScene& bound, const EffectPlan& plan, int threads, MemoryPlan& memory) {
  const std::vector<MemoryNeed> needs = needs_of(bound.materials, plan.material_live, plan.attributes);
  std::vector<double> making;
  for (size_t i = 0; i < needs.size(); ++i) {
    const auto bytes = static_cast<double>(needs[i].table);
    if (bytes == 0) continue;
    making.push_back(static_cast<double>(needs[i].making));
    memory.add_from(MemoryStep::Materials, MemoryUse::Tables, bytes,
                    {bytes, bound.materials[i].where, "the table of a material"});
  }
  StepBytes reading{};
  reading[index_of(MemoryStep::Materials)] = sum_of_largest(std::move(making), threads);
  memory.add(MemoryUse::Tables, reading);
}

/// Of what is placed as a whole. A shape that moves is; one of an object is placed wherever that is.
class Places {
 public:
  Places(const BoundScene& bound, const EffectPlan& plan)
      : scene_(*bound.description), motion_(!plan.off.has(Effect::MotionBlur)), objects_(scene_.objects.size() + 1) {
    for (size_t i = 0; i < scene_.shapes.size(); ++i) {
      const ShapeDescription& shape = scene_.shapes[i];
      if (!plan.shape_live[i]) continue;
      Object& object = objects_[static_cast<size_t>(shape.object + 1)];
      object.stands |= !moves(shape.transform);
      if (!moves(shape.transform)) continue;
      ++object.moving, ++moving_shapes_;
      object.bytes += bytes_of(shape.transform);
    }
  }

  double groups() const { return static_cast<double>(scene_.objects.size()) + moving_shapes_; }
  double bytes_of_world() const { return objects_[0].bytes; }
  /// What moves in an object, and with it, has as many keyframes as the one or the other.
  double bytes_of(const InstanceDescription& instance) const {
    const Object& object = objects_[static_cast<size_t>(instance.object + 1)];
    const double place = bytes_of(instance.transform);
    return (object.stands ? place : 0) + std::max(object.bytes, object.moving * place);
  }

 private:
  struct Object {
    bool stands = false;           ///< Some of it does not move.
    double moving = 0, bytes = 0;  ///< Shapes that do, and their places.
  };
  TransformPair pair(int transform) const { return scene_.transforms[static_cast<size_t>(transform)]; }
  bool moves(int transform) const { return motion_ && pair(transform).animated(); }
  double bytes_of(int transform) const {
    const size_t keys = moves(transform) ? keyframes(pair(transform)).size() : 1;
    return Measured::kInstance + Measured::kKey * static_cast<double>(keys - 1);
  }

  const SceneDescription& scene_;
  const bool motion_;
  std::vector<Object> objects_;  ///< The world first.
  double moving_shapes_ = 0;
};

void plan_instances(const BoundScene& bound, const EffectPlan& plan, MemoryPlan& memory) {
  const Places places(bound, plan);
  const auto& instances = bound.description->instances;
  memory.add_from(MemoryStep::Placing, MemoryUse::Instances,
                  places.groups() * Measured::kGroup + places.bytes_of_world());
  if (instances.empty()) return;
  double bytes = 0;
  for (const InstanceDescription& instance : instances) bytes += places.bytes_of(instance);
  memory.add_from(MemoryStep::Placing, MemoryUse::Instances, bytes,
                  {bytes, instances[0].where, fmt::format("{} instances", instances.size())});
}

void plan_lights(const BoundScene& bound, const EffectPlan& plan, MemoryPlan& memory) {
  const std::vector<MemoryNeed> needs = needs_of(bound.lights, plan.light_live, plan.attributes);
  double making = 0, count = 0;
  for (size_t i = 0; i < needs.size(); ++i) {
    count += plan.light_live[i] ? 1 : 0;
    const auto bytes = static_cast<double>(needs[i].light_map);
    if (bytes > 0) making = std::max(making, static_cast<double>(needs[i].making));
    if (bytes > 0)
      memory.add_from(MemoryStep::Lights, MemoryUse::LightMaps, bytes,
                      {bytes + static_cast<double>(needs[i].making), bound.lights[i].where, "the map of a light"});
  }
  StepBytes reading{};
  reading[index_of(MemoryStep::Lights)] = making;
  memory.add(MemoryUse::LightMaps, reading);
  if (count > 0)
    memory.add_from(MemoryStep::Lights, MemoryUse::Shapes, count * Measured::kLight,
                    {count * Measured::kLight, bound.lights[0].where, fmt::format("{:g} lights", count)});
}

}  // namespace

const char* memory_use_text(MemoryUse use) { return kUses[static_cast<size_t>(use)].text; }
const char* memory_use_key(MemoryUse use) { return kUses[static_cast<size_t>(use)].key; }
const char* memory_step_text(MemoryStep step) { return kSteps[index_of(step)][0]; }
const char* memory_step_key(MemoryStep step) { return kSteps[index_of(step)][1]; }

void MemoryPlan::add(MemoryUse use, const StepBytes& bytes, const MemoryPart& part) {
  StepBytes& sum = bytes_[static_cast<size_t>(use)];
  for (size_t step = 0; step < kMemorySteps; ++step) sum[step] += bytes[step];
  MemoryPart& largest = largest_[static_cast<size_t>(use)];
  if (part.bytes > largest.bytes) largest = part;
}

void MemoryPlan::add_from(MemoryStep first, MemoryUse use, double bytes, const MemoryPart& part) {
  add(use, from(first, bytes), part);
}

double MemoryPlan::total(MemoryStep step) const {
  double sum = 0;
  for (const StepBytes& bytes : bytes_) sum += bytes[index_of(step)];
  return sum;
}

MemoryStep MemoryPlan::step() const {
  MemoryStep most = MemoryStep::Reading;
  for (size_t step = 0; step < kMemorySteps; ++step) {
    if (total(static_cast<MemoryStep>(step)) > total(most)) most = static_cast<MemoryStep>(step);
  }
  return most;
}

double MemoryPlan::least_texture_cap() const {
  constexpr double kLeast = 8 << 20;
  return std::min(all_textures_ + most_decoding_, most_decoding_ + kLeast);
}

// What does not fit under the cap is dropped, or in a file; what is being decoded must fit in any case.
void MemoryPlan::cap_textures(double bytes) {
  texture_cap_ = bytes;
  const double taken = std::min(all_textures_ + most_decoding_, std::max(bytes, least_texture_cap()));
  bytes_[static_cast<size_t>(MemoryUse::Textures)] = from(MemoryStep::Rendering, taken);
}

// Lights that project pictures have them as textures do.
void plan_textures(const BoundScene& bound, const EffectPlan& plan, int threads, MemoryPlan& memory) {
  std::map<std::string, double> pictures;
  std::vector<double> making;
  const auto add = [&](const auto& all, const std::vector<MemoryNeed>& needs) {
    for (size_t i = 0; i < needs.size(); ++i) {
      const auto bytes = static_cast<double>(needs[i].texels);
      if (bytes == 0 || !pictures.emplace(needs[i].picture, bytes).second) continue;
      making.push_back(static_cast<double>(needs[i].making));
      memory.add(MemoryUse::Textures, {}, {bytes, all[i].where, "this picture"});
    }
  };
  add(bound.textures, needs_of(bound.textures, plan.texture_live, plan.attributes));
  add(bound.lights, needs_of(bound.lights, plan.light_live, plan.attributes));
  for (const auto& [picture, bytes] : pictures) memory.all_textures_ += bytes;
  memory.most_decoding_ = sum_of_largest(std::move(making), threads);
}

void plan_scene_memory(const BoundScene& bound, const EffectPlan& plan, int threads, double texture_cap,
                       MemoryPlan& memory) {
  plan_materials(bound, plan, threads, memory);
  plan_shapes(bound, plan, threads, memory);
  plan_instances(bound, plan, memory);
  plan_lights(bound, plan, memory);
  plan_textures(bound, plan, threads, memory);
  memory.cap_textures(texture_cap);
}

Diagnostics memory_problem(const MemoryPlan& memory, uint64_t limit) {
  Diagnostics said;
  if (memory.total() <= static_cast<double>(limit)) return said;
  std::string breakdown;
  size_t most = 0;
  for (size_t u = 0; u < kMemoryUses; ++u) {
    const auto use = static_cast<MemoryUse>(u);
    if (memory.of(use) > memory.of(static_cast<MemoryUse>(most))) most = u;
    if (memory.of(use) >= 1 << 20)
      breakdown +=
          fmt::format("{}{} {}", breakdown.empty() ? "" : ", ", memory_use_text(use), bytes_text(memory.of(use)));
  }
  const MemoryPart& largest = memory.largest(static_cast<MemoryUse>(most));
  said.add(
      limit_error(largest.where,
                  fmt::format("{} takes about {} of memory, more than {}: {}", memory_step_text(memory.step()),
                              bytes_text(memory.total()), bytes_text(static_cast<double>(limit)), breakdown),
                  fmt::format("{}{}{}; --max-memory allows more", largest.what.empty() ? "" : "the largest part is ",
                              largest.what, (largest.what.empty() ? "" : ": ") + std::string(kUses[most].remedy))));
  return said;
}

}  // namespace whit
