// Sorting lanes by material: by key, equal keys in their old order, whatever the size of the keys.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/batch/sort.h"

namespace whit {
namespace {

std::vector<int32_t> sorted(const std::vector<int32_t>& keys, std::vector<int32_t> lanes) {
  Arena arena;
  sort_lanes(keys.data(), static_cast<int>(lanes.size()), lanes.data(), arena);
  return lanes;
}

TEST(SortLanes, SmallCases) {
  EXPECT_EQ(sorted({}, {}), (std::vector<int32_t>{}));
  EXPECT_EQ(sorted({5}, {0}), (std::vector<int32_t>{0}));
  EXPECT_EQ(sorted({2, 1, 2, 0}, {0, 1, 2, 3}), (std::vector<int32_t>{3, 1, 0, 2}));
  // Only some lanes, in an order of their own, which equal keys keep.
  EXPECT_EQ(sorted({1, 9, 1, 0, 1}, {4, 0, 3, 2}), (std::vector<int32_t>{3, 4, 0, 2}));
  EXPECT_EQ(sorted({7, 7, 7}, {2, 0, 1}), (std::vector<int32_t>{2, 0, 1}));
}

TEST(SortLanes, StableForKeysOfEverySize) {
  std::mt19937 random(1);
  for (const int32_t largest : {1, 3, 255, 256, 70000, 1 << 24, 0x7fffffff}) {
    std::vector<int32_t> keys(3000), lanes(2000);
    for (int32_t& k : keys) k = std::uniform_int_distribution<int32_t>(0, largest)(random);
    std::vector<int32_t> all(keys.size());
    for (size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int32_t>(i);
    std::shuffle(all.begin(), all.end(), random);
    std::copy_n(all.begin(), lanes.size(), lanes.begin());
    std::vector<int32_t> expected = lanes;
    std::stable_sort(expected.begin(), expected.end(),
                     [&](int32_t a, int32_t b) { return keys[static_cast<size_t>(a)] < keys[static_cast<size_t>(b)]; });
    EXPECT_EQ(sorted(keys, lanes), expected) << "keys up to " << largest;
  }
}

TEST(SortLanes, KeysThatDifferInOneByteOnly) {
  // 0x10000 and 0x20000 differ in the third byte; the others need no pass, an odd number of passes ends in the scratch.
  EXPECT_EQ(sorted({0x20005, 0x10005, 0x20005, 0x10005}, {0, 1, 2, 3}), (std::vector<int32_t>{1, 3, 0, 2}));
  EXPECT_EQ(sorted({0x201, 0x102, 0x101, 0x202}, {0, 1, 2, 3}), (std::vector<int32_t>{2, 1, 0, 3}));
}

}  // namespace
}  // namespace whit
