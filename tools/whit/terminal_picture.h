// Pictures for terminals: as text with colours, or by the protocols that some know.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace whit {

/// Red, green and blue of each pixel, row by row.
struct TerminalPicture {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;
};

/// The mean colours of the picture in other pixels; of equal sizes it stays as it is.
TerminalPicture resampled(const TerminalPicture& picture, int width, int height);

/// Half blocks: two rows of pixels in a line of text.
std::string as_blocks(const TerminalPicture& picture);
/// The protocol of kitty's.
std::string as_kitty(const TerminalPicture& picture);
/// Sixels, of 216 colours.
std::string as_sixels(const TerminalPicture& picture);

}  // namespace whit
