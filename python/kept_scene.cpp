#include "python/kept_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/plugin/memory_limit.h"
#include "core/plugin/registry.h"
#include "core/scene/problems.h"
#include "core/session/files.h"
#include "core/session/memory.h"
#include "core/session/models.h"
#include "python/version.h"

namespace whit::python {
namespace {

Failure wrong(const std::string& problem) { return {FailureKind::Usage, problem}; }

/// Warnings as errors.
Diagnostics strict(const Diagnostics& diagnostics) {
  Diagnostics out;
  for (Diagnostic d : diagnostics.all()) {
    d.severity = Severity::Error;
    out.add(std::move(d));
  }
  return out;
}

EffectSet effects_of(const char* what, const std::vector<std::string>& names) {
  std::string unknown;
  const EffectSet effects = parse_effects(fmt::format("{}", fmt::join(names, ",")), unknown);
  if (unknown.empty()) return effects;
  const std::string hint = did_you_mean(unknown, effect_names());
  throw wrong(fmt::format("{}: there is no effect \"{}\"; {}", what, unknown,
                          hint.empty() ? fmt::format("there are {}", fmt::join(effect_names(), ", ")) : hint));
}

/// Imath's matrices are for rows.
Mat4d matrix_for_rows(const std::array<double, 16>& m) {
  Mat4d out;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) out[j][i] = m[static_cast<size_t>(4 * i + j)];
  return out;
}

std::array<double, 16> matrix_for_columns(const Mat4d& m) {
  std::array<double, 16> out;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) out[static_cast<size_t>(4 * i + j)] = m[j][i];
  return out;
}

/// A camera's place must be one: finite, affine, and with an inverse.
Mat4d camera_of(const std::array<double, 16>& m) {
  const Mat4d out = matrix_for_rows(m);
  const bool finite = std::all_of(m.begin(), m.end(), [](double x) { return std::isfinite(x); });
  if (!finite || m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
    throw wrong("camera: needs 4 x 4 finite numbers whose last row is 0 0 0 1 (world to camera, for column vectors)");
  if (std::abs(out.determinant()) < std::numeric_limits<double>::min())
    throw wrong("camera: this matrix has no inverse; look_at() makes one that has");
  return out;
}

}  // namespace

const std::string& SceneSource::name() const {
  static const std::string kText = "<text>";
  return text ? kText : path;
}

ParsedFile read_source(const SceneSource& source, const ReadOptions& options) {
  return source.text ? read_scene_text(source.name(), *source.text, options) : read_scene_file(source.path, options);
}

ReadOptions read_options(const ModelWish& wish, const SceneSource& source) {
  const std::pair<const char*, bool> given[] = {{"model_scene", !wish.scene.empty()},
                                                {"model_camera", !wish.camera.empty()},
                                                {"model_time", wish.time.has_value()},
                                                {"model_variant", !wish.variant.empty()}};
  for (const auto& [argument, is_given] : given) {
    if (is_given && (source.text || !is_model_file(source.path)))
      throw wrong(fmt::format("{} is of glTF models, and {} is none; a scene says it by its own statements", argument,
                              source.text ? "a text" : '"' + source.path + '"'));
  }
  ReadOptions options;
  options.model.scene = wish.scene, options.model.camera = wish.camera, options.model.variant = wish.variant;
  options.model.time = wish.time, options.allow_outside = wish.allow_outside;
  return options;
}

PlanOptions plan_options(const PlanWish& wish) {
  PlanOptions options;
  if (wish.without && wish.only) throw wrong("without and only exclude each other");
  if (wish.without) options.off = effects_of("without", *wish.without);
  if (wish.only) options.off = EffectSet::all() - effects_of("only", *wish.only);
  return options;
}

std::string apply_overrides(const PlanWish& wish, ParsedFile& file) {
  if (const std::string problem = usage_problem(wish.overrides); !problem.empty()) throw wrong(problem);
  return override_worlds(file, wish.overrides);
}

KeptScene::KeptScene(const SceneSource& source, const SceneWish& wish, const RenderWish& first)
    : source_(source), wish_(wish) {
  file_ = read_source(source, read_options(wish.model, source));
  times_.parse = file_.elapsed;
  parsed_memory_ = static_cast<double>(resident_memory());
  const std::string problem = apply_overrides(wish, file_);
  if (problem.empty() && wish.extending) {
    for (SceneDescription& world : file_.worlds) use_extending_sampler(world);
  }
  // A file with mistakes is reported whole: also what planning would have said of it.
  take(file_.said.has_errors() ? all_problems(file_) : file_.said);
  if (!problem.empty()) throw wrong(problem);
  const size_t worlds = file_.worlds.size();
  if (worlds == 0) throw Failure(FailureKind::Scene, source.name() + ": there is no WorldBegin in it", said_);
  if (wish.world < 0 || static_cast<size_t>(wish.world) >= worlds)
    throw wrong(fmt::format("world: {} has the worlds 0 to {}, and no {}", source.name(), worlds - 1, wish.world));
  plan_and_build(first);
}

KeptScene::~KeptScene() = default;

void KeptScene::plan_and_build(const RenderWish& first) {
  const bool reported = file_.said.has_errors();
  PlannedWorld planned = plan_world(world(), *file_.sources, plan_options(wish_));
  // What is wrong explains what is surprising.
  if (!planned.said.has_errors()) planned.said.append(find_surprises(world(), planned.plan));
  times_.plan = planned.elapsed;
  if (!reported) take(planned.said);
  if (!planned.bound.film.plugin) throw Failure(FailureKind::Scene, "the scene's film cannot be used", said_);
  const Stopwatch estimating;
  MemoryPlan memory = plan_memory_for(planned, first);
  memory_estimate_ = memory.total();
  fit_textures(memory, memory_limit());
  times_.plan += estimating.elapsed();
  if (const Diagnostics limit = memory_problem(memory, memory_limit()); limit.has_errors())
    throw failure_of(*file_.sources, limit, said_of(*file_.sources, limit));
  BuildOptions options;
  options.samples_per_pixel = wish_.spp, options.footprint_samples = wish_.footprint_spp, options.seed = wish_.seed;
  options.quick = wish_.quick, options.keep_going = wish_.keep_going;
  options.robust_traversal = !wish_.fast_traversal;
  built_ = build_world(std::move(planned), options, static_cast<size_t>(memory.texture_cap()));
  times_.build = built_.elapsed;
  take(built_.said);
  if (!built_.scene) throw Failure(FailureKind::Scene, "nothing of the scene can be rendered", said_);
  const Scene& scene = *built_.scene;
  own_ = now_ = {scene.camera_keys, scene.camera().film.resolution, scene.samples_per_pixel, wish_.seed};
}

/// What is said is kept; errors end all, unless they are gone past.
void KeptScene::take(const Diagnostics& found) {
  const Diagnostics d = wish_.strict ? strict(found) : found;
  // Going past an error, a later step meets it again.
  for (const Diagnostic& one : d.all()) {
    if (!one.where.known() || known_.emplace(one.where.file, one.where.offset, one.message).second)
      said_.push_back(said_of(*file_.sources, one));
  }
  if (d.has_errors() && !wish_.keep_going) throw failure_of(*file_.sources, d, said_);
}

MemoryPlan KeptScene::plan_memory_for(const PlannedWorld& planned, const RenderWish& first) const {
  MemoryRequest request;
  request.texture_bytes = static_cast<size_t>(wish_.texture_memory * 1024 * 1024);
  FilmNeed& film = request.film;
  film.threads = first.threads;
  film.crop_given = first.crop.has_value();
  if (first.crop) std::copy(first.crop->begin(), first.crop->end(), film.crop);
  film.quick = wish_.quick;
  if (unknown_aov(first.aovs).empty()) film.aovs = first.aovs;
  film.blocks = first.has_target(), film.adaptive = first.goal.error > 0;
  return plan_memory(planned, request);
}

std::vector<Said> KeptScene::said() const {
  const std::lock_guard lock(mutex_);
  return said_;
}

std::array<double, 16> KeptScene::camera() const {
  const TransformPair placed = world().transforms[static_cast<size_t>(world().camera_transform)];
  return matrix_for_columns(placed.start);
}

/// Names of AOVs, the film's where none are asked for.
std::vector<std::string> KeptScene::aovs_of(const RenderWish& wish) const {
  const StringList& films = built_.scene->film().aovs();
  std::vector<std::string> names =
      wish.aovs.empty() ? std::vector<std::string>(films.values.begin(), films.values.end()) : wish.aovs;
  if (names == std::vector<std::string>{"none"}) names.clear();
  const std::string problem = unknown_aov(names);
  if (problem.empty()) return names;
  if (!wish.aovs.empty()) throw wrong("aovs: " + problem);
  Diagnostics said;
  said.error(films.where, problem);
  throw failure_of(*file_.sources, said, said_of(*file_.sources, said));
}

/// Makes the scene what the wish says, as far as it is not.
void KeptScene::set(const RenderWish& wish) {
  if (wish.camera) set_camera(built_, camera_of(*wish.camera));
  else built_.scene->camera_keys = own_.camera;
  const Vec2i resolution = wish.resolution.value_or(own_.resolution);
  if (resolution != now_.resolution) {
    now_.resolution = {0, 0};  // Of no use until all went well.
    take(set_resolution(built_, resolution));
    now_.resolution = resolution;
  }
  const int samples = wish.spp.value_or(own_.samples);
  const uint32_t seed = wish.seed.value_or(own_.seed);
  if (samples == now_.samples && seed == now_.seed) return;
  now_.samples = 0;
  take(set_samples(built_, samples, seed));
  now_.samples = samples, now_.seed = seed;
}

/// A camera or a sampler that could not be prepared for what was asked is lost.
void KeptScene::require_usable() const {
  const BoundScene& bound = built_.scene->bound;
  if (bound.camera.plugin && bound.sampler.plugin) return;
  throw Failure(
      FailureKind::Scene,
      "the scene's camera or sampler cannot be had with a resolution or a number of samples that was asked for; "
      "make the Scene anew",
      said_);
}

RenderOptions KeptScene::options_for(const RenderWish& wish) const {
  RenderOptions options;
  const Sources& sources = *file_.sources;
  const std::string path = source_.text ? "" : source_.path;
  options.aovs = {aovs_of(wish), [&sources, path](SourcePos where) { return place_in_scene(sources, where, path); }};
  options.threads = wish.threads;
  options.crop_given = wish.crop.has_value();
  if (wish.crop) std::copy(wish.crop->begin(), wish.crop->end(), options.crop);
  return options;
}

/// As many samples as the scene or the wish says; or to an accuracy, or until time is up.
RenderedWorld KeptScene::trace(const RenderWish& wish, RenderOptions options, Attention& attention,
                               std::optional<Json::Object>& target) {
  if (!wish.has_target()) {
    options.progress = [&](double share) { return attention.go_on(share); };
    return render_world(built_, std::move(options));
  }
  TargetRequest request;
  request.error = wish.goal.error, request.confidence = wish.goal.confidence;
  request.max_samples = static_cast<uint32_t>(wish.max_samples);
  if (wish.time_limit > 0) {
    request.deadline = started_ + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                      std::chrono::duration<double>(wish.time_limit));
  }
  request.progress = [&](const TargetState& state) { return attention.go_on(state.share); };
  now_.samples = 0;  // They may be set to others.
  TargetOutcome outcome = render_to_target(built_, std::move(options), request, wish.seed.value_or(own_.seed));
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - started_;
  target = target_json(outcome, wish.goal, seconds.count());
  return std::move(outcome.rendered);
}

std::unique_ptr<RenderedPicture> KeptScene::render(const RenderWish& wish, Attention& attention) {
  const std::lock_guard lock(mutex_);
  require_usable();
  OutputPlan output;
  const Stopwatch preparing;
  RenderOptions options = options_for(wish);
  output.aovs = options.aovs.names;
  set(wish);
  require_usable();
  times_.output = preparing.elapsed();
  times_.ready = times_.parse + times_.plan + times_.output + times_.build;
  std::optional<Json::Object> target;
  RenderedWorld rendered = trace(wish, std::move(options), attention, target);
  times_.render = rendered.elapsed;
  take(rendered.said);
  std::unique_ptr<RenderedPicture> picture = picture_of(std::move(rendered), wish, output);
  picture->target = std::move(target);
  times_ = {};  // What was done before is nothing in the times of another picture.
  return picture;
}

std::unique_ptr<RenderedPicture> KeptScene::picture_of(RenderedWorld rendered, const RenderWish& wish,
                                                       const OutputPlan& output) {
  auto picture = std::make_unique<RenderedPicture>();
  picture->result = std::move(rendered.result);
  const RenderResult& result = picture->result;
  const uint32_t seed = wish.seed.value_or(own_.seed);
  PictureSettings asked;
  asked.scene = source_.name(), asked.command = wish.command, asked.version = version();
  asked.traversal = wish_.fast_traversal ? "fast" : "robust";
  asked.texture_filter = wish_.overrides.texture_filter, asked.texture_memory = wish_.texture_memory;
  asked.seed = seed;
  picture->statistics = picture_stats(asked, {*built_.scene, result, output, *built_.textures, times_,
                                              world().unread_files.size(), parsed_memory_, memory_estimate_});
  picture->said = said_;
  picture->metadata = {{"Software", fmt::format("whit {}", version())},
                       {"whit:command", wish.command},
                       {"whit:scene", source_.name()},
                       {"whit:samplesPerPixel", static_cast<int>(std::lround(result.samples_per_pixel))},
                       {"whit:seed", std::to_string(seed)}};
  if (!result.complete) {
    picture->metadata.push_back(
        {"whit:incomplete", fmt::format("stopped with {:.3g} % of the samples", 100 * result.share)});
  }
  picture->aovs = output.aovs, picture->read = files_read(world());
  picture->view = built_.scene->film().view(), picture->exposure = built_.scene->film().exposure();
  return picture;
}

}  // namespace whit::python
