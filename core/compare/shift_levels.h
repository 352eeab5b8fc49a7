// Two pictures at several sizes, made alike, to look for displacements in.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace whit {

/// A picture whose numbers are taken times `scale`, kept within `bound` of 0, then times `gain` and plus `offset`.
struct ShiftView {
  int width = 0, height = 0;
  std::span<const float> numbers;
  float scale = 1, bound = std::numeric_limits<float>::infinity(), gain = 1, offset = 0;

  size_t pixels() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
  /// Of `n` pixels from (x, y) on.
  void load(int x, int y, size_t n, float* to) const;
};

/// The same with memory of its own.
struct ShiftPlane {
  int width = 0, height = 0;
  std::vector<float> v;
  const float* row(int y) const { return &v[static_cast<size_t>(y) * static_cast<size_t>(width)]; }
};

ShiftPlane plane_of(const ShiftView& view, int x, int y, int width, int height);

/// Means of blocks of size x size pixels, the first of which begins at (x, y).
ShiftPlane reduced(const ShiftView& view, int size, int x = 0, int y = 0);

struct ShiftLevel {
  int size = 1;  ///< Pixels that one of this level's is wide.
  ShiftView out, ref;
};

/// The two pictures and smaller ones, each half as wide as the one before.
class ShiftLevels {
 public:
  /// Until a level has at most `pixels`, or half of it would be too small to look at.
  ShiftLevels(std::span<const float> out, std::span<const float> ref, int width, int height, size_t pixels);

  /// True when there is more than rounding between the two, and a displacement could be told.
  bool differ() const { return differ_; }
  const std::vector<ShiftLevel>& levels() const { return levels_; }

 private:
  void match(ShiftLevel& level);

  bool differ_ = false;
  std::vector<ShiftLevel> levels_;
  std::vector<ShiftPlane> memory_;
};

}  // namespace whit
