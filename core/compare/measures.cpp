// The table of measures, and which of them a layer has.
#include "core/compare/measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/color/srgb.h"
#include "core/compare/layer_measures.h"
#include "core/compare/shift.h"
#include "core/compare/ssim.h"

namespace whit {

std::span<const MeasureRow> all_measures() {
  static const std::vector<MeasureRow> rows{
      {.name = "relmse_robust",
       .doc = "relmse without the worst thousandth of the pixels, by which fireflies would decide",
       .limit = 0.02},
      {.name = "ratio",
       .doc = "mean(A) / mean(B) of the colour that is furthest from 1; limits are of |ratio - 1|",
       .limit = 0.01},
      {.name = "block",
       .doc = "largest |a - b| / (|b| + 0.1 mean|B|) of the means a, b of blocks of 8 x 8 pixels",
       .limit = 0.08},
      {.name = "channel_block",
       .doc = "the same of a channel by itself, over the mean |b| of all: colours do not make up for each other",
       .limit = 0.16},
      {.name = "shift",
       .doc = "pixels by which the picture is displaced; infinite when it is mirrored or turned",
       .limit = 0.1},
      {.name = "mismatch",
       .doc = "share of the pixels of ids whose id the other picture has not within a pixel; of depths, whether there "
              "is one",
       .limit = 0.02},
      {.name = "relmse", .doc = "mean of (a - b)^2 / (b^2 + (0.1 mean|B|)^2)"},
      {.name = "mse", .doc = "mean of (a - b)^2"},
      {.name = "rmse", .doc = "root of mse"},
      {.name = "mae", .doc = "mean of |a - b|"},
      {.name = "max", .doc = "largest |a - b|"},
      {.name = "pixels", .doc = "share of the pixels with a number that is not equal"},
      {.name = "psnr",
       .doc = "10 log10(peak^2 / mse) in dB; the peak is 1 for display values, else the largest of B",
       .falls = true},
      {.name = "ssim",
       .doc = "mean structural similarity of the display values, 1 when equal",
       .falls = true,
       .slow = true},
      {.name = "flip", .doc = "mean FLIP at 67 pixels per degree; of linear pictures HDR-FLIP", .slow = true},
  };
  return rows;
}

const MeasureRow* find_measure(const std::string& name) {
  const auto rows = all_measures();
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const MeasureRow& row) { return row.name == name; });
  return found == rows.end() ? nullptr : &*found;
}

std::vector<std::string> measure_names(bool falls) {
  std::vector<std::string> names;
  for (const MeasureRow& row : all_measures())
    if (row.falls == falls) names.emplace_back(row.name);
  return names;
}

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// A layer's numbers for arithmetic. Pixels with one that is not finite, in either picture, have zeros in both.
struct FiniteLayer {
  LayerPlanes planes;
  std::vector<std::vector<float>> copies;
  std::vector<uint8_t> valid;           ///< 1 for pixels that are finite in both, where not all are.
  std::vector<float> there_a, there_b;  ///< 1 for pixels that are finite in one.
};

FiniteLayer finite_layer(const PicturePair& pair, const ComparedLayer& layer) {
  FiniteLayer result;
  bool finite = true;
  for (const size_t c : layer.channels) {
    result.planes.push_back({pair.channels[c].a, pair.channels[c].b});
    finite = finite && all_finite(pair.channels[c].a) && all_finite(pair.channels[c].b);
  }
  if (finite) return result;
  result.there_a.assign(pair.pixels(), 1);
  result.there_b.assign(pair.pixels(), 1);
  for (const PlanePair& plane : result.planes)
    for (size_t i = 0; i < plane.a.size(); ++i) {
      if (!std::isfinite(plane.a[i])) result.there_a[i] = 0;
      if (!std::isfinite(plane.b[i])) result.there_b[i] = 0;
    }
  for (size_t i = 0; i < result.there_a.size(); ++i)
    result.valid.push_back(result.there_a[i] != 0 && result.there_b[i] != 0);
  result.copies.reserve(2 * result.planes.size());
  for (PlanePair& plane : result.planes)
    for (std::span<const float>* side : {&plane.a, &plane.b}) {
      std::vector<float>& copy = result.copies.emplace_back(side->begin(), side->end());
      for (size_t i = 0; i < copy.size(); ++i)
        if (!result.valid[i]) copy[i] = 0;
      *side = copy;
    }
  return result;
}

// The errors of the pixels that are finite in both.
LayerErrors errors_of(const FiniteLayer& layer) {
  if (layer.valid.empty()) return layer_errors(layer.planes);
  std::vector<std::vector<float>> kept;
  std::vector<size_t> numbers;
  for (size_t i = 0; i < layer.valid.size(); ++i)
    if (layer.valid[i]) numbers.push_back(i);
  if (numbers.empty()) numbers.push_back(0);  // Zeros.
  LayerPlanes planes;
  kept.reserve(2 * layer.planes.size());
  const auto keep = [&](std::span<const float> plane) -> std::span<const float> {
    std::vector<float>& part = kept.emplace_back();
    for (const size_t i : numbers) part.push_back(plane[i]);
    return part;
  };
  for (const PlanePair& plane : layer.planes) planes.push_back({keep(plane.a), keep(plane.b)});
  LayerErrors errors = layer_errors(planes);
  errors.largest_pixel = numbers[errors.largest_pixel];
  return errors;
}

// Collects the measures of one layer.
class Measurer {
 public:
  Measurer(const PicturePair& pair, const ComparedLayer& layer, std::vector<Measured>& to)
      : pair_(pair), layer_(layer), to_(to) {}

  Measured& add(const char* name, double value) {
    to_.push_back({name, layer_.name, value, "", {}, "", {}});
    return to_.back();
  }
  std::string channel(size_t number) const { return pair_.channels[layer_.channels[number]].name; }

  void add_errors(const FiniteLayer& finite);
  void add_largest(const FiniteLayer& finite, const LayerErrors& errors);
  void add_shift(const LayerPlanes& planes);
  void add_mismatch(std::span<const float> a, std::span<const float> b);
  void add_mismatches();
  void add_differing(std::vector<uint8_t>& any);

 private:
  const PicturePair& pair_;
  const ComparedLayer& layer_;
  std::vector<Measured>& to_;
};

void Measurer::add_errors(const FiniteLayer& finite) {
  const LayerErrors e = errors_of(finite);
  const Worst robust = worst_share(e.robust, kTrimmed);
  Measured& trimmed = add("relmse_robust", robust.mean_without);
  if (robust.count > 0)
    trimmed.words = fmt::format("the worst {} hold{} {:.3g} % of it",
                                robust.count == 1 ? "pixel" : fmt::format("{} pixels", robust.count),
                                robust.count == 1 ? "s" : "", 100 * robust.share);
  if (layer_.kind == ChannelKind::Colour)
    if (const Ratio ratio = furthest_ratio(e); ratio.any) add("ratio", ratio.value).channel = channel(ratio.channel);
  const BlockErrors blocks = largest_block_errors(finite.planes, finite.valid.empty() ? nullptr : finite.valid.data(),
                                                  pair_.width(), pair_.height(), floor_of(e.usual_magnitude));
  add("block", blocks.mean.value).at = pair_.window.min + blocks.mean.corner;
  if (finite.planes.size() > 1) {
    Measured& one = add("channel_block", blocks.one_channel.value);
    one.at = pair_.window.min + blocks.one_channel.corner;
    if (one.value > 0) one.channel = channel(blocks.one_channel.channel);
  }
  add("relmse", e.relmse);
  add("mse", e.mse);
  add("rmse", std::sqrt(e.mse));
  add("mae", e.mae);
  add_largest(finite, e);
  const double peak = pair_.scale == PairScale::Display && layer_.kind == ChannelKind::Colour ? 1 : e.peak;
  add("psnr", e.mse > 0 ? 10 * std::log10(peak * peak / e.mse) : kInfinite);
}

// Something and nothing, by infinity or NaN, are infinitely far from each other.
void Measurer::add_largest(const FiniteLayer& finite, const LayerErrors& errors) {
  const auto unlike = std::mismatch(finite.there_a.begin(), finite.there_a.end(), finite.there_b.begin());
  if (unlike.first != finite.there_a.end()) {
    add("max", kInfinite).at = pair_.place(static_cast<size_t>(unlike.first - finite.there_a.begin()));
    return;
  }
  Measured& most = add("max", errors.largest);
  if (!(errors.largest > 0)) return;
  most.at = pair_.place(errors.largest_pixel);
  most.channel = channel(errors.largest_channel);
}

// By green, most of what the eye sees, or what there is.
void Measurer::add_shift(const LayerPlanes& planes) {
  const PlanePair& plane = planes[std::min<size_t>(1, planes.size() - 1)];
  const Displacement found = find_displacement(plane.a, plane.b, pair_.width(), pair_.height());
  Measured& shift = add("shift", 0);
  if (!found.found) return;
  if (*found.words) {
    shift.value = kInfinite;
    shift.words = found.words;
  } else {
    shift.value = found.by.length();
    shift.words = fmt::format("{:+.2f} right, {:+.2f} down", found.by.x, found.by.y);
  }
}

void Measurer::add_mismatch(std::span<const float> a, std::span<const float> b) {
  const Mismatch found = mismatch_of(a, b, pair_.width(), pair_.height());
  Measured& mismatch = add("mismatch", found.share);
  if (found.share > 0) mismatch.at = pair_.place(found.first);
}

// A cryptomatte's coverages are noisy where things meet; what is compared is which of them covers most.
void Measurer::add_mismatches() {
  for (const size_t c : layer_.channels) {
    const ComparedChannel& ids = pair_.channels[c];
    if (!is_matte(ids.name) || is_first_matte_rank(ids.name)) add_mismatch(ids.a, ids.b);
  }
}

void Measurer::add_differing(std::vector<uint8_t>& any) {
  LayerPlanes planes;
  for (const size_t c : layer_.channels) planes.push_back({pair_.channels[c].a, pair_.channels[c].b});
  const std::vector<uint8_t> differs = differing(planes);
  for (size_t i = 0; i < any.size(); ++i) any[i] |= differs[i];
  const auto first = std::find(differs.begin(), differs.end(), 1);
  Measured& pixels =
      add("pixels", static_cast<double>(std::count(first, differs.end(), 1)) / static_cast<double>(differs.size()));
  if (first != differs.end()) pixels.at = pair_.place(static_cast<size_t>(first - differs.begin()));
}

void measure_layer(const PicturePair& pair, const ComparedLayer& layer, std::vector<uint8_t>& any,
                   std::vector<Measured>& to) {
  Measurer measurer(pair, layer, to);
  if (layer.kind == ChannelKind::Id) {
    measurer.add_mismatches();
  } else {
    const FiniteLayer finite = finite_layer(pair, layer);
    measurer.add_errors(finite);
    if (!finite.valid.empty()) measurer.add_mismatch(finite.there_a, finite.there_b);
    if (layer.kind == ChannelKind::Colour) measurer.add_shift(finite.planes);
  }
  measurer.add_differing(any);
}

// The beauty's colours; what is NaN is black.
std::vector<float> numbers_of(const PicturePair& pair, Side side) {
  std::vector<float> rgb = interleaved_colours(pair, side);
  for (float& v : rgb)
    if (std::isnan(v)) v = 0;
  return rgb;
}

// Its display values: the sRGB curve of linear light, clamped.
std::vector<float> display_values(const PicturePair& pair, Side side) {
  std::vector<float> rgb = numbers_of(pair, side);
  for (float& v : rgb) v = pair.scale == PairScale::Linear ? srgb_encode(v) : std::clamp(v, 0.0f, 1.0f);
  return rgb;
}

void add_ssim(const PicturePair& pair, Measurer& to) {
  to.add("ssim", structural_similarity(display_values(pair, Side::A), display_values(pair, Side::B), pair.width(),
                                       pair.height()));
}

void add_flip(const PicturePair& pair, Measurer& to) {
  const Flip seen = flip_of(pair);
  const auto most = std::max_element(seen.map.begin(), seen.map.end());
  Measured& flip = to.add("flip", seen.mean);
  if (*most > 0) flip.at = pair.place(static_cast<size_t>(most - seen.map.begin()));
}

}  // namespace

Flip flip_of(const PicturePair& pair) {
  const std::vector<float> a = numbers_of(pair, Side::A), b = numbers_of(pair, Side::B);
  return pair.scale == PairScale::Display ? flip(b, a, pair.width(), pair.height())
                                          : hdr_flip(b, a, pair.width(), pair.height());
}

int64_t measure_pair(const PicturePair& pair, const std::vector<std::string>& slow, std::vector<Measured>& measured) {
  std::vector<uint8_t> differs(pair.pixels());
  for (const ComparedLayer& layer : pair.layers) measure_layer(pair, layer, differs, measured);
  const ComparedLayer* beauty = pair.beauty();
  const auto wanted = [&](const char* name) {
    return beauty && std::find(slow.begin(), slow.end(), name) != slow.end();
  };
  if (beauty) {
    Measurer measurer(pair, *beauty, measured);
    if (wanted("ssim")) add_ssim(pair, measurer);
    if (wanted("flip")) add_flip(pair, measurer);
  }
  return std::count(differs.begin(), differs.end(), 1);
}

}  // namespace whit
