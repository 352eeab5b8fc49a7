// Is it only noise? Whether two pictures can be renders of one scene with different seeds.
//
// Blocks of several sizes are tested one by one (Welch 1947), and the test of many is corrected for (Holm 1979);
// docs/diff.md derives it and says what it cannot see.
#pragma once

#include "core/compare/comparison.h"
#include "core/compare/pair.h"

namespace whit {

/// Tests the beauty of a pair. The variances are those of the files (`--aov variance`), else what the difference of the
/// two says of itself. `alpha` in (0,1).
NoiseVerdict test_noise(const PicturePair& pair, double alpha);

}  // namespace whit
