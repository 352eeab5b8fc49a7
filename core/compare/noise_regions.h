// From unlikely blocks to regions that a person can look at.
#pragma once

#include <optional>
#include <vector>

#include "core/compare/comparison.h"
#include "core/compare/mattes.h"
#include "core/compare/noise_blocks.h"

namespace whit {

/// Joins blocks, of which the smallest say best where something is, to regions. `grids`: by channel, `channels` their names;
/// p of the blocks is that after correction.
std::vector<NoiseRegion> join_regions(const PicturePair& pair, const std::vector<CellGrid>& grids,
                                      const std::vector<std::string>& channels, std::vector<TestedBlock> blocks,
                                      const std::optional<Matte>& matte);

}  // namespace whit
