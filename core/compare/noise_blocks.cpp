#include "core/compare/noise_blocks.h"

#include <algorithm>

namespace whit {
namespace {

// Blocks of one size in cells, at steps.
struct Level {
  int size = 1, step = 1;
  int across = 0, down = 0;
  std::span<const BlockSums> blocks;
};

// Of four neighbours: a block and those that begin `stride` further. Their sums are left in `blocks`.
Level twice_as_large(const Level& from, std::vector<BlockSums>& blocks) {
  const bool cells = from.size == 1;
  const int stride = cells ? 1 : 2, ratio = cells ? 1 : 2;
  Level to{2 * from.size, cells ? 1 : 2 * from.step, 0, 0, {}};
  to.across = (from.across - stride - 1) / ratio + 1;
  to.down = (from.down - stride - 1) / ratio + 1;
  const auto at = [&](int x, int y) -> const BlockSums& {
    return from.blocks[static_cast<size_t>(y) * static_cast<size_t>(from.across) + static_cast<size_t>(x)];
  };
  blocks.reserve(static_cast<size_t>(to.across) * static_cast<size_t>(to.down));
  for (int y = 0; y < to.down; ++y)
    for (int x = 0; x < to.across; ++x) {
      BlockSums sums = at(ratio * x, ratio * y);
      sums += at(ratio * x + stride, ratio * y);
      sums += at(ratio * x, ratio * y + stride);
      sums += at(ratio * x + stride, ratio * y + stride);
      blocks.push_back(sums);
    }
  return to;
}

bool can_grow(const Level& level) {
  const int stride = level.size == 1 ? 1 : 2;
  return level.across > stride && level.down > stride;
}

class Tester {
 public:
  Tester(size_t channel, const JudgeBlock& judge, double below, BlockTests& tests)
      : channel_(channel), judge_(judge), below_(below), tests_(tests) {}

  void test(const BlockSums& sums, const Box2i& cells) {
    if (sums.pixels == 0) return;
    const BlockAnswer answer = judge_(sums, below_);
    tests_.count += answer.tests;
    if (answer.p < below_) tests_.unlikely.push_back({cells, channel_, answer.p});
  }

 private:
  size_t channel_;
  const JudgeBlock& judge_;
  double below_;
  BlockTests& tests_;
};

}  // namespace

BlockSums& BlockSums::operator+=(const BlockSums& o) {
  pixels += o.pixels, difference += o.difference, squares += o.squares, beyond += o.beyond;
  reference += o.reference;
  variance_a += o.variance_a, variance_b += o.variance_b, variance_squares += o.variance_squares;
  tolerance += o.tolerance;
  return *this;
}

void test_blocks(const CellGrid& grid, size_t channel, const JudgeBlock& judge, double below, BlockTests& tests) {
  Tester tester(channel, judge, below, tests);
  BlockSums all;
  for (const BlockSums& cell : grid.cells) all += cell;
  const auto test_level = [&](const Level& level) {
    size_t i = 0;
    for (int y = 0; y < level.down; ++y)
      for (int x = 0; x < level.across; ++x) {
        const Vec2i first(x * level.step, y * level.step), last = first + Vec2i(level.size - 1, level.size - 1);
        tester.test(level.blocks[i++], {first, last});
      }
  };
  // The first level's blocks are the cells themselves, which are not copied.
  std::vector<BlockSums> made;
  for (Level level{1, 1, grid.across, grid.down, grid.cells};;) {
    test_level(level);
    if (!can_grow(level)) break;
    std::vector<BlockSums> larger;
    level = twice_as_large(level, larger);
    made = std::move(larger);
    level.blocks = made;
  }
  tester.test(all, {{0, 0}, {grid.across - 1, grid.down - 1}});
}

}  // namespace whit
