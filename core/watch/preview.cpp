#include "core/watch/preview.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <iterator>
#include <map>
#include <mutex>
#include <new>
#include <string_view>
#include <thread>
#include <utility>

#include "core/plugin/memory_limit.h"
#include "core/plugin/registry.h"
#include "core/render/film_render.h"
#include "core/render/look.h"
#include "core/scene/problems.h"
#include "core/session/files.h"
#include "core/session/memory.h"
#include "core/watch/effect_costs.h"
#include "core/watch/halves.h"
#include "core/watch/watched_files.h"

namespace whit {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// What somebody wants, as bits.
enum Wish : uint32_t { kRead = 1, kBuild = 2, kCamera = 4, kStop = 8 };

/// First pixels come within so many seconds, as far as that can be known.
constexpr double kFirstSeconds = 0.05;
/// A whole pass that takes less needs no coarse one before it.
constexpr double kShortPass = 0.08;
constexpr int kCoarsest = 16;
/// Passes add no more samples than that: the longest tile must be over soon when something changes.
constexpr uint32_t kMostAdded = 16;
/// Pictures follow each other no faster.
constexpr double kBetweenPictures = 0.08;
constexpr size_t kPicturesKept = 4;
constexpr size_t kProblemsShown = 50;

/// A text and what was made of it, which belong together. The scene changes its camera and resolution between renders.
struct World {
  std::shared_ptr<ParsedFile> file;
  BuiltWorld built;
  Mat4d base;  ///< World to camera, as the file has it.
  Vec3d up;    ///< Of the file's LookAt.
  Vec2i resolution{0, 0};
  mutable std::timed_mutex changing;  ///< Held while the scene changes, or is looked at by others than the renderer.

  const SceneDescription& description() const { return file->worlds.front(); }
  const Sources& sources() const { return *file->sources; }
};

PlaceInFile place_of(const Sources& sources, SourcePos where) {
  if (!where.known() || where.file >= sources.size()) return {};
  const SourcePlace at = sources.place(where);
  PlaceInFile place{sources.name(where.file), "", at.line, at.column};
  std::error_code failed;
  const std::filesystem::path whole = std::filesystem::absolute(place.file, failed);
  place.path = failed || !std::filesystem::exists(whole, failed) ? "" : whole.lexically_normal().string();
  return place;
}

std::string excerpt_of(const Sources& sources, const Diagnostic& d) {
  Diagnostic bare = d;
  bare.remedy.clear(), bare.other = {};
  const std::string text = sources.render_diagnostic(bare, false);
  const size_t first = text.find('\n');
  return first == std::string::npos ? "" : text.substr(first + 1);
}

/// How many problems one is about: the last of a file may say how many more there are (Reporter::finish()).
size_t stands_for(const Diagnostic& d) {
  constexpr std::string_view kAnd = "and ", kMore = " more ";
  if (d.message.rfind(kAnd, 0) != 0) return 1;
  size_t n = 0;
  const char* const end = d.message.data() + d.message.size();
  const auto [behind, failed] = std::from_chars(d.message.data() + kAnd.size(), end, n);
  const std::string_view rest(behind, static_cast<size_t>(end - behind));
  return failed == std::errc() && rest.rfind(kMore, 0) == 0 ? n : 1;
}

std::vector<PreviewProblem> problems_of(const Sources& sources, const Diagnostics& said, size_t& left_out) {
  std::vector<Diagnostic> all = said.all();
  const auto is_error = [](const Diagnostic& d) {
    return d.severity == Severity::Error || d.excused || d.slip.known();
  };
  std::stable_sort(all.begin(), all.end(),
                   [&](const Diagnostic& a, const Diagnostic& b) { return is_error(a) > is_error(b); });
  std::vector<PreviewProblem> out;
  for (const Diagnostic& d : all) {
    if (out.size() == kProblemsShown) break;
    out.push_back({is_error(d), place_of(sources, d.where), d.message, d.remedy,
                   d.where.known() ? excerpt_of(sources, d) : "", d.name == kLimitHit});
  }
  left_out = 0;
  for (size_t i = out.size(); i < all.size(); ++i) left_out += stands_for(all[i]);
  return out;
}

std::string causes_of(const EffectUse& use, const Sources& sources) {
  std::string text;
  for (const EffectCause& cause : use.causes) {
    const PlaceInFile at = place_of(sources, cause.where);
    const std::string file = std::filesystem::path(at.file).filename().string();
    text += fmt::format("{}{}", text.empty() ? "" : ", ", cause.what);
    if (at.line > 0) text += fmt::format(" ({}:{})", file, at.line);
  }
  if (use.count > use.causes.size()) text += fmt::format("; {} in all", use.count);
  return text;
}

/// The files that a text is made of, and those that its world names.
std::vector<std::string> files_of(const std::string& path, const ParsedFile& file) {
  std::vector<std::string> files{path};
  const auto add = [&](const std::string& name) {
    if (!name.empty() && std::find(files.begin(), files.end(), name) == files.end()) files.push_back(name);
  };
  for (const std::string& text : texts_of(file)) add(text);
  for (const std::string& missing : missing_includes(*file.sources, file.said, path)) add(missing);
  const std::vector<std::string> named = assets_of(file);
  std::copy_if(named.begin(), named.end(), std::back_inserter(files), [&, first = files](const std::string& n) {
    return std::find(first.begin(), first.end(), n) == first.end();
  });
  return files;
}

}  // namespace

const char* phase_name(PreviewPhase phase) {
  switch (phase) {
    case PreviewPhase::Reading: return "reading";
    case PreviewPhase::Building: return "building";
    case PreviewPhase::Rendering: return "rendering";
    case PreviewPhase::Done: return "done";
  }
  return "";
}

struct Preview::Impl {
  explicit Impl(PreviewRequest asked) : request(std::move(asked)), off(request.off) {
    files.watch({request.path}, FileWatch::now_mark());
    watched = {request.path};
    state.files = 1;
    worker = std::thread([this] {
      work();
      {
        const std::lock_guard lock(mutex);
        worked = true;
      }
      state_changed.notify_all();
    });
    watcher = std::thread([this] { watch(); });
  }

  ~Impl() {
    wish(kStop);
    files.wake();
    watcher.join();
    worker.join();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  // ---- What others want ----

  void wish(uint32_t what) {
    {
      const std::lock_guard lock(mutex);
      if (wishes == 0) wished_at = Clock::now();
      wishes |= what;
    }
    wishes_changed.notify_all();
  }

  bool wanted(uint32_t which) const { return (wishes.load() & which) != 0; }

  /// Waits for wishes, or for that long. They are taken: from now on they are the caller's.
  uint32_t take_wishes(int milliseconds) {
    std::unique_lock lock(mutex);
    wishes_changed.wait_for(lock, std::chrono::milliseconds(milliseconds), [&] { return wishes != 0; });
    const uint32_t taken = wishes & ~kStop;
    if (taken != 0) changed_at = wished_at;
    wishes &= kStop;
    return taken;
  }

  void watch() {
    while (!wanted(kStop)) {
      guarded([this] {
        if (!files.wait(60'000).empty()) wish(kRead);
      });
    }
  }

  // ---- What they see ----

  template <class Change>
  void publish(const Change& change) {
    {
      const std::lock_guard lock(mutex);
      change(state);
      ++state.version;
    }
    state_changed.notify_all();
  }

  void set_phase(PreviewPhase phase) {
    publish([&](PreviewState& s) { s.phase = phase; });
  }

  // ---- The worker ----

  void work() {
    uint32_t todo = kRead;
    changed_at = Clock::now();
    while (!wanted(kStop)) {
      if (!guarded([&] { do_it(todo); })) film.reset(), unfinished = false;
      todo = take_wishes(1000);
    }
  }

  void do_it(uint32_t todo) {
    const bool made = (todo & (kRead | kBuild)) != 0 && make_world((todo & kRead) != 0);
    if (!world || todo == 0) return;
    // What failed leaves the picture as it is; one that was not finished goes on.
    if (made || (todo & kCamera) != 0) {
      place_camera();
      if (render()) finish();
    } else if (unfinished && (film ? render_passes() : render())) {
      finish();
    }
  }

  /// Runs it. What it cannot do for want of memory, for example, is a problem like others: the next text may do. False then.
  template <class Work>
  bool guarded(const Work& work) {
    std::string what;
    bool is_limit = false;
    try {
      work();
      return true;
    } catch (const std::bad_alloc&) {
      what = "there is not enough memory", is_limit = true;
    } catch (const std::exception& e) { what = e.what(); }
    publish([&](PreviewState& s) {
      s.problems = {{true, {}, "this cannot be shown: " + what, "", "", is_limit}};
      s.problems_left_out = 0, s.stale = true, s.phase = PreviewPhase::Done;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(100));  // It may happen again at once.
    return false;
  }

  /// Reads if asked for, and builds. False when that fails: what there was stays.
  bool make_world(bool read) {
    if (read || !file) {
      set_phase(PreviewPhase::Reading);
      read_file();
    }
    if (!file || file->said.has_errors() || file->worlds.empty()) return false;
    set_phase(PreviewPhase::Building);
    EffectSet now_off;
    {
      const std::lock_guard lock(mutex);
      now_off = off;
    }
    const Stopwatch building;
    const SceneDescription& description = file->worlds.front();
    PlannedWorld planned = plan_world(description, *file->sources, {.off = now_off});
    Diagnostics said = file->said;
    said.append(planned.said);
    if (planned.said.has_errors() || !planned.bound.film.plugin) return refuse(said);
    said.append(find_surprises(description, planned.plan));
    size_t texture_bytes = 0;
    if (!make_room(planned, texture_bytes, said)) return refuse(said);
    auto made = std::make_shared<World>();
    made->file = file;
    made->built = rebuild(std::move(planned), texture_bytes);
    said.append(made->built.said);
    if (said.has_errors() || !made->built.scene) return refuse(said);
    made->base = description.transforms[static_cast<size_t>(description.camera_transform)].start;
    made->up = up_of_camera(*file->sources, description);
    made->resolution = made->built.scene->camera().film.resolution;
    take_over(std::move(made), said, building.elapsed().wall);
    return true;
  }

  bool refuse(const Diagnostics& said) {
    tell(said, true);
    return false;
  }

  /// What a preview of a world is going to take of memory; `resident` as MemoryRequest::resident.
  MemoryPlan memory_of(const PlannedWorld& planned, double resident) const {
    // Pictures as half floats, and one more in floats while it is made and shown.
    constexpr double kKept = 0.5 * kPicturesKept + 1;
    MemoryRequest wanted{.texture_bytes = request.texture_bytes, .resident = resident};
    FilmNeed& need = wanted.film;
    need.threads = request.threads, need.quick = request.build.quick;
    need.linear = need.display = false, need.kept_pictures = kKept;
    MemoryPlan memory = plan_memory(planned, wanted);
    fit_textures(memory, memory_limit());
    return memory;
  }

  /// Whether there is memory for what was planned, beside the world that there is; else without it, which then goes before.
  bool make_room(const PlannedWorld& planned, size_t& texture_bytes, Diagnostics& said) {
    const auto limit = static_cast<double>(memory_limit()), now = static_cast<double>(resident_memory());
    MemoryPlan memory = memory_of(planned, now);
    if (memory.total() > limit && world) {
      memory = memory_of(planned, std::max(memory_before, now - memory_taken));
      if (memory.total() <= limit) let_go();
    }
    said.append(memory_problem(memory, memory_limit()));
    texture_bytes = static_cast<size_t>(memory.texture_cap());
    if (memory.total() > limit) return false;
    if (!world) memory_before = now;
    memory_taken = memory.total(MemoryStep::Rendering) - memory.of(MemoryUse::Program, MemoryStep::Rendering);
    return true;
  }

  /// The world goes, its picture stays.
  void let_go() {
    film.reset();
    unfinished = false;
    const std::lock_guard lock(mutex);
    world.reset();
    kept.geometry.clear();
    kept.textures.reset();
  }

  /// Meshes and textures that did not change stay what they are, and nobody looks at them meanwhile.
  BuiltWorld rebuild(PlannedWorld planned, size_t texture_bytes) {
    std::unique_lock<std::timed_mutex> lock;
    if (world) lock = std::unique_lock(world->changing);
    return rebuild_world(std::move(planned), request.build, kept, texture_bytes);
  }

  void read_file() {
    const long long started = FileWatch::now_mark();
    ReadOptions options = request.read;
    options.copy_files = true;
    auto read = std::make_shared<ParsedFile>(reread_scene_file(request.path, options, kept));
    std::vector<std::string> names = files_of(request.path, *read);
    if (read->said.has_errors() || read->worlds.empty()) {
      // What the last text was made of still counts: the mistake may be gone when one of these is back.
      names.insert(names.end(), watched.begin(), watched.end());
      std::sort(names.begin(), names.end());
      names.erase(std::unique(names.begin(), names.end()), names.end());
    }
    files.watch(names, started);
    watched = names;
    files.wake();
    const std::string problem = override_worlds(*read, request.overrides);
    if (!problem.empty()) read->said.add({Severity::Error, ErrorClass::Usage, {}, problem});
    publish([&](PreviewState& s) {
      s.files = names.size();
      s.read_seconds = read->elapsed.wall;
      s.worlds = read->worlds.size();
      ++s.reading;
    });
    file = std::move(read);
    if (file->said.has_errors()) tell(all_problems(*file), true);
    else if (file->worlds.empty()) {
      Diagnostics none = file->said;
      none.error({}, fmt::format("{} has no WorldBegin: there is nothing to render", request.path));
      tell(none, true);
    }
  }

  /// What was said of the text that there is now; `failed`: the picture is of an earlier one.
  void tell(const Diagnostics& said, bool failed) {
    size_t left_out = 0;
    std::vector<PreviewProblem> problems = problems_of(*file->sources, said, left_out);
    publish([&](PreviewState& s) {
      s.problems = std::move(problems), s.problems_left_out = left_out;
      s.stale = failed;
      if (failed) s.phase = PreviewPhase::Done;
    });
  }

  void take_over(std::shared_ptr<World> made, const Diagnostics& said, double seconds) {
    film.reset();
    // A camera that was moved stays where it is, until the file has another.
    {
      const std::lock_guard lock(mutex);
      if (world && world->base != made->base) moved.reset();
      if (!world || world->file != made->file) costs.clear();
      world = std::move(made);
    }
    const Scene& scene = *world->built.scene;
    publish([&](PreviewState& s) {
      s.build_seconds = seconds;
      s.triangles = scene.triangle_count(), s.lights = scene.lights.size();
      s.integrator = integrator_in_force(world->description()).name;
      s.effects = effects_of(scene.plan);
    });
    tell(said, false);
  }

  std::vector<PreviewEffect> effects_of(const EffectPlan& plan) const {
    std::vector<PreviewEffect> out;
    for_effects(plan.called_for, [&](Effect e) {
      PreviewEffect effect;
      effect.effect = e;
      effect.off = plan.off_by_hand.has(e);
      if (plan.off.has(e) && !effect.off) effect.why_off = plan.use(e).why_off;
      effect.causes = causes_of(plan.use(e), world->sources());
      const auto cost = costs.find(e);
      if (cost != costs.end()) effect.cost = cost->second;
      out.push_back(std::move(effect));
    });
    return out;
  }

  // ---- The camera ----

  Mat4d camera_now() const { return moved ? placed_at(world->base, *moved) : world->base; }

  void place_camera() {
    PreviewCamera camera;
    Mat4d m;
    {
      const std::lock_guard lock(mutex);
      m = camera_now();
      camera.moved = moved.has_value();
    }
    const SceneDescription& description = world->description();
    const TransformPair placed = description.transforms[static_cast<size_t>(description.camera_transform)];
    camera.movable = !placed.animated();
    if (camera.movable) {
      const std::lock_guard lock(world->changing);
      set_camera(world->built, m);
    }
    camera.pose = pose_of(m);
    camera.mirrored = swaps_handedness(m);
    const CameraEdit edit = camera_edit(world->sources(), description, m, world->up);
    camera.text = edit.text, camera.refusal = edit.problem;
    if (edit.problem.empty()) camera.where = place_of(world->sources(), {edit.file, edit.begin});
    // What people call up turns with nothing but a roll.
    if (std::abs(world->up.dot(camera.pose.direction)) < 0.9999) camera.pose.up = world->up;
    publish([&](PreviewState& s) { s.camera = std::move(camera); });
  }

  // ---- Rendering ----

  /// Pixels of a pass over the picture.
  double pixels_at(int coarse) const {
    const Vec2i size = world->resolution;
    double crop[4];
    world->built.scene->film().crop_window(crop);
    const double share = std::max(0.0, (crop[1] - crop[0]) * (crop[3] - crop[2]));
    return share * size.x * size.y / (coarse * coarse);
  }

  /// By how much the first picture is coarser.
  int first_coarseness() const {
    if (!world->built.scene->integrator().pixel_bounds().empty()) return 1;  // They are in pixels.
    if (rate <= 0) return pixels_at(8) > 2000 ? 8 : 1;
    if (pixels_at(1) / rate < kShortPass) return 1;
    for (int coarse = 2; coarse < kCoarsest; coarse *= 2) {
      if (pixels_at(coarse) / rate < kFirstSeconds) return coarse;
    }
    return kCoarsest;
  }

  RenderOptions options_until(uint32_t ends_it) const {
    RenderOptions options;
    options.threads = request.threads;
    options.progress = [this, ends_it](double) { return !wanted(ends_it) && !world->built.textures->failed(); };
    return options;
  }

  /// True when the picture is done; false when something else is wanted, or it cannot be.
  bool render() {
    film.reset();
    unfinished = true;
    last_picture = {};
    for (int coarse = first_coarseness(); coarse > 1; coarse = coarse > 4 ? coarse / 4 : coarse / 2) {
      // A camera that moves must show where it is: what follows the first picture may be given up, that not.
      if (!render_coarse(coarse)) return failed_or_wanted();
      if (wanted(~0u)) return false;
    }
    if (!resize(world->resolution)) return false;
    film = std::make_unique<FilmRender>(*world->built.scene, options_until(~0u));
    film_samples = 0, film_seconds = 0;
    return render_passes();
  }

  /// Tells what textures say, if anything. Never true.
  bool failed_or_wanted() {
    if (!world->built.textures->failed()) return false;
    film.reset();
    unfinished = false;
    Diagnostics said = world->file->said;
    said.append(world->built.textures->errors());
    tell(said, true);
    return false;
  }

  bool resize(Vec2i size) {
    const std::lock_guard lock(world->changing);
    if (world->built.scene->camera().film.resolution == size) return true;
    const Diagnostics said = set_resolution(world->built, size);
    if (said.has_errors()) tell(said, true);
    return !said.has_errors();
  }

  bool render_coarse(int coarse) {
    const Vec2i size = (world->resolution + Vec2i(coarse - 1, coarse - 1)) / coarse;
    if (!resize(size)) return false;
    set_phase(PreviewPhase::Rendering);
    FilmRender coarsely(*world->built.scene, options_until(kRead | kBuild | kStop));
    const auto start = Clock::now();
    if (!coarsely.extend(1)) return false;
    note_rate(pixels_at(coarse), seconds_since(start));
    show(coarsely.picture(), 1.0 / (coarse * coarse), false, seconds_since(start));
    return true;
  }

  void note_rate(double samples, double seconds) {
    if (samples > 500 && seconds > 0) rate = samples / seconds;
  }

  /// From where they are.
  bool render_passes() {
    const auto wanted_samples = static_cast<uint32_t>(world->built.scene->samples_per_pixel);
    set_phase(PreviewPhase::Rendering);
    while (film_samples < wanted_samples) {
      const uint32_t next = std::min(wanted_samples, film_samples + std::clamp<uint32_t>(film_samples, 1, kMostAdded));
      const auto start = Clock::now();
      if (!film->extend(next)) return failed_or_wanted();
      const double taken = seconds_since(start);
      note_rate(pixels_at(1) * (next - film_samples), taken);
      film_seconds += taken, film_samples = next;
      const bool done = next == wanted_samples;
      if (done || seconds_since(last_picture) > kBetweenPictures) show(film->picture(), next, done, film_seconds);
    }
    film.reset();
    unfinished = false;
    return true;
  }

  void show(const Picture& picture, double samples, bool done, double seconds) {
    auto shown = std::make_shared<PreviewPicture>();
    shown->resolution = world->resolution;
    shown->width = picture.width(), shown->height = picture.height();
    double crop[4];
    world->built.scene->film().crop_window(crop);
    shown->window = crop_pixels(world->resolution, crop);
    shown->samples = samples, shown->done = done;
    shown->halves = halves_of(picture.rgb);
    const bool first = last_picture == Clock::time_point{};
    last_picture = Clock::now();
    publish([&](PreviewState& s) {
      shown->number = ++pictures_made, shown->reading = s.reading;
      pictures.push_back(shown);
      if (pictures.size() > kPicturesKept) pictures.pop_front();
      s.picture = shown;
      s.samples = samples, s.samples_wanted = world->built.scene->samples_per_pixel;
      s.render_seconds = seconds;
      if (first) s.first_seconds = seconds_since(changed_at);
    });
  }

  /// When the picture is done, and nothing else is to be done.
  void finish() {
    set_phase(PreviewPhase::Done);
    if (request.measure) measure_costs();
  }

  void measure_costs() {
    // A build for each effect must not take long, nor the memory of a large scene.
    constexpr double kLongBuild = 0.5;
    if (state.build_seconds > kLongBuild) return;
    const EffectSet measured = world->built.scene->plan.needed;
    EffectCosts study(world->built, [this] { return !wanted(~0u); });
    for_effects(measured, [&](Effect e) {
      if (wanted(~0u) || costs.count(e) > 0) return;
      PlanOptions plan{.off = world->built.scene->plan.off_by_hand};
      plan.off.add(e);
      PlannedWorld planned = plan_world(world->description(), world->sources(), plan);
      if (planned.said.has_errors()) return;
      const MemoryPlan memory = memory_of(planned, 0);
      if (memory.total() > static_cast<double>(memory_limit())) return;
      const BuiltWorld without = rebuild(std::move(planned), static_cast<size_t>(memory.texture_cap()));
      if (!without.scene) return;
      const std::optional<double> share = study.share_without(without, request.threads);
      if (!share) return;
      costs[e] = *share;
      publish([&](PreviewState& s) { s.effects = effects_of(world->built.scene->plan); });
    });
  }

  const PreviewRequest request;
  FileWatch files;

  mutable std::mutex mutex;  ///< Of what follows.
  mutable std::condition_variable wishes_changed, state_changed;
  std::atomic<uint32_t> wishes{0};
  Clock::time_point wished_at;
  EffectSet off;
  std::optional<CameraPose> moved;
  PreviewState state;
  std::deque<std::shared_ptr<const PreviewPicture>> pictures;
  bool waits_ended = false;
  bool worked = false;           ///< The worker has ended.
  std::shared_ptr<World> world;  ///< Changed by the worker alone.

  // The worker's own.
  KeptParts kept;
  std::shared_ptr<ParsedFile> file;  ///< As last read, be it with errors.
  std::vector<std::string> watched;  ///< Files.
  std::map<Effect, double> costs;
  std::unique_ptr<FilmRender> film;  ///< Of the passes that have begun, of the world.
  uint32_t film_samples = 0;         ///< That all its pixels have.
  double film_seconds = 0;
  bool unfinished = false;  ///< The world's picture.
  double rate = 0;          ///< Samples a second.
  /// Bytes of the process before there was a world, and what the world was thought to take at most.
  double memory_before = 0, memory_taken = 0;
  Clock::time_point changed_at, last_picture;
  uint64_t pictures_made = 0;

  std::thread worker, watcher;
};

Preview::Preview(PreviewRequest request) : impl_(std::make_unique<Impl>(std::move(request))) {}
Preview::~Preview() { end_waits(); }

const std::string& Preview::path() const { return impl_->request.path; }

PreviewState Preview::state() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->state;
}

void Preview::wait_beyond(uint64_t version, int milliseconds) const {
  std::unique_lock lock(impl_->mutex);
  impl_->state_changed.wait_for(lock, std::chrono::milliseconds(milliseconds),
                                [&] { return impl_->waits_ended || impl_->state.version != version; });
}

void Preview::end_waits() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->waits_ended = true;
  }
  impl_->state_changed.notify_all();
}

bool Preview::end(int milliseconds) {
  end_waits();
  impl_->wish(kStop);
  std::unique_lock lock(impl_->mutex);
  return impl_->state_changed.wait_for(lock, std::chrono::milliseconds(milliseconds), [&] { return impl_->worked; });
}

std::shared_ptr<const PreviewPicture> Preview::picture(uint64_t number) const {
  const std::lock_guard lock(impl_->mutex);
  for (const auto& picture : impl_->pictures) {
    if (picture->number == number) return picture;
  }
  return nullptr;
}

void Preview::set_effects_off(EffectSet off) {
  {
    const std::lock_guard lock(impl_->mutex);
    if (impl_->off == off) return;
    impl_->off = off;
  }
  impl_->wish(kBuild);
}

void Preview::move_camera(const std::optional<CameraPose>& pose) {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->moved = pose;
  }
  impl_->wish(kCamera);
}

std::string Preview::write_camera() {
  std::shared_ptr<World> world;
  Mat4d m;
  {
    const std::lock_guard lock(impl_->mutex);
    world = impl_->world;
    if (!world) return "there is no scene yet";
    if (!impl_->moved) return "the camera is where the file has it";
    if (impl_->state.stale) return "the file has errors";
    m = impl_->camera_now();
  }
  return write_edit(world->sources(), camera_edit(world->sources(), world->description(), m, world->up));
}

PreviewSpot Preview::at(Vec2d film) const {
  std::shared_ptr<const World> world;
  {
    const std::lock_guard lock(impl_->mutex);
    world = impl_->world;
  }
  PreviewSpot spot;
  if (!world) return spot;
  spot.known = true;
  const Scene& scene = *world->built.scene;
  LookedAt seen;
  {
    // A camera that is put somewhere else is there in no time.
    const std::unique_lock lock(world->changing, std::chrono::milliseconds(20));
    spot.busy = !lock.owns_lock();
    if (spot.busy) return spot;
    const Vec2i now = scene.camera().film.resolution, whole = world->resolution;
    seen = look_at_film(scene, {film.x * now.x / whole.x, film.y * now.y / whole.y});
  }
  if (seen.shape < 0) return spot;
  const SceneShape& shape = scene.shapes[static_cast<size_t>(seen.shape)];
  const SceneDescription& description = world->description();
  spot.hit = true;
  spot.depth = seen.depth, spot.distance = seen.distance, spot.point = seen.point;
  spot.shape_at = place_of(world->sources(), shape.where);
  const auto same = [&](const Entity& e) {
    return e.where.file == shape.where.file && e.where.offset == shape.where.offset;
  };
  const auto stated = std::find_if(description.shapes.begin(), description.shapes.end(), same);
  if (stated == description.shapes.end()) return spot;
  spot.shape = stated->plugin;
  if (stated->object >= 0) spot.object = description.objects[static_cast<size_t>(stated->object)].name;
  const MaterialDescription& material = description.materials[static_cast<size_t>(stated->material)];
  spot.material = material.name, spot.material_kind = material.plugin;
  spot.material_at = place_of(world->sources(), material.where);
  return spot;
}

}  // namespace whit
