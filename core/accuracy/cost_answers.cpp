#include "core/accuracy/cost_answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/accuracy/cost_words.h"
#include "core/accuracy/report_words.h"

namespace whit {
namespace {

/// Errors that people ask for, from the coarsest to the finest.
constexpr double kTargets[] = {0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 0.0005, 0.0002, 0.0001};
constexpr double kUsual = 0.01;
/// Orders of convergence below this are not believed.
constexpr double kSlowest = 0.2;
/// Below this share of the pixels, a change is called small.
constexpr double kFewPixels = 0.02;
/// Below this share of the time, savings are not worth a sentence.
constexpr double kWorthwhile = 0.03;

class Answering {
 public:
  Answering(const CostReport& report, const CostFits& fits, bool nets, const CostRequest& request)
      : report_(report), fits_(fits), nets_(nets), request_(request) {
    for (const CostSetting& s : report.settings) {
      if (s.knob == "samples") levels_.push_back(&s);
    }
  }

  CostAnswers run() {
    if (levels_.back()->nrmse.high == 0 && levels_.front()->nrmse.high == 0) {
      say_without_error();
    } else {
      say_own_samples();
      say_targets();
      say_half();
    }
    for (const CostSetting& s : report_.settings) {
      if (s.change && s.change->noise) compare_noise(s);
      else if (s.change) compare_pictures(s);
    }
    for (const CostEffect& e : report_.effects) say_effect(e);
    say_what_figures_leave_out();
    return std::move(out_);
  }

 private:
  const CostSetting* level(int samples) const {
    for (const CostSetting* l : levels_) {
      if (l->samples == samples) return l;
    }
    return nullptr;
  }

  /// Error and seconds of a number of samples: as measured, else by the fits.
  bool predict(int samples, CostAnswer& a, double& upper95, double& wall) const {
    if (const CostSetting* measured = level(samples)) {
      a.nrmse = measured->nrmse, upper95 = measured->upper95, a.cpu_seconds = measured->cpu_seconds;
      wall = measured->seconds.value;
    } else {
      const std::optional<ErrorEstimate> error = predict_error(fits_.convergence, samples);
      if (!error) return false;
      a.nrmse = error->nrmse, upper95 = error->upper95, a.cpu_seconds = fits_.cpu.predict(samples);
      wall = fits_.wall.predict(samples).value;
    }
    a.extrapolated = samples > levels_.back()->samples;
    a.command = cost_command(request_, samples);
    return true;
  }

  void say_without_error() {
    const CostSetting& first = *levels_.front();
    CostAnswer a;
    a.text =
        fmt::format("{} sample{} per pixel ha{} no error: all {} the same picture, and more are wasted. It takes {}.",
                    first.samples, first.samples == 1 ? "" : "s", first.samples == 1 ? "s" : "ve", report_.replicates,
                    seconds_interval(first.cpu_seconds));
    a.command = first.command, a.nrmse = first.nrmse, a.cpu_seconds = first.cpu_seconds;
    out_.answers.push_back(std::move(a));
    out_.not_known.emplace_back("There is no error that falls, so no order of convergence either.");
  }

  void say_own_samples() {
    CostAnswer a;
    double upper95 = 0, wall = 0;
    if (!predict(report_.own_samples, a, upper95, wall)) {
      const bool more = report_.own_samples > levels_.back()->samples;
      out_.not_known.push_back(fmt::format(
          "The scene's own {} samples are {} what was measured, {} to {}: nothing is said of their error{}.",
          report_.own_samples, more ? "more than four times" : "below", levels_.front()->samples,
          levels_.back()->samples, more ? " without more --time" : ""));
      return;
    }
    a.text = fmt::format(
        "As it stands, with {} samples, the scene has an error (nRMSE) of {} and takes {} of processor "
        "time, {} by the clock.",
        report_.own_samples, percent_interval(a.nrmse), seconds_interval(a.cpu_seconds), seconds_text(wall));
    out_.answers.push_back(std::move(a));
  }

  /// The usual error, the finest one within what was measured, and the finest one beyond.
  void say_targets() {
    std::optional<double> measured, beyond;
    for (double target : kTargets) {
      const auto samples = samples_for(fits_.convergence, target, nets_);
      if (!samples || target > levels_.front()->upper95) continue;
      (samples->extrapolated ? beyond : measured) = target;
    }
    std::vector<double> targets;
    for (const std::optional<double>& t : {std::optional(kUsual), measured, beyond}) {
      if (t && std::find(targets.begin(), targets.end(), *t) == targets.end()) targets.push_back(*t);
    }
    std::sort(targets.rbegin(), targets.rend());
    for (double target : targets) say_target(target);
  }

  void say_target(double target) {
    const auto found = samples_for(fits_.convergence, target, nets_);
    CostAnswer a;
    double upper95 = 0, wall = 0;
    if (!found || !predict(found->samples, a, upper95, wall)) {
      out_.not_known.push_back(
          fmt::format("{} error is beyond four times the {} samples that were measured: nothing is "
                      "said of it without more --time.",
                      percent_tick(target), levels_.back()->samples));
      return;
    }
    a.nrmse = found->error.nrmse;
    const bool from_the_first = found->samples == levels_.front()->samples;
    a.text = fmt::format(
        "{} error (nRMSE, 95 % sure) takes {}{} of processor time on this machine, {} by the clock: {} "
        "sample{} per pixel.",
        percent_tick(target), from_the_first ? "at most " : "", seconds_interval(a.cpu_seconds), seconds_text(wall),
        found->samples, found->samples == 1 ? "" : "s");
    out_.answers.push_back(std::move(a));
  }

  /// What half the error of some samples takes, by the order of convergence.
  struct Half {
    int samples;   ///< Of half the error, doubled until enough.
    double times;  ///< The seconds.
  };
  Half half_of(const CostSetting& from, double order) const {
    const double wanted = from.samples * std::pow(2.0, 1 / std::max(order, kSlowest));
    Half out{from.samples, fits_.cpu.predict(wanted).value / std::max(fits_.cpu.predict(from.samples).value, 1e-9)};
    while (out.samples < 0.9 * wanted) out.samples *= 2;
    return out;
  }

  /// From the last level whose error was seen to become half; else from the first.
  void say_half() {
    if (levels_.size() < 2 || !(report_.order.value > 0)) return;
    const CostSetting* from = levels_.front();
    for (const CostSetting* l : levels_) {
      if (half_of(*l, report_.order.value).samples <= levels_.back()->samples) from = l;
    }
    const auto times = [&](double order) { return half_of(*from, order).times; };
    CostAnswer a;
    double upper95 = 0, wall = 0;
    if (!predict(half_of(*from, report_.order.value).samples, a, upper95, wall)) return;
    a.text = fmt::format(
        "Half the error costs x{:.2g} [{:.2g}, {:.2g}] the time, from the {} of {} samples on: it falls as "
        "samples^-{:.2f} "
        "[{:.2f}, {:.2f}].",
        times(report_.order.value), times(report_.order.high), times(report_.order.low),
        percent_text(from->nrmse.value), from->samples, report_.order.value, report_.order.low, report_.order.high);
    out_.answers.push_back(std::move(a));
  }

  void add(const CostSetting& s, std::string text) {
    out_.answers.push_back({std::move(text), s.command, s.nrmse, s.cpu_seconds, false});
  }

  /// "saves 12 % [10, 14] of the time" or "costs ..."; "" where it is not known.
  static std::string time_words(const CostChange& c) {
    if (!c.resolved || c.share == 0) return "";
    const double per_second = c.share / c.seconds.value;
    Estimate share{c.share, per_second * c.seconds.low, per_second * c.seconds.high};
    const bool saves = share.value < 0;
    if (saves) share = {-share.value, -share.high, -share.low};
    return fmt::format("{} {} of the time", saves ? "saves" : "costs", percent_interval(share));
  }

  /// Settings with the same limit: what counts is time for the same error, by the noise and the order of convergence.
  void compare_noise(const CostSetting& s) {
    const CostChange& c = *s.change;
    const Estimate& noise = *c.noise;
    const bool better = noise.high<1, worse = noise.low> 1;
    const std::string time = time_words(c);
    if (!better && !worse && (time.empty() || std::abs(c.share) < kWorthwhile)) return;
    const std::string error =
        better || worse ? fmt::format("has x{:.3g} [{:.3g}, {:.3g}] the error", noise.value, noise.low, noise.high)
                        : "has no other error that shows";
    add(s, fmt::format("{} {} instead of {} {} with the same {} samples{}{}.", s.knob, s.value, c.from, error,
                       s.samples, time.empty() ? "" : " and ", time));
  }

  void compare_pictures(const CostSetting& s) {
    const CostChange& c = *s.change;
    const std::string time = time_words(c);
    const bool same = c.pixels_changed == 0 && s.bias && s.bias->high < 1e-3;
    if (time.empty() && same) return;
    if (same && std::abs(c.share) < kWorthwhile) return;
    const std::string change =
        same ? "shows the same picture"
             : fmt::format("changes {} of the pixels by more than 1 % (bias {})", percent_text(c.pixels_changed),
                           s.bias ? percent_interval(*s.bias) : "not known");
    add(s, fmt::format("{} {} instead of {} {}{}{}, measured at {} samples.", s.knob, s.value, c.from,
                       time.empty() ? "has no effect on the time that shows" : time, " and ", change, s.samples));
  }

  /// An effect that costs time and hardly shows.
  void say_effect(const CostEffect& e) {
    if (!e.resolved || e.share < kWorthwhile || e.pixels_changed > kFewPixels) return;
    const double per_second = e.share / e.seconds.value;
    const Estimate share{e.share, per_second * e.seconds.low, per_second * e.seconds.high};
    CostAnswer a;
    a.text = fmt::format("{} takes {} of the time and changes {} of the pixels by more than 1 %.", e.name,
                         percent_interval(share), percent_text(e.pixels_changed));
    a.command = e.command;
    if (const CostSetting* base = level(e.samples)) {
      a.nrmse = base->nrmse;
      for (auto end : {&Estimate::value, &Estimate::low, &Estimate::high})
        a.cpu_seconds.*end = std::max(0.0, base->cpu_seconds.*end - e.seconds.value);
    }
    out_.answers.push_back(std::move(a));
  }

  void say_what_figures_leave_out() {
    if (levels_.size() < 2)
      out_.not_known.emplace_back(
          "One level of samples shows no order of convergence: with more --time there are several.");
    if (report_.reference_noise > levels_.back()->nrmse.value / 3) {
      out_.not_known.push_back(
          fmt::format("The reference's own noise, {}, is not small beside the error of {} samples.",
                      percent_text(report_.reference_noise), levels_.back()->samples));
    }
  }

  const CostReport& report_;
  const CostFits& fits_;
  const bool nets_;
  const CostRequest& request_;
  std::vector<const CostSetting*> levels_;
  CostAnswers out_;
};

}  // namespace

CostAnswers answer(const CostReport& report, const CostFits& fits, bool nets, const CostRequest& request) {
  return Answering(report, fits, nets, request).run();
}

}  // namespace whit
