// The choices that an image texture has, for whoever makes one and need not know how it is read and filtered.
#pragma once

#include <cstdint>

namespace whit {

/// What lies outside [0, 1)^2: the texture again, black, its border texels, or the texture mirrored at its borders.
/// LatLong, for pictures of all directions: the texture again along s, which goes around, and its border texels along t,
/// which ends at two poles. That is two modes, as any others are by wrap_of(): each axis has two bits.
enum class WrapMode : uint8_t { Repeat = 0, Black = 5, Clamp = 10, Mirror = 15, LatLong = 8 };
constexpr WrapMode wrap_along_s(WrapMode wrap) { return static_cast<WrapMode>((static_cast<int>(wrap) & 3) * 5); }
constexpr WrapMode wrap_along_t(WrapMode wrap) { return static_cast<WrapMode>((static_cast<int>(wrap) >> 2) * 5); }
constexpr WrapMode wrap_of(WrapMode s, WrapMode t) {
  return static_cast<WrapMode>((static_cast<int>(s) & 3) | (static_cast<int>(t) & 12));
}

/// What a lookup takes of the texels around its point.
enum class TextureFilter : uint8_t {
  Ewa,        ///< Their mean over an ellipse, by weights that fall off from its middle.
  Trilinear,  ///< Their mean over a square, between four texels of two levels.
  Point       ///< The nearest of the finest level, whatever the footprint.
};

enum class TextureKind : uint8_t { Float, Rgb };

/// What a texture of floats takes of a picture: the luminance before gamma decoding, as pbrt-v3, or one channel. The alpha
/// of a picture that has none is 1, and it is never gamma decoded.
enum class TextureChannel : uint8_t { Luminance, Red, Green, Blue, Alpha };

}  // namespace whit
