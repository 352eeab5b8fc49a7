#include "core/compare/shift.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>
#include <vector>

#include "core/compare/shift_fit.h"
#include "core/compare/shift_levels.h"
#include "core/compare/shift_search.h"

namespace whit {
namespace {

// What a hypothesis must score to be believed. The best of all that are tried on independent noise comes to 2.
constexpr double kBelieved = 2.4;

// Near none there are few hypotheses to be right by chance. There it says more that the cells agree on how far, to which
// noise comes to 6 standard deviations in one of a thousand. So it does that next to nothing is left, but of less than half
// a pixel, which smooth pictures say too easily.
bool believed(const ShiftFit& fit) {
  const ShiftScore& score = fit.score;
  if (score.value() >= kBelieved) return true;
  if (std::abs(fit.by.x) >= 1.5 || std::abs(fit.by.y) >= 1.5 || score.left >= 1) return false;
  return (score.gains >= 2 && fit.certainty >= 6.5) ||
         (score.gains >= 1.5 && score.left < 0.05 && std::hypot(fit.by.x, fit.by.y) > 0.5);
}

// Less is no displacement that anybody would look for: filters and samplers differ by as much.
constexpr double kLeast = 0.04;
// Levels have at most so many pixels when all displacements are tried.
constexpr size_t kSearched = 40000;
constexpr size_t kEnough = 500000;

// As far as there is time for, and 16 pixels of the picture at least.
ShiftMap search(const ShiftLevel& level) {
  constexpr double kWork = 1.5e7;
  const double pixels = static_cast<double>(level.ref.pixels());
  const int wanted = std::max(16 / level.size, static_cast<int>(0.5 * (std::sqrt(kWork / pixels) - 1)));
  const Vec2i reach(std::min(wanted, level.ref.width / 3), std::min(wanted, level.ref.height / 3));
  std::vector<std::pair<ShiftPlane, ShiftPlane>> whole;
  whole.emplace_back(plane_of(level.out, 0, 0, level.out.width, level.out.height),
                     plane_of(level.ref, 0, 0, level.ref.width, level.ref.height));
  return ShiftMap(whole, reach);
}

// A shift, in pixels of the picture, and the level it was seen at.
struct Shift {
  bool believed = false;
  Vec2d by{0.0};
  ShiftScore score;
  size_t level = 0;
};

Vec2i nearest(const Vec2d& v) { return {static_cast<int>(std::lround(v.x)), static_cast<int>(std::lround(v.y))}; }

// From coarse to fine. Of those levels that believe in it the finest is the most exact, but half a million pixels are
// enough. What two levels do not believe in is far from the truth, if it began far.
Shift follow(const std::vector<ShiftLevel>& levels, Vec2i start) {
  Shift found;
  Vec2d at(start.x, start.y);
  const size_t last = start == Vec2i(0) || levels.size() < 2 ? 0 : levels.size() - 2;
  for (size_t i = levels.size(); i-- > 0;) {
    if (i < last && !found.believed) break;
    const ShiftFit fit = fit_shift(levels[i], nearest(at), 4);
    if (believed(fit)) {
      found = {true, fit.by * static_cast<double>(levels[i].size), fit.score, i};
      at = fit.by;
      if (levels[i].ref.pixels() >= kEnough) break;
    }
    at *= 2.0;
  }
  return found;
}

// Without what it goes along one of the axes, if that explains as much: along an edge all displacements do.
Shift simplest(const std::vector<ShiftLevel>& levels, Shift shift) {
  constexpr double kAsMuch = 0.02;
  const ShiftLevel& level = levels[shift.level];
  const Vec2i at = nearest(shift.by / static_cast<double>(level.size));
  for (const Vec2i& start : {Vec2i(at.x, 0), Vec2i(0, at.y)}) {
    if (at.x == 0 || at.y == 0) break;
    const ShiftFit fit = fit_shift(level, start, 1);
    if (nearest(fit.by) == start && fit.score.left < shift.score.left + kAsMuch * (1 - shift.score.left))
      return {true, fit.by * static_cast<double>(level.size), fit.score, shift.level};
  }
  return shift;
}

// Parts of a level, in the middle and around it, in which patterns would be seen.
bool repeats(const ShiftLevel& level, const Vec2d& by) {
  constexpr int kPart = 128, kReach = 12;
  const int width = std::min(kPart, level.ref.width), height = std::min(kPart, level.ref.height);
  std::vector<std::pair<ShiftPlane, ShiftPlane>> parts;
  for (const auto& [fx, fy] : {std::pair{0.5, 0.5}, {0.25, 0.25}, {0.75, 0.25}, {0.25, 0.75}, {0.75, 0.75}}) {
    const auto corner = [](double f, int size, int part) {
      return std::clamp(static_cast<int>(f * size) - part / 2, 0, size - part);
    };
    const int x = corner(fx, level.ref.width, width), y = corner(fy, level.ref.height, height);
    parts.emplace_back(plane_of(level.out, x, y, width, height), plane_of(level.ref, x, y, width, height));
    if (width == level.ref.width && height == level.ref.height) break;
  }
  const Vec2i reach(std::min(kReach, width / 3), std::min(kReach, height / 3));
  return ShiftMap(parts, reach).ambiguous(nearest(by / static_cast<double>(level.size)));
}

// A picture with rows, columns or both in the other order.
ShiftPlane turned(const ShiftPlane& in, bool columns, bool rows) {
  ShiftPlane out = in;
  const auto width = static_cast<size_t>(in.width);
  for (int y = 0; y < in.height; ++y) {
    const float* from = in.row(rows ? in.height - 1 - y : y);
    float* to = &out.v[static_cast<size_t>(y) * width];
    if (columns) std::reverse_copy(from, from + width, to);
    else std::copy(from, from + width, to);
  }
  return out;
}

ShiftPlane transposed(const ShiftPlane& in) {
  ShiftPlane out = in;
  for (int y = 0; y < in.height; ++y)
    for (int x = 0; x < in.width; ++x)
      out.v[static_cast<size_t>(x) * static_cast<size_t>(in.height) + static_cast<size_t>(y)] = in.row(y)[x];
  return out;
}

struct Turn {
  const char* words = "";
  ShiftScore score;
};

// Mirrored and turned pictures, at the coarsest level. Blocks of the picture in another order begin at its other end.
Turn best_turn(const std::vector<ShiftLevel>& levels) {
  const ShiftLevel& coarsest = levels.back();
  const int size = coarsest.size, width = coarsest.out.width, height = coarsest.out.height;
  const ShiftView& whole = levels.front().ref;
  const ShiftPlane out = plane_of(coarsest.out, 0, 0, width, height), ref = plane_of(coarsest.ref, 0, 0, width, height);
  const CellErrors without = cell_errors(out, ref);
  Turn best;
  const auto consider = [&](const char* words, const ShiftPlane& plane) {
    const ShiftScore score = score_of(without, cell_errors(out, plane));
    if (score.value() >= kBelieved && score.left < best.score.left - 0.02) best = {words, score};
  };
  const auto from_end = [&](bool columns, bool rows) {
    const int x = columns ? whole.width % size : 0, y = rows ? whole.height % size : 0;
    return turned(x == 0 && y == 0 ? ref : reduced(whole, size, x, y), columns, rows);
  };
  consider("mirrored left to right", from_end(true, false));
  consider("flipped top to bottom", from_end(false, true));
  consider("turned by 180 degrees", from_end(true, true));
  if (whole.width == whole.height) consider("transposed", transposed(ref));
  return best;
}

Displacement decide(const std::vector<ShiftLevel>& levels) {
  const ShiftMap map = search(levels.back());
  Shift shift = follow(levels, Vec2i(0));
  if (map.best() != Vec2i(0)) {
    const Shift far = follow(levels, map.best());
    if (far.believed && (!shift.believed || far.score.left < shift.score.left)) shift = far;
  }
  if (shift.believed) shift = simplest(levels, shift);
  const bool shifted = shift.believed && std::hypot(shift.by.x, shift.by.y) >= kLeast;
  const Turn turn = best_turn(levels);
  // What a shift explains as well, be it one of several, is not turned.
  const double by_shift = std::min(shift.score.left, map.left(map.best()));
  if (turn.score.value() >= kBelieved && turn.score.left < by_shift - 0.1) return {true, Vec2d(0.0), turn.words};
  if (!shifted || map.ambiguous(nearest(shift.by / static_cast<double>(levels.back().size)))) return {};
  if (repeats(levels[shift.level], shift.by)) return {};
  return {true, shift.by, ""};
}

}  // namespace

Displacement find_displacement(std::span<const float> out, std::span<const float> ref, int width, int height) {
  assert(out.size() == static_cast<size_t>(width) * static_cast<size_t>(height) && ref.size() == out.size());
  if (out.empty() || std::memcmp(out.data(), ref.data(), out.size_bytes()) == 0) return {};
  const ShiftLevels levels(out, ref, width, height, kSearched);
  return levels.differ() ? decide(levels.levels()) : Displacement{};
}

}  // namespace whit
