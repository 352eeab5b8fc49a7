// From a picture's raw numbers to texture values: channels, flip, sRGB decoding, and the power-of-two sides
// that MIP maps need. The order of operations is pbrt-v3's.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/image/texture_kinds.h"

namespace whit {

/// The linear value of an sRGB-encoded one: v / 12.92 up to 0.04045, else ((v + 0.055) / 1.055)^2.4. IEC 61966-2-1.
float srgb_decode(float v);

/// The values that the bytes 0 to 255 of a picture stand for: 0 to 1, sRGB decoded if `gamma`.
std::array<float, 256> byte_values(bool gamma);

/// Whether the values of an image texture are sRGB where the scene does not say ("gamma"). True for .png and .tga (any
/// case), as in pbrt-v3, which reads no other integers; of other files what the file says of itself, else true for 8 bits
/// and false for more. Numbers in floating point are linear.
bool default_gamma(const std::string& path, const ImageInfo& info);

/// A grid of texture values, channels innermost.
struct Texels {
  int width = 0, height = 0;
  int channels = 0;           ///< 1 or 3.
  std::vector<float> values;  ///< height x width x channels; row 0 is t = 0.
};

/// From rows of pixels to rows of texels. Then sRGB decoding if `gamma`, then times `scale`.
class TexelRows {
 public:
  enum class Take : uint8_t {
    Rgb,        ///< Three channels, or one when the picture is grey.
    Luminance,  ///< One channel, the Rec.709 luminance of the raw numbers.
    Alpha       ///< One channel, 1 of pictures that have none.
  };
  TexelRows(const ImageInfo& image, Take take, bool gamma, float scale);
  int channels() const { return channels_; }
  void convert(const uint8_t* pixels, float* texels) const;
  void convert(const float* pixels, float* texels) const;

  /// The numbers themselves, of pictures that luminance is not taken of.
  void pick(const uint8_t* pixels, uint8_t* numbers) const;

 private:
  template <class Number, class Out, class Value, class Luminance>
  void select(const Number* pixels, Out* to, const Value& value, const Luminance& luminance_of) const;
  float decode(float v) const { return scale_ * (gamma_ ? srgb_decode(v) : v); }

  int width_ = 0, pixel_ = 0, channels_ = 0;  // pixel_: numbers of one in the picture
  bool one_everywhere_ = false;               // alpha that is not there
  std::array<int, 3> rgb_{};
  bool grey_, gamma_;
  float scale_;
  std::array<float, 256> of_byte_{}, of_grey_{};  // the texel of a byte; the luminance of three equal ones
};

/// All of a picture. `flip` puts the bottom row first, so that t = 0 is the bottom (pbrt's imagemap; its lights do not).
Texels make_texels(const Image& image, bool single, bool gamma, float scale, bool flip);

/// Enlarges both sides to the next power of two with a Lanczos filter (radius 2, tau 2, four normalised taps),
/// first along s, then along t, the result clamped to >= 0. Texels that are powers of two come back as they are.
/// Source: Pharr, Jakob, Humphreys, Physically Based Rendering, 3rd ed., 10.4.3.
Texels resample_to_power_of_two(Texels texels, WrapMode wrap);

/// The same row by row, for pictures that are kept in another form than rows of floats.
class EnlargedRows {
 public:
  /// `row(t, to)` puts row t of the small texels to `to`.
  EnlargedRows(int width, int height, int channels, WrapMode wrap, std::function<void(int t, float* to)> row);
  static constexpr int kTaps = 4;
  int width() const { return static_cast<int>(s_taps_.size()); }
  int height() const { return static_cast<int>(t_taps_.size()); }

  /// The small rows that row t of the enlarged is made of; -1 for none.
  const std::array<int, kTaps>& rows_of(int t) const { return t_taps_[static_cast<size_t>(t)].index; }

  /// Row t of the enlarged texels.
  void make(int t, float* to);

 private:
  /// The four texels that make a new one, their wrapped indices and weights; index -1 contributes nothing.
  struct Taps {
    int first;
    std::array<int, kTaps> index;
    std::array<float, kTaps> weight;
  };
  static std::vector<Taps> taps(int old_size, int new_size, WrapMode wrap);
  template <int kChannels>
  void widen(const float* from, float* to) const;
  const float* wide_row(const Taps& taps, int j);

  int channels_;
  std::function<void(int t, float* to)> row_;
  std::vector<Taps> s_taps_, t_taps_;
  std::vector<float> narrow_;
  std::array<std::vector<float>, kTaps>
      wide_;  // rows enlarged along s; neighbours, though wrapped, have different places
  std::array<int, kTaps> number_{-1, -1, -1, -1};
};

/// True for 1, 2, 4, 8, ...
constexpr bool is_power_of_two(int n) { return n > 0 && (n & (n - 1)) == 0; }

}  // namespace whit
