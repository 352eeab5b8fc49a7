// Source: Portable Network Graphics (PNG) Specification, 2nd ed., W3C 2003, 9.
//
// Filters are slow because each pixel waits for the one on its left. So a pixel is a vector of its bytes, and what does not
// depend on the left is done before.
#include "core/image/png_filter.h"

#include <bit>
#include <cstring>

namespace whit {
namespace {

// The bytes of a pixel, widened so that their differences fit (vectors are an extension of GCC and Clang).
using Pixel = int16_t __attribute__((vector_size(16)));
using Bytes = uint8_t __attribute__((vector_size(8)));

// Through a register, though pixels of three bytes read a fourth: pieces put together in memory would be waited for.
template <int kStep>
Pixel load(const uint8_t* from) {
  uint64_t bits = 0;
  std::memcpy(&bits, from, kStep <= 4 ? 4 : 8);
  return __builtin_convertvector(std::bit_cast<Bytes>(bits), Pixel);
}

// Numbers modulo 256.
template <int kStep>
Pixel store(uint8_t* to, Pixel p) {
  p &= 0xff;
  const auto bits = std::bit_cast<uint64_t>(__builtin_convertvector(p, Bytes));
  std::memcpy(to, &bits, kStep);
  return p;
}

Pixel magnitude(Pixel p) { return p > 0 ? p : -p; }

// Which of left, above and above left is nearest to left + above - above left.
Pixel nearest(Pixel left, Pixel above, Pixel corner, Pixel above_less_corner) {
  const Pixel left_less_corner = left - corner;
  const Pixel to_left = magnitude(above_less_corner), to_above = magnitude(left_less_corner);
  const Pixel to_corner = magnitude(above_less_corner + left_less_corner);
  const Pixel other = to_above <= to_corner ? above : corner;
  return ((to_left <= to_above) & (to_left <= to_corner)) ? left : other;
}

// Adds to each pixel what predict(left, above, above left) is.
template <int kStep, class Predict>
void add_prediction(uint8_t* row, const uint8_t* above, size_t n, const Predict& predict) {
  Pixel left{}, corner{};
  for (size_t i = 0; i + kStep <= n; i += kStep) {
    const Pixel up = load<kStep>(above + i);
    left = store<kStep>(row + i, load<kStep>(row + i) + predict(left, up, corner));
    corner = up;
  }
}

template <int kStep>
bool undo(int kind, uint8_t* row, const uint8_t* above, size_t n) {
  switch (kind) {
    case 0: return true;
    case 1: add_prediction<kStep>(row, above, n, [](Pixel left, Pixel, Pixel) { return left; }); return true;
    case 2:
      for (size_t i = 0; i < n; ++i) row[i] = static_cast<uint8_t>(row[i] + above[i]);
      return true;
    case 3:
      add_prediction<kStep>(row, above, n, [](Pixel left, Pixel up, Pixel) { return (left + up) >> 1; });
      return true;
    case 4:
      add_prediction<kStep>(row, above, n,
                            [](Pixel left, Pixel up, Pixel corner) { return nearest(left, up, corner, up - corner); });
      return true;
    default: return false;
  }
}

}  // namespace

bool undo_png_filter(int kind, uint8_t* row, const uint8_t* above, size_t n, int step) {
  switch (step) {
    case 1: return undo<1>(kind, row, above, n);
    case 2: return undo<2>(kind, row, above, n);
    case 3: return undo<3>(kind, row, above, n);
    case 4: return undo<4>(kind, row, above, n);
    case 6: return undo<6>(kind, row, above, n);
    default: return undo<8>(kind, row, above, n);
  }
}

}  // namespace whit
