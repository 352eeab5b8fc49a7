#include "core/compare/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/compare/layer_measures.h"
#include "core/compare/measures.h"
#include "core/compare/noise.h"

namespace whit {
namespace {

void find_nonfinite(const PicturePair& pair, const ComparedChannel& channel, Side side, Comparison& result) {
  const std::vector<float>& plane = side == Side::A ? channel.a : channel.b;
  if (all_finite(plane)) return;
  for (size_t i = 0; i < plane.size(); ++i) {
    if (!is_fault(channel.name, pair.a.channel_names, plane[i])) continue;
    if (result.nonfinite.size() < kNonFiniteKept)
      result.nonfinite.push_back({side, channel.name, pair.place(i), plane[i]});
    ++result.nonfinite_count;
  }
}

std::vector<std::string> slow_ones(const CompareRequest& request) {
  std::vector<std::string> slow = request.slow;
  for (const auto& [name, limit] : request.limits.of) slow.push_back(name);
  return slow;
}

void note_statistics(const PicturePair& pair, Comparison& result) {
  std::string names;
  for (const ComparedChannel& channel : pair.channels) {
    const bool compared = std::any_of(pair.layers.begin(), pair.layers.end(), [&](const ComparedLayer& layer) {
      return std::any_of(layer.channels.begin(), layer.channels.end(),
                         [&](size_t c) { return &pair.channels[c] == &channel; });
    });
    if (channel.kind == ChannelKind::Statistic && !compared)
      names.append(names.empty() ? "" : ", ").append(channel.name);
  }
  if (!names.empty()) result.notes.push_back(names + ": statistics of samples, not compared");
}

// A limit that is asked for and that nothing was measured for would always hold. Most measures are of some layers alone, but
// these are of all pictures with colours.
std::string unmeasured_limit(const PicturePair& pair, const Limits& limits) {
  if (pair.beauty()) return "";
  for (const char* name : {"ratio", "shift", "ssim", "flip"})
    if (const auto limit = limits.of.find(name); limit != limits.of.end() && std::isfinite(limit->second))
      return fmt::format("there is a limit of {}, and no layer of colours to measure it of", name);
  return "";
}

// "a.exr is denoised (OpenImageDenoise 1.4.3)", of those that are.
std::vector<std::string> denoised_ones(const PicturePair& pair) {
  std::vector<std::string> sentences;
  for (const auto& [path, info] : {std::pair(&pair.a_path, &pair.a), {&pair.b_path, &pair.b}}) {
    if (const auto by = info->metadata.find("whit:denoised"); by != info->metadata.end())
      sentences.push_back(fmt::format("{} is denoised ({})", *path, by->second));
  }
  return sentences;
}

// A test of noise takes errors for independent and without bias.
std::string denoised_under_test(const PicturePair& pair, const Limits& limits) {
  const std::vector<std::string> ones = denoised_ones(pair);
  if (ones.empty() || !limits.noise || limits.exact) return "";
  return ones.front() +
         ": it is biased, and its errors are no noise that could be tested; compare the picture that it was "
         "made of, or without --noise";
}

}  // namespace

Comparison compare_pair(const PicturePair& pair, const CompareRequest& request) {
  Comparison result;
  result.a_path = pair.a_path;
  result.b_path = pair.b_path;
  result.cannot = unmeasured_limit(pair, request.limits);
  if (result.cannot.empty()) result.cannot = denoised_under_test(pair, request.limits);
  if (!result.cannot.empty()) return result;
  result.window = pair.window;
  result.a_window = data_window(pair.a);
  result.b_window = data_window(pair.b);
  result.width = pair.width();
  result.height = pair.height();
  result.notes = pair.notes;
  note_statistics(pair, result);
  for (const std::string& one : denoised_ones(pair))
    result.notes.push_back(one + ": it is biased, which more samples need not make less");
  for (const ComparedLayer& layer : pair.layers) {
    result.layers.push_back(layer.name);
    for (const size_t c : layer.channels)
      for (const Side side : {Side::A, Side::B}) find_nonfinite(pair, pair.channels[c], side, result);
  }
  result.differing_pixels = measure_pair(pair, slow_ones(request), result.measured);
  if (request.limits.noise && !request.limits.exact) result.noise = test_noise(pair, request.limits.alpha);
  judge(pair, request.limits, result);
  return result;
}

Comparison compare_files(const std::string& a, const std::string& b, const CompareRequest& request, PicturePair* keep) {
  PairRequest reading = request.pair;
  reading.statistics |= request.limits.exact;
  Result<PicturePair> pair = read_pair(a, b, reading);
  if (!pair.ok()) {
    Comparison result;
    result.a_path = a;
    result.b_path = b;
    result.cannot = pair.error;
    return result;
  }
  Comparison result = compare_pair(pair.value, request);
  if (keep) *keep = std::move(pair.value);
  return result;
}

}  // namespace whit
