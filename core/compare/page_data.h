// The numbers of two pictures as text inside a page: deflated, in base64.
//
// The page's script reads them (page_script_data.h). A layer's bytes are its channels one after another, of each first A
// and then B. A is stored as differences of bit patterns from pixel to pixel, B from A, zigzag-coded (0, -1, 1, -2 ... are
// 0, 1, 2, 3 ...), first all low bytes, then the next: of pictures that are alike little is left.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/compare/colour_maps.h"
#include "core/compare/pair.h"

namespace whit {

/// Pictures above so many pixels are reduced, and halfs are preferred to floats above so many.
inline constexpr size_t kPageMostPixels = size_t{4} << 20, kPageFloatPixels = size_t{256} << 10;

/// A table of colours: six hexadecimal digits of each.
std::string hex_text(const ColourMap& map);

/// How pictures are reduced for a page: each pixel of it is the mean of `step` x `step` (fewer at the far borders).
struct PageSize {
  int step = 1, width = 0, height = 0;
};
PageSize page_size(const PicturePair& pair);

/// How numbers are stored: as floats of 16 or 32 bits, or as whole numbers of which 65535 is 1.
enum class PageNumbers : uint8_t { Half, Float, Whole };

/// A layer in a page.
struct PageLayer {
  std::string name;
  ChannelKind kind = ChannelKind::Colour;
  std::vector<std::string> channels{};
  PageNumbers numbers = PageNumbers::Half;
  bool rounded = false;  ///< Halfs that are not the numbers of the files.
  std::string data{};    ///< "" when left out.
};

/// What loses nothing, the smallest first; halfs nevertheless where floats would be many, unless halfs overflow.
PageLayer page_layer(const PicturePair& pair, const ComparedLayer& layer, const PageSize& size);

/// A map of numbers in [0, 1], as bytes; of reduced pictures the largest of each block. NaN is 1.
std::string page_map(std::span<const float> map, const PicturePair& pair, const PageSize& size);

/// Pictures at most `most_width` wide as addresses: the colours as an sRGB display shows them, and the difference.
std::string thumbnail(const PicturePair& pair, Side side, int most_width);
std::string heat_thumbnail(const PicturePair& pair, int most_width);

}  // namespace whit
