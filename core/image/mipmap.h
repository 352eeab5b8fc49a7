// A MIP map with pbrt-v3's filters, trilinear and elliptically weighted averages (EWA), and without any.
//
// Why not OpenImageIO's TextureSystem: scenes were lit with pbrt-v3's filter in mind and its pictures are the
// reference. OpenImageIO's anisotropic filter takes another footprint and another kernel, and its MIP levels of
// an 8-bit file average the encoded sRGB values in 8 bits, which darkens and bands. So OpenImageIO decodes the
// file and this class filters, in linear light.
//
// Sources: Pharr, Jakob, Humphreys, Physically Based Rendering, 3rd ed., 10.4; Heckbert, Fundamentals of
// Texture Mapping and Image Warping, 1989 (EWA); Williams, Pyramidal Parametrics, 1983 (trilinear).
#pragma once

#include <Imath/half.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/image/image.h"
#include "core/image/texel_block.h"
#include "core/image/texels.h"
#include "core/image/texture_kinds.h"

namespace whit {

class PictureRows;
class ScratchFile;

/// What a MIP map is made of besides the picture.
struct MipMapOptions {
  bool single = false;  ///< One channel, the luminance; otherwise RGB (a grey picture still takes one).
  bool alpha = false;   ///< With `single`: the alpha, 1 where the picture has none.
  WrapMode wrap = WrapMode::Repeat;
  bool gamma = false;   ///< Decode sRGB.
  float scale = 1;      ///< Times every value, after decoding.
  bool flip = true;     ///< t = 0 is the bottom row (imagemap); false: the top row (lights).
  bool floats = false;  ///< Keep floats where halves would be enough for most pictures.
};

/// A picture has numbers that halves cannot hold; MipMapOptions::floats can.
struct ExceedsHalves {};

/// How to filter.
struct MipFilter {
  TextureFilter kind = TextureFilter::Ewa;
  float max_anisotropy = 8;  ///< Longest to shortest axis of the EWA ellipse; kept within [0.01, 256].
};

/// Footprints of n lookups: st and its change from one pixel to the next along x and y. The four derivative
/// arrays may all be null, which asks for a bilinear lookup in the finest level (of filters but Point).
struct LookupPoints {
  int n = 0;
  const float* s = nullptr;
  const float* t = nullptr;
  const float* dsdx = nullptr;
  const float* dtdx = nullptr;
  const float* dsdy = nullptr;
  const float* dtdy = nullptr;
};

/// The pyramid and its filters. Immutable, so any number of threads may look up. A result depends on its own point
/// only, to the bit, not on n or its place in the batch. Points that are not finite give NaN; footprints
/// that are not finite cover everything and give the coarsest level.
///
/// Storage: a picture of 8 bits with sides that are powers of two keeps its bytes in level 0 (exact); other levels of 8-bit,
/// 16-bit and half pictures are half (relative error below 0.05 %); float pictures are float.
class MipMap {
 public:
  /// Has no level at all, but its lookups tell which one they need.
  MipMap(const ImageInfo& image, const MipMapOptions& options);

  /// Reads a picture to its end, and keeps the levels from `first` on: in `room`, a part of a file for bytes_of_levels(),
  /// where that is not null. May throw ExceedsHalves, and what reading throws.
  MipMap(PictureRows& rows, const MipMapOptions& options, int first = 0,
         std::shared_ptr<const TexelBlock> room = nullptr);
  MipMap(const Image& image, const MipMapOptions& options);
  MipMap(const ByteImage& image, const MipMapOptions& options);

  /// `whole` without the levels finer than `first`; the others are shared with it.
  MipMap(const MipMap& whole, int first);

  /// At most this many bytes are alive at once while a picture is read and its levels from `first` on are built, both
  /// included.
  static size_t bytes_to_build(const PictureRows& rows, const MipMapOptions& options, int first);

  /// Of these, what is beside the reader's and the levels.
  static size_t bytes_to_read(const ImageInfo& image, const MipMapOptions& options);

  /// Of the levels from `first` on of such a picture, one after another in a file.
  static size_t bytes_of_levels(const ImageInfo& image, const MipMapOptions& options, int first);

  int channels() const { return channels_; }  ///< 1 or 3.
  int level_count() const { return static_cast<int>(levels_.size()); }
  int first_level() const { return first_; }  ///< The finest level it has, level_count() when it has none.
  int width(int level = 0) const { return levels_[level]->width; }    ///< A power of two.
  int height(int level = 0) const { return levels_[level]->height; }  ///< A power of two.
  size_t bytes() const;                                               ///< Of the levels that it has.

  /// The same with its texels in a file; null when they cannot be.
  std::unique_ptr<const MipMap> in_file(ScratchFile& file) const;

  bool is_in_file() const { return in_file_ != nullptr; }

  /// Gives back the memory that texels in a file take. Others may look up meanwhile.
  void give_back() const { in_file_->give_back(); }

  /// n filtered values; `out` has one array for each channel. Returns the finest level that the points need: when
  /// that is finer than first_level(), the values are of no use.
  int lookup(const LookupPoints& points, const MipFilter& filter, float* const* out) const;

  /// n trilinear values for a square footprint of the given width in st; `out` and the result as above.
  int lookup_width(int n, const float* s, const float* t, const float* width, float* const* out) const;

 private:
  enum class Storage : uint8_t { Bytes, Halves, Floats };
  struct Level {
    int width = 0, height = 0;
    Storage storage = Storage::Floats;
    std::shared_ptr<const TexelBlock> memory;
    const void* texels = nullptr;  // in there; null when the level is not
    const uint8_t* bytes() const { return static_cast<const uint8_t*>(texels); }           // decoded by byte_values_
    const Imath::half* halves() const { return static_cast<const Imath::half*>(texels); }  // times gain_
    const float* floats() const { return static_cast<const float*>(texels); }
  };
  class Builder;
  template <int C>
  using Value = std::array<float, C>;
  static constexpr int kLanes = 64;  ///< So many lookups are prepared at a time.
  struct Ellipse;
  struct EllipseLanes;
  struct EwaLanes;
  struct BlockWeights;
  template <int C, class Wrap>
  class Sampler;

  Storage storage(int level) const { return level == 0 ? finest_storage_ : coarse_storage_; }
  size_t bytes_of(int level) const;
  std::shared_ptr<const Level> level_in(const std::shared_ptr<const TexelBlock>& room, int i, size_t at) const;
  template <int C, class F>
  int with_sampler(const F& f) const;
  template <class S>
  void ewa_lookups(S& sampler, const LookupPoints& p, const MipFilter& filter, float* const* out) const;

  std::vector<std::shared_ptr<const Level>> levels_;
  std::shared_ptr<const TexelBlock> in_file_;
  int first_ = 0;
  int channels_ = 0;
  WrapMode wrap_ = WrapMode::Repeat;
  Storage finest_storage_ = Storage::Floats, coarse_storage_ = Storage::Floats;
  float gain_ = 1;
  std::array<float, 256> byte_values_{};
};

}  // namespace whit
