// A grid of cells in every pixel, one sample in each, for every pair of dimensions. With jitter the samples of a row of
// cells also spread evenly over its columns, and the reverse (correlated multi-jitter), which plain jitter as in pbrt-v3
// does not promise. Source: Kensler, Correlated Multi-Jittered Sampling, Pixar Technical Memo 13-01, 2013.

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/base/radical_inverse.h"
#include "core/plugin/registry.h"
#include "core/plugin/sampler.h"
#include "plugins/shared/sample_sets.h"

namespace whit {
namespace {

constexpr int kMaxSamples = 1 << 22;  // cells are found by a division in float, exact up to here
constexpr int kBlock = 256;

class Stratified final : public Sampler {
 public:
  int xsamples = 4, ysamples = 4;
  bool jitter = true;
  int dimensions = 4;  ///< pbrt's; here no dimension is worse than another.

  void check(Diagnostics& diagnostics, SourcePos statement) override {
    if (int64_t{xsamples} * ysamples <= kMaxSamples) return;
    diagnostics.error(statement, "\"xsamples\" times \"ysamples\" is more than 4194304 samples per pixel");
  }

  int samples_per_pixel() const override { return xsamples * ysamples; }
  bool is_regular() const override { return !jitter; }
  bool extends() const override { return false; }
  std::string rounding() const override {
    return asked_ == 0 || asked_ == samples_per_pixel()
               ? ""
               : fmt::format("stratified takes a grid of {} x {}; {} were asked for", xsamples, ysamples, asked_);
  }

  /// The grid nearest to square that holds n samples; the declared one where that holds n.
  int set_samples_per_pixel(int n) override {
    asked_ = n;
    n = std::clamp(n, 1, kMaxSamples);
    if (declared_.x == 0) declared_ = {xsamples, ysamples};
    if (n == declared_.x * declared_.y) {
      xsamples = declared_.x, ysamples = declared_.y;
      return n;
    }
    xsamples = static_cast<int>(std::sqrt(static_cast<double>(n)));
    ysamples = (n + xsamples - 1) / xsamples;
    return samples_per_pixel();
  }

  void get_1d(const SampleKeys& keys, int dimension, float* u) const override {
    alignas(64) uint32_t key[kBlock], index[kBlock];
    const bool random = jitter;
    const float width = 1 / static_cast<float>(samples_per_pixel());
    for (int first = 0; first < keys.n; first += kBlock) {
      const int n = std::min(kBlock, keys.n - first);
      begin(keys, first, n, 2 * static_cast<uint32_t>(dimension) + 1, key, index);
      float* const out = u + first;
      for_lanes(n, [&](int i) { out[i] = place(index[i], random ? jitter_of(index[i], key[i]) : 0.5f, width); });
    }
  }

  void get_2d(const SampleKeys& keys, int dimension, float* u, float* v) const override {
    alignas(64) uint32_t key[kBlock], index[kBlock], column[kBlock], row[kBlock];
    for (int first = 0; first < keys.n; first += kBlock) {
      const int n = std::min(kBlock, keys.n - first);
      begin(keys, first, n, 2 * static_cast<uint32_t>(dimension), key, index);
      const auto columns = static_cast<uint32_t>(xsamples);
      const float inverse = 1 / static_cast<float>(columns);
      for_lanes(n, [&](int i) {
        // Exact, as numbers are below 2^22: (index + 1/2) / columns is never nearer to an integer than rounding moves it.
        row[i] = static_cast<uint32_t>(static_cast<int32_t>((static_cast<float>(index[i]) + 0.5f) * inverse));
        column[i] = index[i] - columns * row[i];
      });
      fill_cells(n, key, index, column, row, u + first, v + first);
    }
  }

 private:
  static float jitter_of(uint32_t index, uint32_t key) { return unit_float(hash_combine(key, index)); }

  /// The position in the index-th of equal intervals.
  static float place(uint32_t index, float within, float width) {
    return min_below_one((static_cast<float>(static_cast<int32_t>(index)) + within) * width);
  }
  static float min_below_one(float x) { return x < kBelowOne ? x : kBelowOne; }

  /// Positions inside cells: in the middle, or in the sub-column that the row's permutation gives, and the reverse.
  void fill_cells(int n, const uint32_t* key, const uint32_t* index, const uint32_t* column, const uint32_t* row,
                  float* u, float* v) const {
    const float width = 1 / static_cast<float>(xsamples), height = 1 / static_cast<float>(ysamples);
    if (!jitter) {
      for_lanes(n, [=](int i) { u[i] = place(column[i], 0.5f, width), v[i] = place(row[i], 0.5f, height); });
      return;
    }
    alignas(64) uint32_t sub_column[kBlock], sub_row[kBlock];
    std::copy_n(row, n, sub_column), std::copy_n(column, n, sub_row);
    permute(n, static_cast<uint32_t>(ysamples), 0x636f6cu, key, sub_column);
    permute(n, static_cast<uint32_t>(xsamples), 0x726f77u, key, sub_row);
    for_lanes(n, [&](int i) {
      u[i] = place(column[i], place(sub_column[i], jitter_of(index[i], key[i] ^ 0x75u), height), width);
      v[i] = place(row[i], place(sub_row[i], jitter_of(index[i], key[i] ^ 0x76u), width), height);
    });
  }

  /// Keys and shuffled sample numbers of n lanes; `purpose` tells dimensions apart.
  void begin(const SampleKeys& keys, int first, int n, uint32_t purpose, uint32_t* key, uint32_t* index) const {
    const uint32_t base = hash_combine(mix32(seed ^ 0x53747261u), purpose);
    const int32_t *px = keys.px + first, *py = keys.py + first;
    const auto count = static_cast<uint32_t>(samples_per_pixel());
    const uint32_t* const stream = keys.stream + first;
    for_lanes(n, [=](int i) { key[i] = hash_combine(pixel_key(base, px[i], py[i]), stream[i]); });
    split_sets(n, count, keys.index + first, key, index);
    permute(n, count, 0, key, index);
  }

  static void permute(int n, uint32_t count, uint32_t salt, const uint32_t* key, uint32_t* index) {
    permute_lanes(
        n, count, [=](int i) { return mix32(key[i] ^ salt); }, index);
  }

  Vec2i declared_{0, 0};  ///< The scene's own grid, once a number of samples has been set.
  int asked_ = 0;         ///< That number, before rounding.
};

constexpr Range kSide{1, 1 << 16};

const Register<Stratified> stratified{
    "stratified",
    "A grid of cells in every pixel, one sample in each.",
    param(&Stratified::xsamples, "xsamples", 4, Unit::None, "Cells across a pixel.", kSide),
    param(&Stratified::ysamples, "ysamples", 4, Unit::None, "Cells down a pixel.", kSide),
    param(&Stratified::jitter, "jitter", true, Unit::None, "Random places in the cells; otherwise their middles."),
    param(&Stratified::dimensions, "dimensions", 4, Unit::None,
          "Accepted for pbrt's sake; every dimension is as good as the first.")};

}  // namespace
}  // namespace whit
