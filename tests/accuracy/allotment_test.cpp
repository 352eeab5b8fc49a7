// Where samples go.

#include "core/accuracy/allotment.h"

#include <gtest/gtest.h>

namespace whit {
namespace {

TEST(Allot, IsInProportionToTheRootOfTheVariance) {
  const Allotment parts[] = {{1, 1, 1}, {1, 9, 1}, {2, 18, 1}};
  // n = s sqrt(variance / area): s, 3 s and 3 s. Their sum of variance / n is (1 + 3 + 6) / s.
  const std::vector<double> n = allot(parts, 0.1, 1e9);
  EXPECT_NEAR(n[0], 100, 1e-6);
  EXPECT_NEAR(n[1], 300, 1e-6);
  EXPECT_NEAR(n[2], 300, 1e-6);
}

TEST(Allot, TakesNoneAwayAndKeepsToTheMost) {
  // The root of the first's variance is a thousandth of the second's: at the second's 1000 samples it wants one.
  const Allotment parts[] = {{1, 0.0001, 64}, {1, 100, 64}, {1, 0, 64}};
  const std::vector<double> n = allot(parts, 0.0001 / 64 + 0.1, 1e9);
  EXPECT_EQ(n[0], 64);
  EXPECT_NEAR(n[1], 1000, 1e-6);
  EXPECT_EQ(n[2], 64);
  EXPECT_EQ(allot(parts, 1e-9, 128)[1], 128);
}

TEST(NextSamples, DoublesWhereTheTargetIsFar) {
  // At a sum of 0.1 the second part wants 1000 samples, the first one.
  const Allotment parts[] = {{1, 0.0001, 64}, {1, 100, 64}};
  EXPECT_EQ(next_samples(parts, 0.1, 1 << 16, 64), (std::vector<uint32_t>{64, 128}));
  // With 100 at most the sum cannot be reached: whatever helps is done.
  EXPECT_EQ(next_samples(parts, 0.1, 100, 64), (std::vector<uint32_t>{100, 100}));
}

TEST(NextSamples, DoublesNoMorePartsThanItTakesWhereTheTargetIsNear) {
  // Four alike with a sum of 4 / 64. A tenth less takes 1.11 times the samples of each, or twice those of one of them, which
  // takes an eighth of the sum away.
  const Allotment parts[] = {{1, 1, 64}, {1, 1, 64}, {1, 1, 64}, {1, 1, 64}};
  EXPECT_EQ(next_samples(parts, 0.9 * 4 / 64, 1 << 16, 64), (std::vector<uint32_t>{128, 64, 64, 64}));
}

TEST(NextSamples, LetsQuietPartsFollow) {
  const Allotment parts[] = {{1, 0, 4}, {1, 100, 256}};
  // A 32nd of 512 is 16: the quiet part is on its way there. Beyond `follow` it need not go.
  EXPECT_EQ(next_samples(parts, 0.01, 1 << 16, 64), (std::vector<uint32_t>{8, 512}));
  EXPECT_EQ(next_samples(parts, 0.01, 1 << 16, 4), (std::vector<uint32_t>{4, 512}));
}

}  // namespace
}  // namespace whit
