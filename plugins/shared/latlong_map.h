// Pictures of the whole sphere of directions as light: lat-long maps with matching importance sampling.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/distribution.h"
#include "core/image/texels.h"
#include "core/plugin/memory_need.h"
#include "plugins/shared/environment.h"

namespace whit {

/// What texels a map is read from. (With either, the poles have the value of their row. pbrt-v3 repeats maps along v too,
/// so that light of the top row comes from the lower pole.)
enum class LatLongRule : uint8_t {
  Pbrt,   ///< As pbrt-v3's MIP map: sides are enlarged to powers of two.
  Exact,  ///< The file's.
};

/// A lat-long map: u = phi / 2 pi with phi = atan2(y, x), v = theta / pi with theta from +z; the top row is the zenith.
/// Radiance is bilinear between texel centres. Directions are drawn cell by cell of the grid whose corners are the
/// texel centres, each cell by the mean of its radiance times its solid angle, and uniformly in solid angle inside: so
/// the density is positive wherever the radiance is, and has no singularity at the poles.
class LatLongMap final : public DirectionalRadiance {
 public:
  /// Radiances are the texels times `factor`. Numbers that are negative, infinite or NaN count as 0; `bad_numbers`
  /// returns how many there were.
  LatLongMap(Texels texels, const RGB& factor, LatLongRule rule, size_t& bad_numbers);

  /// What a map takes that is made of a picture of so many pixels.
  static size_t bytes(int width, int height, LatLongRule rule);

  /// The most that making one takes beside the texels of a picture of so many pixels and 1 or 3 channels.
  static size_t bytes_to_build(int width, int height, int channels, LatLongRule rule);

  void evaluate(int n, const Vec3Lanes& d, const RGBLanes& radiance, float* pdf) const override;
  void sample(int n, const float* u, const float* v, const Vec3Lanes& d) const override;
  double mean() const override;

 private:
  /// A row of cells: the angle theta between two circles of latitude.
  struct Band {
    float pole;       ///< +1: measured from +z, -1: from -z.
    float low, high;  ///< 1 - |cos theta| at its edges, the part nearer to v = 0 first.
    float density;    ///< One over the solid angle of a cell.
  };

  void look_up(int n, const float* x, const float* y, const RGBLanes& out) const;
  void find_density(int n, const float* x, const float* y, float* pdf) const;
  void build_radiance(Texels texels, const RGB& factor, LatLongRule rule, size_t& bad_numbers);
  void build_bands();
  void build_cells();
  /// The texel rows a band lies between.
  int row_above(int band) const;
  int row_below(int band) const;

  int width_ = 0, height_ = 0;
  std::vector<float> radiance_;  ///< RGB, row by row.
  std::vector<Band> bands_;      ///< height + 1: band k lies between the centres of texel rows k - 1 and k.
  GridDistribution cells_;
};

/// Reads the lat-long map of a light statement. Reports a file that cannot be read (error, null returned) and bad
/// texels (warning).
std::unique_ptr<const LatLongMap> read_latlong_map(const std::string& path, const RGB& factor, LatLongRule rule,
                                                   const PrepareContext& ctx);

/// What read_latlong_map() will come to; nothing for "".
MemoryNeed latlong_need(const std::string& path, LatLongRule rule);

}  // namespace whit
