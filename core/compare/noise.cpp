#include "core/compare/noise.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/compare/mattes.h"
#include "core/compare/noise_cells.h"
#include "core/compare/noise_regions.h"
#include "core/compare/noise_tests.h"

namespace whit {
namespace {

// Holm's correction: the k-th least likely of m has m - k others beside it. Keeps what is below `alpha`.
std::vector<TestedBlock> unlikely_of(BlockTests tests, double alpha, double& least) {
  std::vector<TestedBlock> sorted = std::move(tests.unlikely);
  std::stable_sort(sorted.begin(), sorted.end(), [](auto& l, auto& r) { return l.p < r.p; });
  double so_far = 0;
  size_t kept = 0;
  for (; kept < sorted.size(); ++kept) {
    so_far = std::max(so_far, std::min(1.0, sorted[kept].p * (tests.count - static_cast<double>(kept))));
    if (kept == 0) least = so_far;
    if (!(so_far < alpha)) break;
    sorted[kept].p = so_far;
  }
  sorted.resize(kept);
  return sorted;
}

std::string how_text(const NoiseModel& model) {
  if (model.known)
    return fmt::format(
        "by the variances in the files ({:g} degrees of freedom for a pixel, noise reaching over {:.3g} "
        "pixels)",
        model.freedom, model.area);
  std::string text = "estimated: by how the difference spreads within blocks, as the files have no variances of both";
  if (model.samples_a != model.samples_b)
    text += "; they have different numbers of samples, which this cannot allow for";
  return text;
}

// All that is asked of a pair.
struct Tests {
  std::vector<CellGrid> grids;
  std::vector<std::string> names;
  BlockTests blocks;
  double tested = 0;  ///< Numbers.
};

Tests test_all(const PicturePair& pair, const std::vector<TestedChannel>& channels, const NoiseModel& model,
               double alpha) {
  Tests all;
  all.grids.resize(channels.size());
  std::vector<BlockTests> by_channel(channels.size());
  tbb::parallel_for(size_t{0}, channels.size(), [&](size_t c) {
    const TestedChannel& one = channels[c];
    all.grids[c] = make_grid(pair, one, model);
    const JudgeBlock judge = [&](const BlockSums& sums, double below) {
      return one.variance ? known_test(sums, model, one.area, below) : paired_test(sums, one.area, below);
    };
    test_blocks(all.grids[c], c, judge, alpha, by_channel[c]);
  });
  for (size_t c = 0; c < channels.size(); ++c) {
    BlockTests& tests = by_channel[c];
    all.names.push_back(channels[c].channel->name);
    all.blocks.count += tests.count;
    all.blocks.unlikely.insert(all.blocks.unlikely.end(), tests.unlikely.begin(), tests.unlikely.end());
    if (tests.count > 0)
      for (const BlockSums& cell : all.grids[c].cells) all.tested += cell.pixels;
    tests = {};
  }
  return all;
}

// Numbers of the channels that are tested, each once.
double numbers_of(const PicturePair& pair, const std::vector<TestedChannel>& channels) {
  const auto once = std::count_if(channels.begin(), channels.end(), [](auto& one) { return one.unknown == nullptr; });
  return static_cast<double>(pair.pixels()) * static_cast<double>(once);
}

}  // namespace

NoiseVerdict test_noise(const PicturePair& pair, double alpha) {
  constexpr double kEnough = 0.5;
  const NoiseModel model = noise_model(pair);
  const std::vector<TestedChannel> channels = tested_channels(pair, model);
  Tests tests = test_all(pair, channels, model, alpha);
  NoiseVerdict verdict;
  verdict.alpha = alpha;
  verdict.estimated = !model.known;
  verdict.how = how_text(model);
  const double numbers = numbers_of(pair, channels);
  verdict.untested = numbers > 0 ? std::max(0.0, 1 - tests.tested / numbers) : 0;
  const std::vector<TestedBlock> unlikely = unlikely_of(std::move(tests.blocks), alpha, verdict.p);
  verdict.same = unlikely.empty() && verdict.untested <= kEnough;
  if (unlikely.empty() && !verdict.same) verdict.how += "; too little can be tested to call it noise";
  if (unlikely.empty()) return verdict;
  verdict.regions = join_regions(pair, tests.grids, tests.names, unlikely, find_matte(pair));
  verdict.region_count = verdict.regions.size();
  verdict.regions.resize(std::min(verdict.regions.size(), kRegionsKept));
  return verdict;
}

}  // namespace whit
