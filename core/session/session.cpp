#include "core/session/session.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "core/scene/problems.h"
#include "core/session/models.h"
#include "parser/lexer.h"

namespace whit {
namespace {

ParsedFile parsed_file(const ReadOptions& options,
                       const std::function<ParseResult(Sources&, ModelStore&, const ParseOptions&)>& parse) {
  const Stopwatch watch;
  ParsedFile file;
  ModelStore of_this_reading(options.allow_outside);
  ModelStore& models = options.models ? *options.models : of_this_reading;
  if (options.copy_files) file.sources->copy_files();
  for (const auto& [path, text] : options.unsaved) file.sources->stand_in(path, text);
  ParseResult parsed = parse(*file.sources, models, {.read_unplaced = options.read_unplaced, .models = &models});
  file.worlds = std::move(parsed.scenes), file.said = std::move(parsed.diagnostics), file.bytes = parsed.bytes;
  file.models = models.paths(), file.notes = models.notes();
  file.elapsed = watch.elapsed();
  return file;
}

/// A model as a scene: the statements that stand for it, parsed.
ParseResult parse_model(Sources& sources, const std::string& path, const gltf::Selection& selection, ModelStore& models,
                        const ParseOptions& options) {
  ParseResult failed;
  ParseOptions as_model = options;
  as_model.is_model = true;
  auto scene = models.scene_of(path, selection, failed.diagnostics);
  if (!scene) return failed;
  ParseResult result = parse_text(sources, name_of_model_text(path), std::move(scene->text),
                                  std::filesystem::path(path).parent_path().string(), as_model);
  Diagnostics all = std::move(failed.diagnostics);
  all.append(result.diagnostics);
  result.diagnostics = std::move(all);
  return result;
}

/// A build of which effects are compiled out is for measurements, and must not show half of a scene.
void check_build(const EffectPlan& plan, Diagnostics& diagnostics) {
  for_effects(plan.needed & kCompiledOut, [&](Effect e) {
    diagnostics.error(plan.use(e).causes.front().where, std::string("this build lacks ") + effect_name(e),
                      "configure one without WHIT_COMPILE_OUT, or switch it off with --without");
  });
}

std::shared_ptr<TextureStore> new_textures(size_t bytes) {
  auto textures = std::make_shared<TextureStore>();
  textures->set_memory_limit(bytes);
  return textures;
}

BuiltWorld build_with(std::shared_ptr<TextureStore> textures, PlannedWorld planned, const BuildOptions& options) {
  const Stopwatch watch;
  BuiltWorld out;
  out.textures = std::move(textures);
  out.keep_going = options.keep_going;
  out.scene = build_scene(std::move(planned.bound), std::move(planned.plan), options, *out.textures, out.said);
  out.elapsed = watch.elapsed();
  return out;
}

}  // namespace

ParsedFile read_scene_file(const std::string& path, const ReadOptions& options) {
  return parsed_file(options, [&](Sources& sources, ModelStore& models, const ParseOptions& parse) {
    return is_model_file(path) ? parse_model(sources, path, options.model, models, parse)
                               : parse_file(sources, path, parse);
  });
}

ParsedFile read_scene_text(const std::string& name, std::string text, const ReadOptions& options) {
  return parsed_file(options, [&](Sources& sources, ModelStore&, const ParseOptions& parse) {
    return parse_text(sources, name, std::move(text), "", parse);
  });
}

PlannedWorld plan_world(const SceneDescription& world, const Sources& sources, const PlanOptions& options) {
  const Stopwatch watch;
  PlannedWorld out;
  const ValuePosition position = [&sources](const Parameter& p, size_t i) { return value_position(sources, p, i); };
  Diagnostics unweighed;
  out.bound = bind_scene(world, position, unweighed, !options.off.has(Effect::Textures));
  out.plan = plan_effects(out.bound, options);
  out.said = weigh_problems(out.bound, out.plan);
  check_build(out.plan, out.said);
  out.elapsed = watch.elapsed();
  return out;
}

Diagnostics all_problems(const ParsedFile& file, const std::function<Diagnostics(PlannedWorld)>& further) {
  Diagnostics all = file.said;
  Diagnostics planning, found;
  for (const SceneDescription& world : file.worlds) {
    PlannedWorld planned = plan_world(world, *file.sources);
    planning.append(planned.said);
    // What is wrong explains what is surprising.
    if (!all.has_errors() && !planning.has_errors()) planning.append(find_surprises(world, planned.plan));
    if (further) found.append(further(std::move(planned)));
  }
  // One place, one message: the parser has said what is wrong there, planning only met the consequence.
  std::set<std::pair<uint32_t, uint64_t>> said;
  for (const Diagnostic& d : all.all()) said.emplace(d.where.file, d.where.offset);
  for (const Diagnostic& d : planning.all()) {
    if (!d.where.known() || said.emplace(d.where.file, d.where.offset).second) all.add(d);
  }
  all.append(found);
  return all;
}

BuiltWorld build_world(PlannedWorld planned, const BuildOptions& options, size_t texture_bytes) {
  return build_with(new_textures(texture_bytes), std::move(planned), options);
}

KeptParts::KeptParts() = default;
KeptParts::~KeptParts() = default;

ParsedFile reread_scene_file(const std::string& path, ReadOptions options, KeptParts& kept) {
  if (!kept.models) kept.models = std::make_unique<ModelStore>(options.allow_outside);
  // Pictures of a model that is read again would be decoded textures beside those of its old self.
  else if (!kept.models->refresh()) kept.textures.reset();
  options.models = kept.models.get();
  return read_scene_file(path, options);
}

BuiltWorld rebuild_world(PlannedWorld planned, BuildOptions options, KeptParts& kept, size_t texture_bytes) {
  options.kept = &kept.geometry;
  if (!kept.textures || kept.textures->failed() || !kept.textures->is_current())
    kept.textures = new_textures(texture_bytes);
  return build_with(kept.textures, std::move(planned), options);
}

Diagnostics set_samples(BuiltWorld& world, int samples_per_pixel, uint32_t seed) {
  Diagnostics said;
  Bound<Sampler>& sampler = world.scene->bound.sampler;
  sampler.plugin->seed = seed;
  PrepareContext context;
  context.diagnostics = &said;
  context.statement = sampler.where;
  context.textures = world.textures.get();
  context.samples_per_pixel = world.scene->samples_per_pixel = sampler.plugin->set_samples_per_pixel(samples_per_pixel);
  sampler.plugin = prepared(std::move(sampler.plugin), context);
  return said;
}

void set_camera(BuiltWorld& world, const Mat4d& world_to_camera) {
  world.scene->camera_keys = {world_to_camera.gjInverse() * world.scene->space.from_world()};
}

Diagnostics set_resolution(BuiltWorld& world, Vec2i resolution) {
  Diagnostics said;
  Bound<Camera>& camera = world.scene->bound.camera;
  camera.plugin->film.resolution = resolution;
  PrepareContext context;
  context.diagnostics = &said;
  context.statement = camera.where;
  context.textures = world.textures.get();
  context.samples_per_pixel = world.scene->samples_per_pixel;
  camera.plugin = prepared(std::move(camera.plugin), context);
  return said;
}

RenderedWorld render_world(const BuiltWorld& world, RenderOptions options) {
  options.progress = [&world, report = std::move(options.progress)](double share) {
    return (!report || report(share)) && (world.keep_going || !world.textures->failed());
  };
  const Stopwatch watch;
  RenderedWorld out;
  out.result = render(*world.scene, options);
  out.said = world.textures->errors();
  out.elapsed = watch.elapsed();
  return out;
}

}  // namespace whit
