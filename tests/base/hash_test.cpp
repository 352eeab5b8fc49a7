// Hashes and radical inverses: bijections, ranges, bit statistics.
#include "core/base/hash.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/base/radical_inverse.h"

namespace whit {
namespace {

TEST(Hash, Mix32ChangesEveryBitHalfTheTime) {
  // Over 20000 inputs a bit flips 10000 +- 71 times; the worst of 1024 pairs stays within 5.5 deviations.
  constexpr int kInputs = 20000;
  double worst = 0;
  for (int in = 0; in < 32; ++in) {
    int flips[32] = {};
    for (uint32_t i = 0; i < kInputs; ++i) {
      const uint32_t x = i * 0x9e3779b9u, change = mix32(x) ^ mix32(x ^ (1u << in));
      for (int out = 0; out < 32; ++out) flips[out] += (change >> out) & 1;
    }
    for (const int f : flips) worst = std::max(worst, std::abs(f - kInputs / 2) / std::sqrt(kInputs / 4.0));
  }
  EXPECT_LT(worst, 5.5);
}

TEST(Hash, UnitFloatStaysBelowOne) {
  EXPECT_EQ(unit_float(0), 0);
  EXPECT_EQ(unit_float(0xffffffffu), 0x1.fffffep-1f);
  EXPECT_EQ(unit_float(0x80000000u), 0.5f);
}

TEST(Hash, CombineKeepsWordsAndOrderApart) {
  std::set<uint32_t> seen;
  for (uint32_t a = 0; a < 100; ++a) {
    for (uint32_t b = 0; b < 100; ++b) seen.insert(hash_combine(hash_combine(0, a), b));
  }
  EXPECT_EQ(seen.size(), 10000u);
}

TEST(RadicalInverse, ReverseBits) {
  EXPECT_EQ(reverse_bits(1), 0x80000000u);
  EXPECT_EQ(reverse_bits(0x12345678u), 0x1e6a2c48u);
}

TEST(RadicalInverse, PermutationsAreBijections) {
  for (const int bits : {1, 2, 3, 5, 8, 11}) {
    for (uint32_t key = 0; key < 20; ++key) {
      std::set<uint32_t> images;
      for (uint32_t x = 0; x < 1u << bits; ++x) images.insert(permute_bits(x, bits, mix32(key + 1)));
      EXPECT_EQ(images.size(), size_t{1} << bits);
      EXPECT_LT(*images.rbegin(), 1u << bits);
    }
  }
}

TEST(RadicalInverse, NestedShufflesKeepAlignedBlocks) {
  // 2^m numbers from a multiple of 2^m on go to others of that kind, one to one. Which half of eight numbers 5 goes to is
  // as often the one as the other over 16000 keys, +- 63.
  int upper = 0;
  for (uint32_t key = 0; key < 16000; ++key) {
    const uint32_t k = mix32(key + 1);
    upper += static_cast<int>((shuffle_nested(5, k) >> 2) & 1u);
    if (key >= 50) continue;
    for (const int m : {0, 1, 3, 7}) {
      for (const uint32_t block : {0u, 1u, 6u, 0xffffffffu >> m}) {
        std::set<uint32_t> images, blocks;
        for (uint32_t i = 0; i < 1u << m; ++i) {
          const uint32_t image = shuffle_nested((block << m) + i, k);
          images.insert(image), blocks.insert(image >> m);
        }
        EXPECT_EQ(images.size(), size_t{1} << m);
        EXPECT_EQ(blocks.size(), 1u);
      }
    }
  }
  EXPECT_NEAR(upper, 8000, 5 * 63);
}

TEST(RadicalInverse, PermutationsAreManyAndEven) {
  // How often x goes to y over 16000 keys, for 16 numbers: 1000 +- 31 each. 256 cells, chi squared with 225 degrees
  // of freedom (mean 225, deviation 21).
  std::vector<double> count(256);
  for (uint32_t key = 0; key < 16000; ++key) {
    for (uint32_t x = 0; x < 16; ++x) ++count[16 * x + permute_bits(x, 4, mix32(key + 7))];
  }
  double chi2 = 0;
  for (const double c : count) chi2 += (c - 1000) * (c - 1000) / 1000;
  EXPECT_LT(chi2, 225 + 6 * 21);
}

TEST(RadicalInverse, Base3DigitsDivideExactly) {
  // The quotient must be exact over the whole range: digits put back together give the index.
  for (uint32_t i = 0; i < 1u << 22; i += 1 + i / 1000) {
    uint32_t index = i, key = 0, value = 0;
    owen_base3_digit(index, key, value);
    EXPECT_EQ(index, i / 3);
    EXPECT_LT(value, 3u);
  }
  uint32_t last = (1u << 22) - 1, key = 5, value = 0;
  owen_base3_digit(last, key, value);
  EXPECT_EQ(last, ((1u << 22) - 1) / 3);
}

TEST(RadicalInverse, DigitCounts) {
  EXPECT_EQ(base3_digits(1), 1);
  EXPECT_EQ(base3_digits(3), 1);
  EXPECT_EQ(base3_digits(4), 2);
  EXPECT_EQ(base3_digits(81), 4);
  EXPECT_EQ(base3_digits(82), 5);
  EXPECT_EQ(bits_below(1), 1);
  EXPECT_EQ(bits_below(2), 1);
  EXPECT_EQ(bits_below(3), 2);
  EXPECT_EQ(bits_below(64), 6);
  EXPECT_EQ(bits_below(65), 7);
}

}  // namespace
}  // namespace whit
