// What blocks of a picture say of the difference of two: sums over cells, and tests of blocks of many sizes.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/base/vec.h"

namespace whit {

/// A side of the smallest blocks, in pixels. A pixel by itself says little: its variance has few degrees of freedom.
inline constexpr int kNoiseCell = 4;

/// Sums over the pixels of a block that can be tested, one channel. Add up.
struct BlockSums {
  double pixels = 0;
  double difference = 0;                  ///< Of a - b,
  double squares = 0;                     ///< of its square,
  double beyond = 0;                      ///< and of the square of what of it is beyond rounding.
  double reference = 0;                   ///< Of b.
  double variance_a = 0, variance_b = 0;  ///< Of the pixels' means, as the files know it.
  double variance_squares = 0;            ///< Of the squares of these variances.
  double tolerance = 0;                   ///< |a - b| that is no difference: what the files' numbers are rounded by.
  BlockSums& operator+=(const BlockSums& o);
};

/// The sums of all cells of a channel, row by row.
struct CellGrid {
  int across = 0, down = 0;
  std::vector<BlockSums> cells;
};

/// What is said of a block: how likely it is, or something further off, with noise alone. What has nothing to say says 1.
struct BlockAnswer {
  double p = 1;
  int tests = 0;  ///< That it is the least of.
};
/// Does not look closer where p is above `below`.
using JudgeBlock = std::function<BlockAnswer(const BlockSums& sums, double below)>;

/// A block that was tested.
struct TestedBlock {
  Box2i cells{};  ///< The maximum included.
  size_t channel = 0;
  double p = 1;  ///< Of this test alone.
};

struct BlockTests {
  double count = 0;                   ///< Of tests.
  std::vector<TestedBlock> unlikely;  ///< Those whose p is below what was asked for, in a fixed order.
};

/// Tests each cell, blocks of 2 x 2, 4 x 4 ... cells at steps of half their size, and the whole. Keeps those whose p is below
/// `below`.
void test_blocks(const CellGrid& grid, size_t channel, const JudgeBlock& judge, double below, BlockTests& tests);

}  // namespace whit
