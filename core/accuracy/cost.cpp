// The order of a study: build, go from level to level, compare what can be turned, and say what came of it.

#include "core/accuracy/cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/accuracy/cost_answers.h"
#include "core/accuracy/cost_compare.h"
#include "core/accuracy/cost_pictures.h"
#include "core/accuracy/cost_words.h"
#include "core/accuracy/cost_worst.h"
#include "core/accuracy/estimate.h"
#include "core/accuracy/measures.h"
#include "core/compare/flip.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

/// Of the time, what levels and reference may take; the rest is for knobs and effects.
constexpr double kLevelsShare = 0.55, kLevelsShareQuick = 0.92;
/// Share of the time that is kept for reporting, and so many levels are thought to be judged before.
constexpr double kReserve = 0.03;
constexpr int kFewLevels = 3;
/// Sides of the crops that are shown side by side.
constexpr int kCrop = 96;

class Study {
 public:
  Study(ParsedFile& file, size_t world, const CostRequest& request)
      : file_(file), number_(world), request_(request), clock_(request) {}

  CostStudy run() {
    world_ = open_world(file_, number_, {}, request_, 0, clock_);
    out_.said = world_.said;
    if (out_.said.has_errors() || !world_.built.scene) return std::move(out_);
    describe();
    if (world_.usable) measure();
    else say_too_slow();
    if (clock_.interrupted()) say_interrupted();
    return std::move(out_);
  }

 private:
  CostReport& report() { return out_.report; }
  template <class Text>
  void not_known(Text&& what) {
    report().not_known.emplace_back(std::forward<Text>(what));
  }

  void describe() {
    const Scene& scene = world_.scene();
    CostReport& r = report();
    r.scene = request_.scene_path, r.machine = machine_words(request_.threads);
    r.integrator = integrator_in_force(*world_.description).name;
    r.sampler = sampler_in_force(*world_.description).name;
    r.resolution = scene.camera().film.resolution;
    r.own_samples = world_.own_samples;
    fixed_ = request_.before + world_.fixed;
    r.fixed_seconds = fixed_.cpu, r.fixed_wall = fixed_.wall;
    r.per_sample_seconds = world_.per_sample.cpu, r.per_sample_wall = world_.per_sample.wall;
    if (world_.invalid_samples > 0)
      not_known(
          fmt::format("{} of one sample for each pixel are no valid radiance (NaN, infinite or of negative "
                      "luminance) and are left out of all pictures here: what they should be is not known.",
                      world_.invalid_samples));
    if (file_.worlds.size() > 1)
      not_known(fmt::format("The file has {} worlds; this is the first.", file_.worlds.size()));
  }

  void measure() {
    const double judging = seconds_of_judging();
    clock_.keep(kReserve * request_.seconds + (kFewLevels + 1) * judging);
    const double until = (request_.quick ? kLevelsShareQuick : kLevelsShare) * request_.seconds;
    levels_ = study_levels(world_, request_, clock_, until);
    if (levels_.levels.empty()) return say_nothing_fits();
    if (!is_measurable()) return;
    judge_levels();
    clock_.keep(kReserve * request_.seconds + judging);
    if (!request_.quick) compare();
    const bool nets = report().sampler != "random";
    const CostAnswers answers = answer(report(), fits_, nets, request_);
    report().answers = answers.answers;
    for (const std::string& what : answers.not_known) not_known(what);
    if (levels_.cut) not_known(fmt::format("There was no time to end the level of {} samples.", *levels_.cut));
    mark_pareto(report().settings);
  }

  /// What judging the pictures of a setting takes, most of which is FLIP, by doing it with a black one and a white one (of
  /// equal ones it takes less). Writing them down takes as long.
  double seconds_of_judging() const {
    const Stopwatch watch;
    const Vec2i size = out_.report.resolution;
    std::vector<float> black(3 * static_cast<size_t>(size.x) * static_cast<size_t>(size.y));
    world_.output.display->apply(black.data(), black.size() / 3);
    const std::vector<float> white(black.size(), 1.0f);
    flip(black, white, size.x, size.y);
    return 1.5 * watch.elapsed().wall;
  }

  void say_too_slow() {
    report().complete = false;
    if (clock_.interrupted()) return;
    not_known("Not even one sample per pixel was done in time: with more --time there will be figures.");
  }

  void say_interrupted() {
    report().complete = false;
    not_known(fmt::format("The study was interrupted after {:.1f} of {:.1f} seconds: this is what it had.",
                          clock_.spent(), request_.seconds));
  }

  void say_nothing_fits() {
    report().complete = false;
    if (clock_.interrupted()) return;
    not_known(
        fmt::format("The time is too short for {} pictures of one sample and their reference: --time {:.0f}s "
                    "would do.",
                    levels_.replicates, std::ceil(levels_.needs / 0.55)));
  }

  /// Whether the error relative to the mean radiance is a number.
  bool is_measurable() {
    CostReport& r = report();
    r.mean_radiance = mean_radiance(levels_.reference.rgb);
    r.replicates = levels_.replicates;
    r.reference_samples = levels_.reference_samples, r.reference_seconds = levels_.reference_seconds;
    if (levels_.reference.rgb.empty()) not_known("The picture has no pixels: its crop leaves none.");
    else if (r.mean_radiance == 0)
      not_known(
          "The picture is black, and nRMSE, which is relative to the mean radiance, "
          "is not defined.");
    else if (!std::isfinite(r.mean_radiance) || !std::isfinite(levels_.noise.mse))
      not_known("Some pixels are too bright for numbers, and no error can be told.");
    else return true;
    return false;
  }

  void judge_levels() {
    CostReport& r = report();
    clock_.doing("comparing with the reference");
    r.reference_noise = std::sqrt(levels_.noise.mse) / r.mean_radiance;
    judge_.emplace(levels_, *world_.output.display);
    const CostLevel& last = levels_.levels.back();
    const std::vector<double> errors = squared_errors(last, levels_.reference);
    crop_ = heaviest_place(levels_.reference, errors, kCrop);
    // No samples take what is fixed, which was measured too.
    std::vector<double> samples{0}, cpu{fixed_.cpu}, wall{fixed_.wall};
    for (const CostLevel& level : levels_.levels) {
      add_level(level);
      for (const Elapsed& one : level.spent) {
        samples.push_back(level.samples);
        cpu.push_back(fixed_.cpu + one.cpu), wall.push_back(fixed_.wall + one.wall);
      }
    }
    fit(samples, cpu, wall);
    const WorstThings worst = find_worst(world_, errors, levels_.reference, *file_.sources);
    r.worst = worst.things, r.half_error_pixels = worst.half;
    show(last);
  }

  void fit(const std::vector<double>& samples, const std::vector<double>& cpu, const std::vector<double>& wall) {
    CostReport& r = report();
    std::vector<ErrorLevel> measured;
    for (const CostSetting& s : r.settings) measured.push_back({s.samples, s.nrmse, s.upper95});
    fits_ = {fit_order(measured), fit_affine(samples, cpu), fit_affine(samples, wall)};
    r.order = fits_.convergence.order;
    r.fixed_seconds = fits_.cpu.fixed, r.per_sample_seconds = fits_.cpu.per_sample;
    r.fixed_wall = fits_.wall.fixed, r.per_sample_wall = fits_.wall.per_sample;
  }

  void add_level(const CostLevel& level) {
    CostSetting& s = report().settings.emplace_back();
    s.knob = "samples", s.value = std::to_string(level.samples), s.samples = level.samples;
    s.command = cost_command(request_, level.samples);
    set_seconds(fixed_, level.spent, s);
    judge_->judge(level.pictures, s);
    s.crop = crop_of(level.pictures.front(), crop_);
  }

  void show(const CostLevel& level) {
    const Picture& picture = level.pictures.front();
    report().picture = image_of(picture.width(), picture.height(), picture.rgb);
    CostImage& error = report().error;
    error = report().picture;
    for (size_t i = 0; i < error.rgb.size(); ++i) {
      const double off = std::abs(static_cast<double>(picture.rgb[i]) - static_cast<double>(levels_.reference.rgb[i]));
      error.rgb[i] = static_cast<float>(off / report().mean_radiance);
    }
  }

  void compare() {
    std::vector<CostAlternative> all = knobs_of(*world_.description, world_.scene(), request_.all_samplers);
    const std::vector<CostAlternative> effects = effects_of(world_.scene().plan);
    all.insert(all.end(), effects.begin(), effects.end());
    CostComparisons found = compare_all(world_, all, levels_, *judge_, crop_, file_, number_, request_, clock_);
    for (CostSetting& s : found.settings) report().settings.push_back(std::move(s));
    report().effects = std::move(found.effects);
    for (std::string& what : found.not_known) {
      report().complete = false;
      not_known(std::move(what));
    }
  }

  ParsedFile& file_;
  const size_t number_;
  const CostRequest& request_;
  CostClock clock_;
  CostStudy out_;
  CostWorld world_;
  Elapsed fixed_;
  CostLevels levels_;
  std::optional<CostJudge> judge_;
  Box2i crop_;
  CostFits fits_;
};

}  // namespace

CostStudy study_cost(ParsedFile& file, size_t world, const CostRequest& request) {
  return Study(file, world, request).run();
}

}  // namespace whit
