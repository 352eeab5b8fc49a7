#include "core/accuracy/cost_world.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "core/plugin/memory_limit.h"
#include "core/session/denoised.h"
#include "core/session/memory.h"

namespace whit {
namespace {

/// No other film of a study has it.
constexpr uint32_t kFirstLookSeed = 2000;
/// Samples that are added at once, so that a render can be stopped within a tile.
constexpr uint32_t kStep = 256;

Elapsed more(const Elapsed& a, const Elapsed& b) {
  return {std::max(0.0, a.wall - b.wall), std::max(0.0, a.cpu - b.cpu)};
}

/// A folder that is gone at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::error_code error;
    std::string name = (std::filesystem::temp_directory_path(error) / "whit-cost-XXXXXX").string();
    if (!error && ::mkdtemp(name.data())) path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// The picture's file, where nobody looks for it: writing it is part of what a command takes.
OutputPlan plan_hidden_output(const Bound<Film>& film, const std::string& folder) {
  const std::filesystem::path own(film.plugin->file_name());
  OutputRequest request;
  request.outfile = folder + "/picture" + (own.has_extension() ? own.extension().string() : ".exr");
  return plan_output(request, film);
}

MemoryPlan memory_of(const PlannedWorld& planned, const CostVariant& variant, const CostRequest& request, int pairs) {
  // Each takes four times the time of the one before: few have more.
  constexpr int kLevels = 3, kHalves = 2;
  const int replicates = replicates_of(planned.bound.film.plugin->resolution());
  MemoryRequest wanted;
  FilmNeed& film = wanted.film;
  film.threads = request.threads;
  film.films = pairs > 0 ? 2 : replicates + kHalves;
  film.kept_pictures = pairs > 0 ? 2 * pairs : kLevels * replicates;
  film.denoise = variant.denoiser != nullptr;
  if (film.denoise) film.aovs = {"albedo", "N"};
  return plan_memory(planned, wanted);
}

/// One sample per pixel, with all that a render has around it.
struct FirstLook {
  Elapsed samples, around;
  bool complete = false;
};

FirstLook look(CostWorld& world, bool write) {
  FirstLook out;
  const Stopwatch all;
  FilmRender film(world.scene(), world.options);
  const Stopwatch watch;
  out.complete = film.extend(1u);
  out.samples = {watch.elapsed().wall, film.cpu_seconds()};
  if (!out.complete) return out;
  const Stopwatch after;
  const RenderResult result = film.result();
  world.invalid_samples = result.statistics.invalid_samples;
  if (write) world.said.append(write_output(world.output, result, {}).said);
  out.around = more(all.elapsed(), watch.elapsed()) + after.elapsed();
  return out;
}

}  // namespace

int replicates_of(Vec2i resolution) {
  constexpr int kMany = 8, kFew = 4;
  constexpr int64_t kManyPixels = 4'000'000;
  return int64_t{resolution.x} * resolution.y > kManyPixels ? kFew : kMany;
}

StatementPlace statement_place(const Sources& sources) {
  return [&sources](SourcePos where) {
    const SourcePlace p = sources.place(where);
    return fmt::format("{}:{}:{}", sources.name(where.file), p.line, p.column);
  };
}

CostWorld open_world(ParsedFile& file, size_t number, const CostVariant& variant, const CostRequest& request, int pairs,
                     CostClock& clock) {
  CostWorld world;
  world.description = &file.worlds[number];
  const ScopedOverrides scope(file.worlds[number], variant.overrides);
  if (!scope.problem().empty()) world.said.error(world.description->world_begin, scope.problem());
  const Stopwatch planning;
  PlannedWorld planned = plan_world(*world.description, *file.sources, {.off = variant.off});
  world.said.append(planned.said);
  if (world.said.has_errors() || !planned.bound.film.plugin) return world;
  const TemporaryFolder folder;
  if (folder.path().empty())
    world.said.file_error({}, "cannot make a temporary folder", "TMPDIR names the place for it");
  if (world.said.has_errors()) return world;
  world.output = plan_hidden_output(planned.bound.film, folder.path());
  world.said.append(world.output.said);
  if (world.said.has_errors()) return world;
  BuildOptions options;
  options.seed = request.seed;
  options.robust_traversal = variant.robust;
  MemoryPlan memory = memory_of(planned, variant, request, pairs);
  fit_textures(memory, memory_limit());
  world.said.append(memory_problem(memory, memory_limit()));
  if (world.said.has_errors()) return world;
  world.built = build_world(std::move(planned), options, static_cast<size_t>(memory.texture_cap()));
  world.said.append(world.built.said);
  world.fixed = planning.elapsed();
  if (world.said.has_errors() || !world.built.scene) return world;

  world.own_samples = world.scene().samples_per_pixel;
  world.options.threads = request.threads;
  world.denoiser = variant.denoiser;
  if (world.denoiser) render_guides(world.output);
  world.options.aovs = {world.output.rendered_aovs(), statement_place(*file.sources)};
  TextureStore* const textures = world.built.textures.get();
  world.options.progress = [&clock, textures](double) { return clock.go_on() && !textures->failed(); };
  set_samples(world.built, 1, request.seed + kFirstLookSeed);
  const FirstLook first = look(world, true), again = first.complete ? look(world, false) : FirstLook{};
  world.said.append(textures->errors());
  world.too_slow = !again.complete;
  world.usable = again.complete && !world.said.has_errors();
  world.fixed = world.fixed + first.around + more(first.samples, again.samples);
  world.per_sample = again.samples;
  return world;
}

SeededFilms::SeededFilms(CostWorld& world, uint32_t first_seed, int count) : world_(world) {
  for (int i = 0; i < count; ++i) films_.push_back({first_seed + static_cast<uint32_t>(i), nullptr});
}

bool SeededFilms::grow(int number, int samples) {
  Film& film = films_[static_cast<size_t>(number)];
  set_samples(world_.built, samples, film.seed);
  const Scene& scene = world_.scene();
  if (!film.render || !scene.sampler().extends()) {
    film.render = std::make_unique<FilmRender>(scene, world_.options);
    film.wall = 0;
  }
  const Stopwatch watch;
  const auto wanted = static_cast<uint32_t>(scene.samples_per_pixel);
  bool complete = true;
  for (uint32_t n = 0; complete && n < wanted;) complete = film.render->extend(n = std::min(wanted, n + kStep));
  film.wall += watch.elapsed().wall;
  return complete;
}

Elapsed SeededFilms::spent(int number) const {
  const Film& film = films_[static_cast<size_t>(number)];
  return {film.wall, film.render->cpu_seconds()};
}

}  // namespace whit
