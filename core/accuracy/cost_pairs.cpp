#include "core/accuracy/cost_pairs.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/accuracy/measures.h"
#include "core/compare/quantiles.h"
#include "core/session/denoised.h"

namespace whit {
namespace {

struct Look {
  CostWorld& world;
  std::unique_ptr<FilmRender> film;
  uint32_t samples = 0;
  Look(CostWorld& of, int asked, uint32_t seed) : world(of) {
    set_samples(world.built, asked, seed);
    film = std::make_unique<FilmRender>(world.scene(), world.options);
    samples = static_cast<uint32_t>(world.scene().samples_per_pixel);
  }
};

/// The picture that comes of a film; what is done to it afterwards takes its time too. None where that fails.
std::optional<Picture> picture_of(const Look& look, const CostRequest& request, Elapsed& spent) {
  if (!look.world.denoiser) return look.film->picture();
  const RenderResult result = look.film->result();
  const Stopwatch watch;
  DenoisedPicture made = denoise(*look.world.denoiser, result, request.threads);
  spent = spent + watch.elapsed();
  if (!made.error.empty()) return {};
  return std::move(made.picture);
}

/// Adds the pair of one seed; false when it was stopped.
bool add_pair(CostWorld& base, CostWorld& variant, const CostRequest& request, int samples, uint32_t seed,
              CostPairs& pairs) {
  Look one(base, samples, seed), other(variant, samples, seed);
  FilmRender* const films[] = {one.film.get(), other.film.get()};
  const Stopwatch watch;
  if (!FilmRender::extend_in_turn(films, other.samples)) return false;
  // The clock on the wall saw both; each gets its share by what the processor did for it.
  const double wall = watch.elapsed().wall, a = one.film->cpu_seconds(), b = other.film->cpu_seconds();
  const double share = a + b > 0 ? a / (a + b) : 0.5;
  Elapsed base_spent{wall * share, a}, variant_spent{wall * (1 - share), b};
  std::optional<Picture> made = picture_of(other, request, variant_spent);
  if (!made) return false;
  pairs.samples = static_cast<int>(other.samples);
  pairs.base.push_back(one.film->picture()), pairs.variant.push_back(std::move(*made));
  pairs.base_spent.push_back(base_spent), pairs.variant_spent.push_back(variant_spent);
  return true;
}

float luminance_at(const std::vector<float>& rgb, size_t pixel) {
  return luminance(RGB(rgb[3 * pixel], rgb[3 * pixel + 1], rgb[3 * pixel + 2]));
}

/// Pixels whose luminance differs by more than 1 % of the reference's, with 99 % confidence.
double share_changed(const std::vector<std::vector<float>>& differences, const std::vector<float>& sum,
                     const std::vector<float>& reference) {
  const double n = static_cast<double>(differences.size());
  const double reach = student_t_quantile(n - 1, 0.995) / std::sqrt(n);
  const size_t pixels = reference.size() / 3;
  size_t changed = 0;
  for (size_t p = 0; p < pixels; ++p) {
    const double mean = static_cast<double>(luminance_at(sum, p)) / n;
    double square = 0;
    for (const auto& d : differences) {
      const double off = static_cast<double>(luminance_at(d, p)) - mean;
      square += off * off;
    }
    const double least = std::abs(mean) - reach * std::sqrt(square / (n - 1));
    if (least > 0.01 * static_cast<double>(luminance_at(reference, p))) ++changed;
  }
  return pixels > 0 ? static_cast<double>(changed) / static_cast<double>(pixels) : 0.0;
}

std::vector<std::span<const float>> spans(const std::vector<Picture>& pictures) {
  std::vector<std::span<const float>> out(pictures.size());
  std::transform(pictures.begin(), pictures.end(), out.begin(),
                 [](const Picture& picture) { return std::span(picture.rgb); });
  return out;
}

}  // namespace

CostPairs render_pairs(CostWorld& base, CostWorld& variant, const CostRequest& request, CostClock& clock, int samples,
                       int pairs) {
  CostPairs out;
  for (int r = 0; r < pairs && clock.go_on(); ++r) {
    if (!add_pair(base, variant, request, samples, request.seed + static_cast<uint32_t>(r), out)) break;
  }
  return out;
}

PairDifference difference_of(const CostPairs& pairs, const Picture& reference) {
  const size_t values = reference.rgb.size();
  std::vector<std::vector<float>> differences;
  std::vector<float> sum(values);
  for (size_t r = 0; r < pairs.variant.size(); ++r) {
    std::vector<float>& d = differences.emplace_back(values);
    for (size_t i = 0; i < values; ++i) {
      d[i] = pairs.variant[r].rgb[i] - pairs.base[r].rgb[i];
      sum[i] += d[i];
    }
  }
  const double mean = mean_radiance(reference.rgb), n = static_cast<double>(pairs.size());
  PairDifference out;
  out.bias = estimate_bias(difference_products(spans(pairs.variant), spans(pairs.base)), {}, mean);
  out.pixels_changed = share_changed(differences, sum, reference.rgb);
  double total = 0;
  for (float s : sum) total += static_cast<double>(s);
  out.mean_change = total / n / static_cast<double>(std::max<size_t>(values, 1)) / mean;
  for (float s : sum) out.magnitude.push_back(static_cast<float>(std::abs(static_cast<double>(s)) / n / mean));
  return out;
}

}  // namespace whit
