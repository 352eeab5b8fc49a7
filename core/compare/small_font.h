// Letters of 5 x 7 dots, for numbers beside pictures.
#pragma once

#include <array>
#include <string_view>

namespace whit {

/// A letter: rows from the top, the leftmost of five dots in bit 4.
using DotLetter = std::array<unsigned char, 7>;

/// Digits, signs and the few letters that scales are labelled with; what is not among them is blank.
DotLetter dot_letter(char letter);

/// Dots that a text is wide, a column between two letters.
constexpr int dot_width(std::string_view text) { return text.empty() ? 0 : 6 * static_cast<int>(text.size()) - 1; }

}  // namespace whit
