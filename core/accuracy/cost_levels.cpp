#include "core/accuracy/cost_levels.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "core/accuracy/measures.h"

namespace whit {
namespace {

/// With fewer, where no level fits otherwise.
constexpr int kFewReplicates = 4;
/// So many times the samples of a level are in its reference.
constexpr int kReferenceTimes = 16;
constexpr uint32_t kReferenceSeed = 1000;
/// A level is begun when this many times its expected time is left.
constexpr double kMargin = 1.1;
/// So many times the time that all processors would take is believed.
constexpr double kBusy = 1.5;

Picture mean_of(const Picture& a, const Picture& b) {
  Picture mean = a;
  for (size_t i = 0; i < mean.rgb.size(); ++i) mean.rgb[i] = 0.5f * (a.rgb[i] + b.rgb[i]);
  return mean;
}

class LevelStudy {
 public:
  LevelStudy(CostWorld& world, const CostRequest& request, CostClock& clock, double until)
      : world_(world), seed_(request.seed), clock_(clock), until_(until), extends_(world.scene().sampler().extends()) {
    out_.per_sample = world.per_sample;
    // One look at a machine that others use as well may take long by chance: what the processor did for it says more.
    const int threads = request.threads > 0 ? request.threads : tbb::this_task_arena::max_concurrency();
    out_.per_sample.wall = std::min(out_.per_sample.wall, kBusy * out_.per_sample.cpu / threads);
    out_.replicates = replicates_of(world.scene().camera().film.resolution);
  }

  CostLevels run() {
    int samples = first_level();
    // Where the first level is cut, it takes more than was thought.
    out_.needs = std::max(clock_.spent() + kMargin * cost_of(1, out_.replicates), samples == 0 ? 0 : 2 * until_);
    if (samples == 0) return std::move(out_);
    films_.emplace(world_, seed_, out_.replicates);
    halves_.emplace(world_, seed_ + kReferenceSeed, 2);
    while (fits(samples) && add_level(samples)) samples *= 4;
    if (!out_.cut && !out_.levels.empty() && fits(samples / 2)) add_level(samples / 2);
    return std::move(out_);
  }

 private:
  /// Wall seconds of one more level, all replicates and the reference's part of it.
  double cost_of(int samples, int replicates) const {
    const int before = extends_ && !out_.levels.empty() ? out_.levels.back().samples : 0;
    const double each = replicates + kReferenceTimes;
    return each * (samples - before) * out_.per_sample.wall;
  }
  bool fits(int samples) const {
    return kMargin * cost_of(samples, out_.replicates) < std::min(until_ - clock_.spent(), clock_.left());
  }

  /// 4; fewer where that is too much or would be the only level; 0 where nothing fits.
  int first_level() {
    if (fits(16)) return 4;
    if (fits(1)) return 1;
    out_.replicates = std::min(out_.replicates, kFewReplicates);
    return fits(1) ? 1 : 0;
  }

  bool add_level(int samples) {
    clock_.doing(fmt::format("{} samples", samples));
    CostLevel level;
    const Stopwatch watch;
    for (int r = 0; r < films_->size(); ++r) {
      if (!films_->grow(r, samples)) return cut(samples);
      level.pictures.push_back(films_->picture(r));
      level.spent.push_back(films_->spent(r));
    }
    level.samples = world_.scene().samples_per_pixel;
    note_rate(watch.elapsed(), level);
    clock_.doing(fmt::format("reference of {} samples", kReferenceTimes * level.samples));
    if (!grow_reference(level.samples)) return cut(samples);
    out_.levels.push_back(std::move(level));
    return true;
  }

  void note_rate(const Elapsed& spent, const CostLevel& level) {
    const int before = extends_ && !out_.levels.empty() ? out_.levels.back().samples : 0;
    const double passes = static_cast<double>(films_->size()) * (level.samples - before);
    if (passes > 0) out_.per_sample = {spent.wall / passes, spent.cpu / passes};
  }

  bool grow_reference(int samples) {
    Picture pictures[2];
    for (int half = 0; half < 2; ++half) {
      if (!halves_->grow(half, kReferenceTimes / 2 * samples)) return false;
      pictures[half] = halves_->picture(half);
    }
    out_.reference = mean_of(pictures[0], pictures[1]);
    out_.noise = halves_noise(pictures[0].rgb, pictures[1].rgb, out_.reference.width());
    out_.reference_samples = 2 * world_.scene().samples_per_pixel;
    out_.reference_seconds = halves_->spent(0).wall + halves_->spent(1).wall;
    return true;
  }

  bool cut(int samples) {
    out_.cut = samples;
    return false;
  }

  CostWorld& world_;
  const uint32_t seed_;
  CostClock& clock_;
  const double until_;
  const bool extends_;
  CostLevels out_;
  std::optional<SeededFilms> films_, halves_;
};

}  // namespace

CostLevels study_levels(CostWorld& world, const CostRequest& request, CostClock& clock, double until) {
  return LevelStudy(world, request, clock, until).run();
}

}  // namespace whit
