// What comparing two pictures comes to, as plain data, for every report to tell in its own way.
//
// A is the picture that is judged, B the reference. Pixels are those of the display window, (0, 0) upper left.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/vec.h"
#include "core/compare/pair.h"

namespace whit {

/// A number of a file that is none.
struct NonFinite {
  Side side;
  std::string channel;
  Vec2i at{0, 0};
  float value = 0;
};

/// What a measure came to.
struct Measured {
  std::string measure;            ///< A name of all_measures().
  std::string layer;              ///< "" is the picture itself.
  double value = 0;               ///< Infinite where there is no number.
  std::string channel;            ///< Which it was found in, where it was one.
  std::optional<Vec2i> at;        ///< Where, for what has a place: a pixel, the upper left one of a block.
  std::string words;              ///< What the number does not say: "mirrored left to right".
  std::optional<double> limit{};  ///< What it was held to, if anything.
};

/// A limit that does not hold.
struct Failure {
  std::string measure;  ///< A name of all_measures(), or "nonfinite", "exact", "noise", "hard-fail", "fail-pixels".
  std::string layer;
  double value = 0;  ///< On the wrong side of `limit`: for "ratio" the distance from 1.
  double limit = 0;
  std::string channel;
  std::optional<Vec2i> at;
  std::string words;
};

/// A part of the picture that differs by more than noise.
struct NoiseRegion {
  Box2i box{};        ///< Pixels, the maximum included.
  double change = 0;  ///< Of the mean of the region and channel that differs most: 0.01 is one per cent of B's.
  std::string channel;
  double p = 0;                      ///< After correction for all tests.
  std::vector<std::string> objects;  ///< What is there, the most first, where the files name it.
};

/// Whether two pictures can be renders of one scene.
struct NoiseVerdict {
  bool same = true;
  double p = 1;                      ///< Of the least likely block, after correction for all tests.
  double alpha = 0;                  ///< It differs when p is below.
  std::vector<NoiseRegion> regions;  ///< Least likely first, kRegionsKept at most.
  size_t region_count = 0;           ///< All of them.
  bool estimated = false;            ///< The files do not say how noisy they are.
  std::string how;                   ///< Where the noise was taken from, in a sentence.
  double untested = 0;               ///< Share of the pixels of which nothing can be said.
};

struct Comparison {
  std::string a_path, b_path;
  std::string cannot;                ///< Why the two cannot be compared; then there is nothing else.
  Box2i window{};                    ///< The pixels compared, the maximum included,
  Box2i a_window{}, b_window{};      ///< and those that the files have.
  int width = 0, height = 0;         ///< Of the pixels compared.
  std::vector<std::string> layers;   ///< As ComparedLayer names them.
  std::vector<std::string> notes;    ///< What was made alike first, in sentences.
  std::vector<NonFinite> nonfinite;  ///< The first kNonFiniteKept of them.
  int64_t nonfinite_count = 0;
  int64_t differing_pixels = 0;  ///< With a channel that is not equal.
  std::vector<Measured> measured;
  std::optional<NoiseVerdict> noise;
  std::vector<Failure> failed;  ///< The worst first.

  bool same() const { return cannot.empty() && failed.empty(); }
  /// What a measure came to; null where it was not measured.
  const Measured* find(const std::string& measure, const std::string& layer = "") const;
  /// The failure of a measure's limit; null where it holds.
  const Failure* failure_of(const Measured& measured) const;
};

inline constexpr size_t kNonFiniteKept = 100, kRegionsKept = 200;

/// How bad it is, to sort by: cannot be compared above all, then the largest value over its limit; 0 to 1 when same.
double badness(const Comparison& comparison);

/// What a limit is compared with: the larger the worse, for measures that do not fall.
double deviation(const Measured& measured);

/// By how many times a failure is beyond its limit, 1 and more.
double times_over(const Failure& failure);

/// "p = 0.0012"; of what is too small for a number "p < 1e-300".
std::string p_text(double p);

/// "relmse_robust 0.031 is above 0.02 in layer Albedo at (12, 40)".
std::string failure_text(const Failure& failure);

/// "same: every number is equal", "differs: " with the worst failure, "cannot compare: " with the reason. One line.
std::string verdict_text(const Comparison& comparison);

}  // namespace whit
