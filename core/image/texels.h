// From a picture's raw numbers to texture values: channels, flip, sRGB decoding, and the power-of-two sides
// that MIP maps need. The order of operations is pbrt-v3's.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/image/image.h"

namespace whit {

/// What lies outside [0, 1)^2: the texture again, black, or its border texels; LatLong, for pictures of all directions:
/// the texture again along s, which goes around, and its border texels along t, which ends at two poles.
enum class WrapMode : uint8_t { Repeat, Black, Clamp, LatLong };
constexpr WrapMode wrap_along_s(WrapMode wrap) { return wrap == WrapMode::LatLong ? WrapMode::Repeat : wrap; }
constexpr WrapMode wrap_along_t(WrapMode wrap) { return wrap == WrapMode::LatLong ? WrapMode::Clamp : wrap; }

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

/// Takes a picture apart: `single` makes one channel, the Rec.709 luminance of the raw numbers; otherwise three,
/// or one when the picture is grey. Then sRGB decoding if `gamma`, then times `scale`. `flip` puts the bottom
/// row first, so that t = 0 is the bottom (pbrt's imagemap; its lights do not flip). Alpha is ignored.
Texels make_texels(const Image& image, bool single, bool gamma, float scale, bool flip);
Texels make_texels(const ByteImage& image, bool single, bool gamma, float scale, bool flip);

/// Enlarges both sides to the next power of two with a Lanczos filter (radius 2, tau 2, four normalised taps),
/// first along s, then along t, the result clamped to >= 0. Texels that are powers of two come back as they are.
/// Source: Pharr, Jakob, Humphreys, Physically Based Rendering, 3rd ed., 10.4.3.
Texels resample_to_power_of_two(Texels texels, WrapMode wrap);

/// True for 1, 2, 4, 8, ...
constexpr bool is_power_of_two(int n) { return n > 0 && (n & (n - 1)) == 0; }

}  // namespace whit
