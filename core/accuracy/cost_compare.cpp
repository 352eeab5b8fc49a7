#include "core/accuracy/cost_compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/accuracy/cost_pairs.h"
#include "core/accuracy/cost_pictures.h"
#include "core/accuracy/cost_words.h"
#include "core/accuracy/estimate.h"
#include "core/accuracy/measures.h"

namespace whit {
namespace {

/// Fewer pairs give no interval worth the name.
constexpr int kFewestPairs = 4;
/// Longest side of a thumbnail.
constexpr int kThumbnail = 160;

std::vector<double> cpu_of(const std::vector<Elapsed>& spent) {
  std::vector<double> out(spent.size());
  std::transform(spent.begin(), spent.end(), out.begin(), [](const Elapsed& one) { return one.cpu; });
  return out;
}
std::vector<double> wall_of(const std::vector<Elapsed>& spent) {
  std::vector<double> out(spent.size());
  std::transform(spent.begin(), spent.end(), out.begin(), [](const Elapsed& one) { return one.wall; });
  return out;
}
double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (double v : values) sum += v;
  return sum / static_cast<double>(std::max<size_t>(values.size(), 1));
}

/// How the noise of the variant compares with the scene's: the ratio of root mean square errors, pair by pair.
std::optional<Estimate> noise_ratio(const CostPairs& pairs, const CostLevels& levels) {
  std::vector<double> logs;
  for (size_t r = 0; r < pairs.variant.size(); ++r) {
    const double a = mean_square_error(pairs.base[r].rgb, levels.reference.rgb) - levels.noise.mse;
    const double b = mean_square_error(pairs.variant[r].rgb, levels.reference.rgb) - levels.noise.mse;
    if (!(a > 0) || !(b > 0)) return {};  // Nothing but the reference's own noise.
    logs.push_back(0.5 * std::log(b / a));
  }
  const Estimate log = paired_difference(logs)->difference;
  return Estimate{std::exp(log.value), std::exp(log.low), std::exp(log.high)};
}

class Comparing {
 public:
  Comparing(CostWorld& base, const CostLevels& levels, const CostJudge& judge, const Box2i& crop, ParsedFile& file,
            size_t world, const CostRequest& request, CostClock& clock)
      : base_(base),
        levels_(levels),
        judge_(judge),
        crop_(crop),
        file_(file),
        world_(world),
        request_(request),
        clock_(clock) {}

  CostComparisons run(const std::vector<CostAlternative>& alternatives) {
    std::vector<std::string> skipped;
    choose_effort(alternatives.size() + 1);
    if (pairs_ > 0) measure_bias_of_place();
    for (size_t i = 0; i < alternatives.size(); ++i) {
      const CostVariant& variant = alternatives[i].variant;
      choose_effort(alternatives.size() - i);
      if (pairs_ == 0 || !compare(alternatives[i]))
        skipped.push_back(fmt::format("{} {}", variant.knob, variant.value));
    }
    if (!skipped.empty()) {
      out_.not_known.push_back(
          fmt::format("Not measured for lack of time: {}. More --time measures these too.", fmt::join(skipped, ", ")));
    }
    return std::move(out_);
  }

 private:
  /// Seconds of one comparison, with what is around the samples.
  double seconds_of(int samples, int pairs) const {
    const double looks = 2 * levels_.per_sample.wall;
    return base_.fixed.wall + overhead_ + looks + 2.1 * pairs * samples * levels_.per_sample.wall;
  }

  /// The most samples, of those of a level, at which so many comparisons fit into the time; with fewer pairs where not
  /// even the least does; and with none where not even one comparison does.
  void choose_effort(size_t comparisons) {
    const double each = clock_.left() / static_cast<double>(comparisons);
    samples_ = levels_.levels.front().samples, pairs_ = levels_.replicates;
    for (const CostLevel& level : levels_.levels) {
      if (seconds_of(level.samples, pairs_) < each) samples_ = level.samples;
    }
    if (seconds_of(samples_, pairs_) < each) return;
    pairs_ = std::min(pairs_, kFewestPairs);
    if (seconds_of(samples_, pairs_) > clock_.left()) pairs_ = 0;
  }

  /// The scene beside itself, built once more: two that do the same take times that differ a little by where they lie in
  /// memory. What is no further apart is not resolved.
  void measure_bias_of_place() {
    clock_.doing("the scene beside itself");
    CostWorld other = open_world(file_, world_, {}, request_, pairs_, clock_);
    if (!other.usable) return;
    const CostPairs pairs = render_pairs(base_, other, request_, clock_, samples_, pairs_);
    if (pairs.size() < kFewestPairs) return;
    const Estimate more = taken(cpu_of(pairs.variant_spent), cpu_of(pairs.base_spent)).difference;
    bias_of_place_ = std::abs(more.value) / mean_of(cpu_of(pairs.base_spent));
  }

  /// False when there was no time for it.
  bool compare(const CostAlternative& alternative) {
    const Stopwatch watch;
    clock_.doing(alternative.variant.knob + " " + alternative.variant.value);
    CostWorld other = open_world(file_, world_, alternative.variant, request_, pairs_, clock_);
    if (other.said.has_errors()) {
      out_.not_known.push_back(fmt::format("{} {} cannot be rendered: {}.", alternative.variant.knob,
                                           alternative.variant.value, other.said.all().front().message));
      return true;
    }
    if (!other.usable) return false;
    const CostPairs pairs = render_pairs(base_, other, request_, clock_, samples_, pairs_);
    if (pairs.size() < std::min(pairs_, kFewestPairs)) return false;
    const Stopwatch judging;
    const PairDifference difference = difference_of(pairs, levels_.reference);
    if (alternative.variant.off.empty()) add_setting(alternative, pairs, difference);
    else add_effect(alternative, pairs, difference);
    overhead_ = std::max(overhead_, judging.elapsed().wall);
    return true;
  }

  void add_setting(const CostAlternative& alternative, const CostPairs& pairs, const PairDifference& difference) {
    CostSetting& s = out_.settings.emplace_back();
    s.knob = alternative.variant.knob, s.value = alternative.variant.value, s.samples = pairs.samples;
    s.command = cost_command(request_, samples_, alternative.variant.flags);
    // No knob has a part in building that is larger than what chance does to it.
    set_seconds(fixed_, pairs.variant_spent, s);
    judge_.judge(pairs.variant, s, alternative.same_limit ? 0 : difference.bias.value);
    if (!alternative.same_limit || has_other_limit(s, difference)) s.bias = difference.bias;
    s.crop = crop_of(pairs.variant.front(), crop_);
    CostChange& change = s.change.emplace();
    change.from = alternative.from;
    const PairedDifference taken_more = taken(cpu_of(pairs.variant_spent), cpu_of(pairs.base_spent));
    change.seconds = taken_more.difference, change.resolved = taken_more.resolved;
    change.share = change.seconds.value / mean_of(cpu_of(pairs.base_spent));
    if (!s.bias) change.noise = noise_ratio(pairs, levels_);
    change.mean_change = difference.mean_change, change.pixels_changed = difference.pixels_changed;
  }

  /// Samplers have one limit, but for those that put all samples at the same places: then most of the error is bias.
  static bool has_other_limit(const CostSetting& s, const PairDifference& difference) {
    return difference.bias.low > 0 && 2 * difference.bias.low * difference.bias.low > s.nrmse.value * s.nrmse.value;
  }

  void add_effect(const CostAlternative& alternative, const CostPairs& pairs, const PairDifference& difference) {
    CostEffect& e = out_.effects.emplace_back();
    e.name = alternative.variant.value;
    e.command = cost_command(request_, samples_, alternative.variant.flags);
    e.samples = pairs.samples, e.replicates = pairs.size();
    const PairedDifference takes = taken(cpu_of(pairs.base_spent), cpu_of(pairs.variant_spent));
    e.seconds = takes.difference, e.resolved = takes.resolved;
    e.share = e.seconds.value / mean_of(cpu_of(pairs.base_spent));
    e.wall_seconds = taken(wall_of(pairs.base_spent), wall_of(pairs.variant_spent)).difference;
    e.mean_change = -difference.mean_change;
    e.pixels_changed = difference.pixels_changed;
    e.where = image_of(levels_.reference.width(), levels_.reference.height(), difference.magnitude, kThumbnail);
  }

  /// What a takes more than b, pair by pair.
  PairedDifference taken(std::vector<double> a, const std::vector<double>& b) const {
    const double unknown = bias_of_place_ * mean_of(b);
    for (size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
    PairedDifference out = *paired_difference(a);
    out.difference.low -= unknown, out.difference.high += unknown;
    out.resolved = out.difference.low > 0 || out.difference.high < 0;
    return out;
  }

  CostWorld& base_;
  const CostLevels& levels_;
  const CostJudge& judge_;
  const Box2i crop_;
  ParsedFile& file_;
  const size_t world_;
  const CostRequest& request_;
  CostClock& clock_;
  CostComparisons out_;
  int samples_ = 1, pairs_ = 0;
  const Elapsed fixed_ = base_.fixed + request_.before;
  double bias_of_place_ = 0;  ///< Share of the time.
  double overhead_ = 0;       ///< Seconds of judging pictures, as far as known.
};

}  // namespace

CostComparisons compare_all(CostWorld& base, const std::vector<CostAlternative>& alternatives, const CostLevels& levels,
                            const CostJudge& judge, const Box2i& crop, ParsedFile& file, size_t world,
                            const CostRequest& request, CostClock& clock) {
  return Comparing(base, levels, judge, crop, file, world, request, clock).run(alternatives);
}

}  // namespace whit
