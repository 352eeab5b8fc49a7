// The film of AOVs: values of samples to layers of a picture, in the same fixed order as the picture's colours.
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/image/write.h"
#include "core/render/aov_plan.h"
#include "core/render/film_buffer.h"
#include "core/render/worker.h"

namespace whit {

/// How much of a pixel something with a number covers: the weights of its samples.
struct Coverage {
  uint32_t id;
  float rest;  ///< add_exactly()
  double weight;
};

/// What the samples of one unit give to AOVs.
class AovTile {
 public:
  AovTile(const AovPlan& plan, Vec2i tile, const FilterTable& filter, int size = TileReach::kTile);
  /// Adds the samples [begin, end) of a chunk in their order, those that are usable. Its radiance is weighed.
  void add(const SampleChunk& chunk, const uint8_t* usable, int begin, int end);

  bool reaches(int x, int y) const { return reach_.holds(x, y); }
  /// A sum at a pixel within reach: of the first AovPlan::means columns, then of the weights of all samples and of those
  /// that met something.
  double sum(int x, int y, size_t column) const {
    const size_t at = stride_ * static_cast<size_t>(reach_.number(x, y)) + column;
    return sums_[at] + static_cast<double>(rests_[at]);
  }
  /// What covers a pixel within reach, by the numbers of a column, in their order.
  const std::vector<Coverage>& coverage(size_t matte, int x, int y) const {
    return coverage_[matte][static_cast<size_t>(reach_.number(x, y))];
  }
  /// The sample nearest to the middle of a pixel of the tile, by column from AovPlan::means on; null without a sample.
  const float* nearest(int x, int y) const;
  /// How many of the pixel's own samples were usable, if somebody asks.
  int64_t samples(int x, int y) const { return samples_[own(x, y)]; }

  /// All of it to bytes, and back into a tile of the same size. `things`: how many numbers each matte knows; a larger one
  /// fails the reader.
  void save(ByteWriter& out) const;
  void restore(ByteReader& in, std::span<const size_t> things);
  /// Adds what another tile of the same size saved, of samples that come after those that are here.
  void merge(ByteReader& in, std::span<const size_t> things);

 private:
  size_t own(int x, int y) const { return static_cast<size_t>((y - y0_) * size_ + x - x0_); }
  template <class Body>
  void each_coverage(ByteReader& in, std::span<const size_t> things, const Body& body);
  void add_sums(const SampleChunk& chunk, int sample);
  void add_nearest(const SampleChunk& chunk, int sample);

  const AovPlan& plan_;
  TileReach reach_;
  int size_, x0_, y0_;
  size_t stride_;
  std::vector<double> sums_;
  std::vector<float> rests_;                                  ///< Of the sums: add_exactly().
  std::vector<std::vector<std::vector<Coverage>>> coverage_;  ///< By matte and pixel.
  std::vector<float> distance_, nearest_;                     ///< Squared from the middle, and the values.
  std::vector<int64_t> samples_;
};

/// Layers of a picture and what its header says of them.
struct AovPicture {
  struct Channel {
    std::string name;
    bool full_float;
    std::vector<float> values;  ///< Of the window, row by row.
  };
  std::vector<Channel> channels;
  std::vector<OutputMetadata> header;
  std::vector<OutputMatrix> matrices;
  std::vector<std::set<uint32_t>> seen;  ///< Of each cryptomatte, the numbers of what is in it.
};

/// Says in the header what cryptomattes are of, by the numbers that were seen.
void set_matte_headers(const Scene& scene, const AovPlan& plan, const StatementPlace& place, AovPicture& picture);

/// Merges the units.
AovPicture resolve_aovs(const Scene& scene, const AovPlan& plan, const StatementPlace& place,
                        const std::vector<AovTile>& tiles, const FilmUnits& film, const Box2i& window);

}  // namespace whit
