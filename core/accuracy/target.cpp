#include "core/accuracy/target.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/accuracy/allotment.h"
#include "core/accuracy/measures.h"
#include "core/base/stopwatch.h"
#include "core/render/film_render.h"

namespace whit {
namespace {

using Clock = std::chrono::steady_clock;

/// Samples that are taken before the first look, which says how many more belong to the first pass: a twelfth of what
/// the target would take everywhere, so that quiet places have no more than they need; 64 of them tell enough.
constexpr uint32_t kFirstLook = 4, kFirstPass = 64;
constexpr double kFirstShare = 1.0 / 12;
constexpr uint32_t kSet = 16;     ///< Samples that a sampler spreads together which cannot go on.
constexpr double kReserve = 1.3;  ///< Times as long as it took first may writing take in the end.
/// An estimate with all pixels this many times above the target needs no look at which of them can be trusted.
constexpr double kFarAbove = 1.5;

double seconds_until(Clock::time_point then) { return std::chrono::duration<double>(then - Clock::now()).count(); }

class TargetRender {
 public:
  TargetRender(const BuiltWorld& world, const RenderOptions& options, const TargetRequest& request)
      : request_(request),
        reach_(reach_of(*world.scene)),
        deadline_(request.deadline.value_or(Clock::time_point::max())),
        keeper_(options.keeper),
        film_(*world.scene, with_progress(options, world)),
        units_(film_.units()),
        noise_(units_),
        areas_(noise_.areas()),
        pixels_(std::accumulate(areas_.begin(), areas_.end(), 0.0)) {
    usable_ = !keeper_ || keeper_->begin(film_);
    if (usable_ && film_.restored()) recall();
  }

  TargetOutcome run() {
    // A film may be without pixels: by a narrow crop, or by the integrator's bounds.
    if (!usable_) return std::move(out_);
    out_.end = units_.empty() ? TargetEnd::Samples : first_pass();
    if (out_.end == TargetEnd::Met) out_.end = request_.error > 0 ? approach() : use_time();
    if (out_.end == TargetEnd::Failed) return std::move(out_);
    if (keeper_) keeper_->end(film_, out_.end == TargetEnd::Met || out_.end == TargetEnd::Samples);
    finish();
    return std::move(out_);
  }

 private:
  static int reach_of(const Scene& scene) {
    const FilterTable filter(scene.filter());
    return std::max(filter.x_reach(), filter.y_reach());
  }

  // ---- Passes ----

  RenderOptions with_progress(RenderOptions options, const BuiltWorld& world) {
    options.blocks = true, options.adaptive = request_.error > 0;
    options.progress = [this, &world](double share) {
      if (!world.keep_going && world.textures->failed()) return false;
      if (Clock::now() >= deadline_) return false;
      pass_share_ = share;
      return tell();
    };
    return options;
  }

  bool tell() { return !request_.progress || request_.progress(state()); }

  TargetState state() const {
    TargetState state{claim_, 0, samples() / pixels_};
    const double pass = pass_share_ * pass_samples_;
    if (request_.deadline) {
      const double all = std::chrono::duration<double>(deadline_ - start_).count();
      state.share = 1 - std::max(0.0, seconds_until(deadline_)) / std::max(all, 1e-9);
    }
    if (request_.error > 0) state.share = std::max(state.share, (samples() + pass) / std::max(plan_.expected, 1.0));
    state.share = std::min(state.share, 1.0);
    return state;
  }

  double samples() const {
    double sum = 0;
    for (size_t u = 0; u < units_.size(); ++u) sum += areas_[u] * units_[u].samples;
    return sum;
  }

  /// Samples that a pass adds, over all pixels.
  double added(const std::vector<uint32_t>& want) const {
    double sum = 0;
    for (size_t u = 0; u < want.size(); ++u) sum += areas_[u] * (want[u] - std::min(want[u], units_[u].samples));
    return sum;
  }

  /// Seconds that so many more samples take.
  double seconds_for(double more) const { return more * rate_; }

  // ---- What a film that is kept has in its note: what was known when its last pass began ----

  std::string known() const {
    std::string note;
    ByteWriter out([&](const void* bytes, size_t size) { note.append(static_cast<const char*>(bytes), size); });
    out.value(plan_);
    noise_.save(out);
    return note;
  }

  /// From the note. The pass that was under way then is the first to come.
  void recall() {
    if (film_.note().empty()) return;
    ByteReader in(film_.note());
    plan_ = in.value<Plan>();
    noise_.restore(in);
    units_ = film_.units();
    goes_on_ = true;
  }

  /// Extends the film; false when it was stopped. `want` by unit.
  bool pass(const std::vector<uint32_t>& want) {
    pass_samples_ = added(want), pass_share_ = 0;
    const auto start = Clock::now();
    if (!std::exchange(goes_on_, false)) film_.begin_pass(want, known());
    const bool complete = request_.render_pass ? pass_of_others() : film_.go_on();
    units_ = film_.units();
    // The dearest of the last passes: the next is not to be late.
    const double rate = std::chrono::duration<double>(Clock::now() - start).count() / std::max(pass_samples_, 1.0);
    rate_ = std::max(rate, 0.5 * (rate_ + rate));
    pass_samples_ = pass_share_ = 0;
    return complete;
  }

  bool pass_of_others() {
    const PassEnd end = request_.render_pass(film_, state(), [this](double share) {
      pass_share_ = share;
      return tell();
    });
    failed_ = end == PassEnd::Failed;
    return end == PassEnd::Over;
  }

  bool pass(uint32_t samples) { return pass(std::vector<uint32_t>(units_.size(), samples)); }

  /// Why a pass was stopped.
  TargetEnd stopped() const {
    if (failed_) return TargetEnd::Failed;
    return Clock::now() >= deadline_ ? TargetEnd::Time : TargetEnd::Stopped;
  }

  /// Met: done. Where there is a deadline the samples come in small passes, so that there is a picture early.
  TargetEnd first_pass() {
    uint32_t &n = plan_.first_samples, &first = plan_.first_pass;
    if (!goes_on_) first = std::min(kFirstPass, request_.max_samples), n = std::min(kFirstLook, first);
    else if (plan_.first_is_over) return TargetEnd::Met;
    if (plan_.expected == 0) plan_.expected = pixels_ * first;
    while (true) {
      const double more = pixels_ * (n - std::min(n, units_.front().samples));
      if (rate_ > 0 && seconds_for(more) > seconds_until(deadline_)) return use_time();
      if (!pass(n)) return stopped();
      write_early();
      if (n == kFirstLook && request_.error > 0) first = std::min(first, samples_of_first_pass());
      if (n == first) break;
      n = std::min(2 * n, first);  // doubled, so that blocks of samples stay nets
    }
    plan_.first_is_over = true;
    return TargetEnd::Met;
  }

  /// By a first look, which is no test of anything.
  uint32_t samples_of_first_pass() {
    observe();
    const ErrorClaim claim = claim_error(picture_, variance_, doubts_now(), request_.confidence);
    const double times = claim.value / request_.error;
    const double samples = kFirstShare * kFirstLook * times * times;
    if (!(samples < kFirstPass)) return kFirstPass;
    return std::max(kFirstLook, std::bit_floor(static_cast<uint32_t>(samples)));
  }

  Doubts doubts_now() const {
    const Box2i& window = picture_.window;
    std::vector<uint32_t> samples(variance_.size() / 3);
    for (const FilmRender::Unit& u : units_) {
      for (int y = std::max(u.pixels.min.y, window.min.y); y < std::min(u.pixels.max.y, window.max.y); ++y) {
        for (int x = std::max(u.pixels.min.x, window.min.x); x < std::min(u.pixels.max.x, window.max.x); ++x) {
          if (!u.holds(x, y)) continue;
          const Vec2i at = Vec2i(x, y) - window.min;
          samples[static_cast<size_t>(at.y) * static_cast<size_t>(picture_.width()) + static_cast<size_t>(at.x)] =
              u.samples;
        }
      }
    }
    return find_doubts(picture_, variance_, samples, reach_);
  }

  void write_early() {
    if (!request_.deadline || !request_.first_picture || std::exchange(written_, true)) return;
    const auto start = Clock::now();
    const RenderResult result = film_.result();
    const double resolving = std::chrono::duration<double>(Clock::now() - start).count();
    const double seconds = kReserve * (resolving + request_.first_picture(result)) + 0.05;
    deadline_ -= std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }

  /// Doubles all samples while there is time, and ends with what of the next doubling fits.
  TargetEnd use_time() {
    plan_.first_is_over = true;
    if (goes_on_ && !pass(units_.front().samples)) return stopped();
    while (true) {
      const uint32_t have = units_.front().samples;
      const double left = seconds_until(deadline_) / std::max(rate_ * pixels_, 1e-30);
      const double more = std::min({static_cast<double>(have), left, static_cast<double>(request_.max_samples - have)});
      if (have >= request_.max_samples) return TargetEnd::Samples;
      if (more < 0.05 * have || more < 1) return TargetEnd::Time;
      if (!pass(have + static_cast<uint32_t>(more))) return stopped();
    }
  }

  // ---- Looks ----

  /// What the film says now, if that is not known.
  void observe() {
    if (observed_at_ == samples()) return;
    picture_ = film_.picture(), variance_ = film_.variance(), observed_at_ = samples();
    if (request_.error > 0) noise_.look(film_, units_, variance_, picture_.window, reach_);
  }

  /// Looks, and adds samples where they are needed, until the target is met.
  TargetEnd approach() {
    if (goes_on_ && !pass(units_.front().samples)) return stopped();
    while (true) {
      if (look()) return TargetEnd::Met;
      if (!tell()) return TargetEnd::Stopped;
      const std::vector<Allotment> parts = noise_.allotments(units_);
      std::vector<uint32_t> want = next(parts);
      if (added(want) == 0) return TargetEnd::Samples;
      const bool last = seconds_for(added(want)) > seconds_until(deadline_);
      if (last) want = what_fits(parts, want);
      if (!pass(want)) return stopped();
      if (last) return look() ? TargetEnd::Met : TargetEnd::Time;
    }
  }

  /// Whether the error is below the target. Only estimates that are get a test, and each its own part of the confidence,
  /// so that all together are wrong as seldom as is asked for: the k-th a k (k + 1)-th of it.
  bool look() {
    observe();
    const double n = plan_.tests + 1, confidence = 1 - (1 - request_.confidence) / (n * (n + 1));
    if (is_far_above(confidence)) return false;
    doubts_ = doubts_now(), plan_.doubted_at = samples();
    claim_ = claim_error(picture_, variance_, doubts_, confidence);
    if (!(claim_.value <= request_.error) || !are_enough()) return false;
    ++plan_.tests;
    return claim_.high <= request_.error;
  }

  /// Four samples of each pixel may all miss what carries the light: a test takes 8 of all, or 16 somewhere.
  bool are_enough() const {
    const auto [least, most] = std::minmax_element(units_.begin(), units_.end(),
                                                   [](const auto& a, const auto& b) { return a.samples < b.samples; });
    return least->samples >= std::min(8u, request_.max_samples) || most->samples >= 16;
  }

  /// Doubts take longer to find than some passes take. What is noisiest may be doubted, so they are found now and then.
  bool is_far_above(double confidence) {
    if (samples() >= 2 * plan_.doubted_at) return false;
    doubts_ = {std::vector<uint8_t>(variance_.size() / 3), 0, {}, {}};
    claim_ = claim_error(picture_, variance_, doubts_, confidence);
    return claim_.value > kFarAbove * request_.error;
  }

  /// The numbers of samples to have after the next pass.
  std::vector<uint32_t> next(const std::vector<Allotment>& parts) {
    const double mean = mean_radiance(picture_.rgb), pixels = static_cast<double>(doubts_.pixels.size());
    const auto sum_at = [&](double error) { return 3 * pixels * error * error * mean * mean; };
    const double sure = claim_.high > 0 && std::isfinite(claim_.high) ? claim_.value / claim_.high : 0.9;
    const double aim = 0.97 * sure * request_.error;
    plan_.expected = 0;
    const std::vector<double> in_the_end = allot(parts, sum_at(aim), request_.max_samples);
    for (size_t u = 0; u < parts.size(); ++u) plan_.expected += parts[u].area * in_the_end[u];
    // One doubling ahead and no further: errors of nets fall faster than their first blocks say.
    const double sum = sum_at(std::max(aim, claim_.value * M_SQRT1_2));
    std::vector<uint32_t> want = next_samples(parts, sum, request_.max_samples, kFirstPass);
    if (added(want) > 0) return want;
    if (!are_enough()) return std::vector<uint32_t>(parts.size(), std::min(2 * kFirstLook, request_.max_samples));
    // The claim may be of fewer pixels than the sum: where that is reached already, an eighth of the picture goes on.
    return neediest_eighth(parts);
  }

  static std::vector<uint32_t> as_they_are(const std::vector<Allotment>& parts) {
    std::vector<uint32_t> samples;
    for (const Allotment& p : parts) samples.push_back(p.samples);
    return samples;
  }

  std::vector<uint32_t> neediest_eighth(const std::vector<Allotment>& parts) const {
    std::vector<uint32_t> want = as_they_are(parts);
    double area = 0;
    for (const size_t u : by_need(parts)) {
      if (area >= pixels_ / 8 || parts[u].variance == 0) break;
      if (2 * want[u] > request_.max_samples) continue;
      want[u] *= 2, area += parts[u].area;
    }
    return want;
  }

  /// As much of a pass as there is time for, what is needed most first.
  std::vector<uint32_t> what_fits(const std::vector<Allotment>& parts, const std::vector<uint32_t>& wanted) const {
    std::vector<uint32_t> want = as_they_are(parts);
    double left = seconds_until(deadline_) / std::max(rate_, 1e-30);
    for (const size_t u : by_need(parts)) {
      left -= areas_[u] * (wanted[u] - parts[u].samples);
      if (left < 0) break;
      want[u] = wanted[u];
    }
    return want;
  }

  void finish() {
    out_.rendered.result = film_.result();
    out_.rendered.result.complete = out_.end != TargetEnd::Stopped;
    out_.whole = std::all_of(units_.begin(), units_.end(), [](const auto& u) { return u.samples > 0; });
    if (out_.end != TargetEnd::Met) {
      observe();
      doubts_ = doubts_now();
      claim_ = claim_error(picture_, variance_, doubts_, request_.confidence);
    }
    out_.claim = claim_, out_.doubts = std::move(doubts_);
    for (AovPicture::Channel& channel : out_.rendered.result.aovs.channels) {
      if (channel.name.starts_with("variance.")) mark_doubts(channel.values);
    }
  }

  /// The variance of pixels that are doubted is not known.
  void mark_doubts(std::vector<float>& variance) const {
    for (size_t p = 0; p < variance.size(); ++p) {
      if (out_.doubts.pixels[p]) variance[p] = std::numeric_limits<float>::infinity();
    }
  }

  const TargetRequest& request_;
  const int reach_;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point deadline_;
  double pass_share_ = 0, pass_samples_ = 0;  ///< Of the pass that is running.
  ErrorClaim claim_{std::numeric_limits<double>::infinity(), 0, std::numeric_limits<double>::infinity(), 0};
  FilmKeeper* const keeper_;
  FilmRender film_;
  std::vector<FilmRender::Unit> units_;
  UnitNoise noise_;
  const std::span<const double> areas_;  ///< Pixels of each unit.
  const double pixels_;
  double rate_ = 0;  ///< Seconds per sample and pixel.
  bool written_ = false;
  double observed_at_ = -1;  ///< Samples over all pixels when the film was observed last,
  Picture picture_;          ///< and what it said.
  std::vector<float> variance_;
  Doubts doubts_;
  /// What the next pass depends on, beside the film and what is known of its noise.
  struct Plan {
    uint32_t first_samples = 0, first_pass = 0;  ///< Of the first pass: up to where it is, and where it ends.
    bool first_is_over = false;
    int tests = 0;
    double expected = 0;    ///< Samples that the target seems to take, over all pixels.
    double doubted_at = 0;  ///< Samples over all pixels when doubts were found last.
  };
  Plan plan_;
  bool failed_ = false;   ///< What others took cannot be added.
  bool usable_ = true;    ///< What was kept is of such a film.
  bool goes_on_ = false;  ///< The next pass is the rest of one that was under way in a film that was kept.
  TargetOutcome out_;
};

/// Of samplers that cannot go on sets of a few samples each will do.
Diagnostics let_extend(BuiltWorld& world, uint32_t seed) {
  return world.scene->sampler().extends() ? Diagnostics() : set_samples(world, kSet, seed);
}

}  // namespace

TargetOutcome render_to_target(BuiltWorld& world, RenderOptions options, const TargetRequest& request, uint32_t seed) {
  Diagnostics said = let_extend(world, seed);
  const Stopwatch watch;
  TargetOutcome out = TargetRender(world, options, request).run();
  out.rendered.elapsed = watch.elapsed();
  out.rendered.said = std::move(said);
  out.rendered.said.append(world.textures->errors());
  return out;
}

std::optional<RenderedWorld> render_share(BuiltWorld& world, RenderOptions options, std::string_view pass,
                                          PassShare share, uint32_t seed) {
  RenderedWorld out;
  out.said = let_extend(world, seed);
  const Stopwatch watch;
  options.blocks = options.adaptive = true;
  options.progress = [&world, report = std::move(options.progress)](double done) {
    return (!report || report(done)) && (world.keep_going || !world.textures->failed());
  };
  FilmRender film(*world.scene, options);
  ByteReader in(pass);
  if (!film.take_share(in, share.number - 1, share.of)) return {};
  const bool usable = !options.keeper || options.keeper->begin(film);
  const bool complete = usable && film.go_on();
  out.elapsed = watch.elapsed();
  if (options.keeper && usable) options.keeper->end(film, complete);
  out.result = film.result();
  out.result.complete = complete;
  out.said.append(world.textures->errors());
  return out;
}

}  // namespace whit
