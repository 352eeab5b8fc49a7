// The filters of PNG's rows, undone.
#pragma once

#include <cstddef>
#include <cstdint>

namespace whit {

/// Bytes behind both rows that must be there, whatever they are.
constexpr size_t kPngFilterReadsOn = 8;

/// Undoes filter `kind` (0 to 4) of a row of n bytes in place. `above` is the row above, undone, or zeros; `step` the bytes of
/// a pixel, at least 1. False when there is no such filter.
bool undo_png_filter(int kind, uint8_t* row, const uint8_t* above, size_t n, int step);

}  // namespace whit
