#include "core/compare/noise_cells.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/compare/layer_measures.h"
#include "core/compare/noise_reach.h"

namespace whit {
namespace {

double number_of(const ImageInfo& info, const char* entry, double otherwise) {
  const auto found = info.metadata.find(entry);
  if (found == info.metadata.end()) return otherwise;
  const double value = std::strtod(found->second.c_str(), nullptr);
  return value > 0 ? value : otherwise;
}

// The variance of a channel's pixels, in both files: variance.R beside R.
const ComparedChannel* variance_of(const PicturePair& pair, const std::string& channel) {
  const std::string layer = layer_of(channel), last = channel.substr(channel.rfind('.') + 1);
  for (const char* name : {"variance.", "Variance."})
    if (const ComparedChannel* found = pair.find((layer.empty() ? "" : layer + ".") + name + last)) return found;
  return nullptr;
}

// What a file's rounding may move a number by. A display's numbers taken to light move by more where it is bright.
double rounding(float v, SampleFormat format, PairScale scale) {
  const double size = std::abs(double{v});
  const double slope = scale == PairScale::Display ? 1 : 1 + 1.4 * size;
  switch (format) {
    case SampleFormat::Half: return size * 0x1p-11 + 0x1p-25;
    case SampleFormat::UInt8: return 0.5 / 255 * slope;
    case SampleFormat::UInt16: return 0.5 / 65535 * slope;
    case SampleFormat::Float: break;
  }
  return size * 0x1p-18;
}

// Adds pixels of a channel to blocks.
class PixelSums {
 public:
  PixelSums(const PicturePair& pair, const TestedChannel& tested, const NoiseModel& model)
      : pair_(pair), tested_(tested), blind_(2 / square(model.fewest_samples() + 2)) {}

  void add(size_t i, BlockSums& to) const {
    const float a = tested_.channel->a[i], b = tested_.channel->b[i];
    if (!is_tested(i) || (!equal_numbers(a, b) && !(std::isfinite(a) && std::isfinite(b)))) return;
    to.pixels += 1;
    if (!std::isfinite(a)) return;
    const double d = double{a} - double{b}, r = tolerance(a, b), beyond = std::max(0.0, std::abs(d) - r);
    to.difference += d;
    to.squares += d * d;
    to.beyond += beyond * beyond;
    to.reference += double{b};
    to.tolerance += r;
    if (tested_.variance) add_variance(i, beyond, to);
  }

 private:
  static double square(double v) { return v * v; }

  bool is_tested(size_t i) const {
    const ComparedChannel* variance = tested_.variance ? tested_.variance : tested_.unknown;
    if (!variance) return true;
    const bool known = std::isfinite(variance->a[i]) && std::isfinite(variance->b[i]);
    return known == (tested_.variance != nullptr);
  }

  double tolerance(float a, float b) const {
    return rounding(a, tested_.channel->a_format, pair_.scale) + rounding(b, tested_.channel->b_format, pair_.scale) +
           tested_.allowance * std::abs(double{b});
  }

  // Where all samples agree in both, and not with each other, the mean is known as well as that of a coin that fell on one side
  // n times: to 1 / (n + 2) (Laplace's rule).
  void add_variance(size_t i, double beyond, BlockSums& to) const {
    double a = double{tested_.variance->a[i]}, b = double{tested_.variance->b[i]};
    if (const double least = blind_ * beyond * beyond; a + b < least) a = b = least / 2;
    to.variance_a += a;
    to.variance_b += b;
    to.variance_squares += a * a + b * b;
  }

  const PicturePair& pair_;
  const TestedChannel& tested_;
  double blind_;
};

}  // namespace

double NoiseModel::fewest_samples() const {
  constexpr double kFew = 4;
  return samples_a > 0 && samples_b > 0 ? std::min(samples_a, samples_b) : kFew;
}

NoiseModel noise_model(const PicturePair& pair) {
  NoiseModel model;
  model.samples_a = number_of(pair.a, "whit:samplesPerPixel", 0);
  model.samples_b = number_of(pair.b, "whit:samplesPerPixel", 0);
  const ComparedLayer* beauty = pair.beauty();
  model.known = beauty && pair.scale == PairScale::Linear;
  if (beauty)
    for (const size_t c : beauty->channels) model.known = model.known && variance_of(pair, pair.channels[c].name);
  if (!model.known) return model;
  model.freedom = std::min(number_of(pair.a, "whit:varianceFreedom", 3), number_of(pair.b, "whit:varianceFreedom", 3));
  model.area = std::max(number_of(pair.a, "whit:filterArea", 1), number_of(pair.b, "whit:filterArea", 1));
  return model;
}

// Layers beside the beauty have no variances. Where the pictures have different numbers of samples, means such as those of
// unit vectors differ by a little without being wrong.
std::vector<TestedChannel> tested_channels(const PicturePair& pair, const NoiseModel& model) {
  constexpr double kAllowance = 0.05;
  const bool alike = model.samples_a == model.samples_b;
  std::vector<TestedChannel> all;
  for (const ComparedLayer& layer : pair.layers) {
    if (layer.kind != ChannelKind::Colour && layer.kind != ChannelKind::Data) continue;
    const bool beauty = &layer == pair.beauty();
    for (const size_t c : layer.channels) {
      const ComparedChannel& channel = pair.channels[c];
      const ComparedChannel* variance = beauty && model.known ? variance_of(pair, channel.name) : nullptr;
      if (variance) all.push_back({&channel, variance, nullptr, 0, model.area});
      const bool all_known = variance && all_finite(variance->a) && all_finite(variance->b);
      if (all_known) continue;
      all.push_back({&channel, nullptr, variance, beauty || alike ? 0 : kAllowance,
                     noise_reach(channel.a, channel.b, pair.width(), pair.height())});
    }
  }
  return all;
}

CellGrid make_grid(const PicturePair& pair, const TestedChannel& tested, const NoiseModel& model) {
  const PixelSums sums(pair, tested, model);
  CellGrid grid{(pair.width() + kNoiseCell - 1) / kNoiseCell, (pair.height() + kNoiseCell - 1) / kNoiseCell, {}};
  grid.cells.resize(static_cast<size_t>(grid.across) * static_cast<size_t>(grid.down));
  tbb::parallel_for(0, grid.down, [&](int row) {
    for (int y = row * kNoiseCell; y < std::min(pair.height(), (row + 1) * kNoiseCell); ++y) {
      const size_t first = static_cast<size_t>(y) * static_cast<size_t>(pair.width());
      BlockSums* const cells = &grid.cells[static_cast<size_t>(row) * static_cast<size_t>(grid.across)];
      for (int x = 0; x < pair.width(); ++x) sums.add(first + static_cast<size_t>(x), cells[x / kNoiseCell]);
    }
  });
  return grid;
}

}  // namespace whit
