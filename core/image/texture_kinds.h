// The choices that an image texture has, for whoever makes one and need not know how it is read and filtered.
#pragma once

#include <cstdint>

namespace whit {

/// What lies outside [0, 1)^2: the texture again, black, or its border texels; LatLong, for pictures of all directions:
/// the texture again along s, which goes around, and its border texels along t, which ends at two poles.
enum class WrapMode : uint8_t { Repeat, Black, Clamp, LatLong };
constexpr WrapMode wrap_along_s(WrapMode wrap) { return wrap == WrapMode::LatLong ? WrapMode::Repeat : wrap; }
constexpr WrapMode wrap_along_t(WrapMode wrap) { return wrap == WrapMode::LatLong ? WrapMode::Clamp : wrap; }

/// What a lookup takes of the texels around its point.
enum class TextureFilter : uint8_t {
  Ewa,        ///< Their mean over an ellipse, by weights that fall off from its middle.
  Trilinear,  ///< Their mean over a square, between four texels of two levels.
  Point       ///< The nearest of the finest level, whatever the footprint.
};

enum class TextureKind : uint8_t { Float, Rgb };

}  // namespace whit
