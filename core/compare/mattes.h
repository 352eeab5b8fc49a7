// The names of what is in a picture's pixels, where its file has a cryptomatte.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/compare/pair.h"

namespace whit {

/// A cryptomatte of the pair: what covers most of each pixel, by numbers from 0.
struct Matte {
  std::vector<std::string> names;  ///< Of each number.
  std::vector<int> pixels;         ///< The number, -1 for nothing or where the two pictures disagree.
};

/// The first of the pair's cryptomattes for objects, shapes or, without such, materials (specification 1.2); none
/// where there is none.
std::optional<Matte> find_matte(const PicturePair& pair);

}  // namespace whit
