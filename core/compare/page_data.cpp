#include "core/compare/page_data.h"

#include <Imath/half.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "core/compare/heat.h"
#include "core/image/data_address.h"

namespace whit {
namespace {

// The pixels that one of the reduced picture stands for.
struct Block {
  int x0, y0, x1, y1;
};

template <class Of>
void each_block(int width, int height, int step, const Of& of) {
  for (int y = 0; y < height; y += step)
    for (int x = 0; x < width; x += step) of(Block{x, y, std::min(x + step, width), std::min(y + step, height)});
}

template <class Of>
void each_pixel(const Block& block, int width, const Of& of) {
  for (int y = block.y0; y < block.y1; ++y)
    for (int x = block.x0; x < block.x1; ++x)
      of(static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x));
}

// Names have no mean: of ids the upper left one stays.
std::vector<float> reduced(const std::vector<float>& plane, ChannelKind kind, const PicturePair& pair, int step) {
  if (step == 1) return plane;
  std::vector<float> out;
  each_block(pair.width(), pair.height(), step, [&](const Block& block) {
    double sum = 0;
    each_pixel(block, pair.width(), [&](size_t i) { sum += double{plane[i]}; });
    const auto first =
        static_cast<size_t>(block.y0) * static_cast<size_t>(pair.width()) + static_cast<size_t>(block.x0);
    const int count = (block.x1 - block.x0) * (block.y1 - block.y0);
    out.push_back(kind == ChannelKind::Id ? plane[first] : static_cast<float>(sum / count));
  });
  return out;
}

float of_whole(uint16_t whole) { return static_cast<float>(whole) / 65535; }
uint16_t whole_of(float v) { return static_cast<uint16_t>(std::lround(std::clamp(v, 0.0f, 1.0f) * 65535)); }

// What becomes of numbers that are stored in 16 bits.
struct In16Bits {
  bool halfs_exact = true, halfs_overflow = false, wholes_exact = true;
};

void look_at(const std::vector<float>& plane, In16Bits& seen) {
  for (const float v : plane) {
    const bool finite = std::isfinite(v);
    const float as_half = Imath::half(v);
    seen.halfs_exact &= !finite || as_half == v;
    seen.halfs_overflow |= finite && !std::isfinite(as_half);
    seen.wholes_exact = seen.wholes_exact && finite && of_whole(whole_of(v)) == v;
  }
}

PageNumbers numbers_for(const In16Bits& seen, bool few) {
  if (seen.halfs_exact) return PageNumbers::Half;
  if (seen.wholes_exact) return PageNumbers::Whole;
  return few || seen.halfs_overflow ? PageNumbers::Float : PageNumbers::Half;
}

template <class Word>
std::vector<Word> words_of(const std::vector<float>& plane, PageNumbers numbers) {
  std::vector<Word> words(plane.size());
  for (size_t i = 0; i < plane.size(); ++i) {
    if constexpr (sizeof(Word) == 4) words[i] = std::bit_cast<Word>(plane[i]);
    else words[i] = numbers == PageNumbers::Whole ? whole_of(plane[i]) : Imath::half(plane[i]).bits();
  }
  return words;
}

template <class Word>
Word zigzag(Word value, Word expected) {
  const auto difference = static_cast<std::make_signed_t<Word>>(static_cast<Word>(value - expected));
  return static_cast<Word>(static_cast<Word>(difference << 1) ^
                           static_cast<Word>(difference >> (8 * sizeof(Word) - 1)));
}

template <class Word>
void put_bytes(const std::vector<Word>& words, std::vector<unsigned char>& out) {
  for (size_t byte = 0; byte < sizeof(Word); ++byte)
    for (const Word w : words) out.push_back(static_cast<unsigned char>(w >> (8 * byte)));
}

template <class Word>
void put_channel(const std::vector<float>& a, const std::vector<float>& b, PageNumbers numbers,
                 std::vector<unsigned char>& out) {
  const std::vector<Word> of_a = words_of<Word>(a, numbers);
  std::vector<Word> coded(of_a.size());
  for (size_t i = 0; i < coded.size(); ++i) coded[i] = zigzag<Word>(of_a[i], i > 0 ? of_a[i - 1] : Word{0});
  put_bytes(coded, out);
  const std::vector<Word> of_b = words_of<Word>(b, numbers);
  for (size_t i = 0; i < coded.size(); ++i) coded[i] = zigzag<Word>(of_b[i], of_a[i]);
  put_bytes(coded, out);
}

double display_value(double v, PairScale scale) {
  if (!(v > 0)) return 0;
  if (v >= 1) return 1;
  if (scale == PairScale::Display) return v;
  return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

unsigned char byte_of(double v) { return static_cast<unsigned char>(std::lround(255 * v)); }

DisplayPixels empty_thumbnail(const PicturePair& pair, int step) {
  return {(pair.width() + step - 1) / step, (pair.height() + step - 1) / step, 8, {}};
}

// JPEG blurs what is small.
std::string address_of(const DisplayPixels& pixels) {
  constexpr int kSmall = 20000;
  return pixels.width * pixels.height < kSmall ? png_address(pixels) : jpeg_address(pixels, 88);
}

// Of the numbers of B that are finite.
double mean_magnitude(const PicturePair& pair, const std::vector<size_t>& channels) {
  double sum = 0, count = 0;
  for (const size_t c : channels)
    for (const float v : pair.channels[c].b)
      if (std::isfinite(v)) {
        sum += std::abs(double{v});
        ++count;
      }
  return count > 0 ? sum / count : 0;
}

int step_to(int width, int most_width) { return std::max(1, (width + most_width - 1) / most_width); }

}  // namespace

std::string hex_text(const ColourMap& map) {
  std::string out;
  for (const ByteColour& c : map) out += fmt::format("{:02x}{:02x}{:02x}", c[0], c[1], c[2]);
  return out;
}

PageSize page_size(const PicturePair& pair) {
  PageSize size;
  const auto steps = [&](int of) { return (of + size.step - 1) / size.step; };
  const auto pixels = [&] {
    return static_cast<size_t>(steps(pair.width())) * static_cast<size_t>(steps(pair.height()));
  };
  while (pixels() > kPageMostPixels) ++size.step;
  size.width = steps(pair.width());
  size.height = steps(pair.height());
  return size;
}

PageLayer page_layer(const PicturePair& pair, const ComparedLayer& layer, const PageSize& size) {
  PageLayer out{layer.name, layer.kind, {}};
  std::vector<std::vector<float>> planes;
  In16Bits seen;
  for (const size_t c : layer.channels) {
    const ComparedChannel& channel = pair.channels[c];
    out.channels.push_back(channel.name);
    for (const std::vector<float>* plane : {&channel.a, &channel.b}) {
      planes.push_back(reduced(*plane, channel.kind, pair, size.step));
      look_at(planes.back(), seen);
    }
  }
  const bool few = !planes.empty() && planes[0].size() <= kPageFloatPixels;
  out.numbers = numbers_for(seen, few);
  out.rounded = out.numbers == PageNumbers::Half && !seen.halfs_exact;
  std::vector<unsigned char> bytes;
  for (size_t c = 0; c < planes.size(); c += 2) {
    if (out.numbers == PageNumbers::Float) put_channel<uint32_t>(planes[c], planes[c + 1], out.numbers, bytes);
    else put_channel<uint16_t>(planes[c], planes[c + 1], out.numbers, bytes);
  }
  out.data = base64(deflated(bytes));
  return out;
}

std::string page_map(std::span<const float> map, const PicturePair& pair, const PageSize& size) {
  std::vector<unsigned char> bytes;
  each_block(pair.width(), pair.height(), size.step, [&](const Block& block) {
    float most = 0;
    // NaN is as different as can be.
    each_pixel(block, pair.width(), [&](size_t i) { most = std::isnan(map[i]) ? 1 : std::max(most, map[i]); });
    bytes.push_back(byte_of(std::min(1.0, double{most})));
  });
  return base64(deflated(bytes));
}

std::string thumbnail(const PicturePair& pair, Side side, int most_width) {
  const std::vector<size_t> channels = shown_channels(pair);
  if (channels.empty()) return "";
  const int step = step_to(pair.width(), most_width);
  DisplayPixels pixels = empty_thumbnail(pair, step);
  each_block(pair.width(), pair.height(), step, [&](const Block& block) {
    for (size_t c = 0; c < 3; ++c) {
      const ComparedChannel& channel = pair.channels[channels[channels.size() < 3 ? 0 : c]];
      double sum = 0;
      each_pixel(block, pair.width(), [&](size_t i) {
        sum += display_value(double{(side == Side::A ? channel.a : channel.b)[i]}, pair.scale);
      });
      pixels.bytes.push_back(byte_of(sum / ((block.x1 - block.x0) * (block.y1 - block.y0))));
    }
  });
  return address_of(pixels);
}

std::string heat_thumbnail(const PicturePair& pair, int most_width) {
  const std::vector<size_t> channels = shown_channels(pair);
  const std::vector<float> difference = difference_of(pair, channels, HeatSign::Absolute);
  // Among rows of a table noise that nobody minds must not glow as faults do.
  const double full = std::max(heat_scale(difference), 0.1 * mean_magnitude(pair, channels));
  const int step = step_to(pair.width(), most_width);
  DisplayPixels pixels = empty_thumbnail(pair, step);
  // The largest of a block: a single pixel must not vanish. NaN is above all.
  each_block(pair.width(), pair.height(), step, [&](const Block& block) {
    double most = 0;
    each_pixel(block, pair.width(), [&](size_t i) {
      if (!(double{difference[i]} <= most)) most = double{difference[i]};
    });
    const ByteColour colour = heat_colour(most, HeatSign::Absolute, full);
    pixels.bytes.insert(pixels.bytes.end(), colour.begin(), colour.end());
  });
  return address_of(pixels);
}

}  // namespace whit
