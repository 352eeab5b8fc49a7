#include "core/compare/shift_fit.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace whit {
namespace {

constexpr int kSmooth = 2;  // Reach of the smoothing.

// A part of a level, smoothed by binomial weights along rows and columns.
ShiftPlane smoothed(const ShiftView& view, int x, int y, int width, int height) {
  const ShiftPlane in = plane_of(view, x - kSmooth, y - kSmooth, width + 2 * kSmooth, height + 2 * kSmooth);
  ShiftPlane out{width, height, std::vector<float>(static_cast<size_t>(width) * static_cast<size_t>(height))};
  std::vector<float> sums(static_cast<size_t>(in.width));
  for (int row = 0; row < height; ++row) {
    const float *r0 = in.row(row), *r1 = in.row(row + 1), *r2 = in.row(row + 2), *r3 = in.row(row + 3);
    const float* r4 = in.row(row + 4);
    float *s = sums.data(), *to = &out.v[static_cast<size_t>(row) * static_cast<size_t>(width)];
#pragma omp simd
    for (int i = 0; i < in.width; ++i) s[i] = (r0[i] + r4[i]) + 4 * (r1[i] + r3[i]) + 6 * r2[i];
#pragma omp simd
    for (int i = 0; i < width; ++i)
      to[i] = ((s[i] + s[i + 4]) + 4 * (s[i + 1] + s[i + 3]) + 6 * s[i + 2]) * (1.0f / 256);
  }
  return out;
}

// The sums of squared differences of a cell: displaced by the start and what is around it, and not displaced.
constexpr size_t kCentre = 4, kUnshifted = 9, kErrors = 10;
using Errors = std::array<float, kErrors>;

// The pixels of `out` for which `ref` has all that they are compared with. Maximum not included.
struct Window {
  int x0, x1, y0, y1;
};

Window window_of(const ShiftLevel& level, Vec2i start) {
  const auto low = [](int s) { return kSmooth + std::max(0, s + 1); };
  const auto high = [](int s, int size) { return size - kSmooth + std::min(0, s - 1); };
  return {low(start.x), high(start.x, level.ref.width), low(start.y), high(start.y, level.ref.height)};
}

int cell_size(int width, int height) { return std::clamp(std::min(width, height) / 16, 4, 16); }

// out += (a - b)^2 for each column.
void add_squares(const float* a, const float* b, std::vector<float>& out) {
  float* to = out.data();
  const size_t size = out.size();
#pragma omp simd
  for (size_t i = 0; i < size; ++i) to[i] += (a[i] - b[i]) * (a[i] - b[i]);
}

class Cells {
 public:
  Cells(const ShiftLevel& level, Vec2i start) : level_(level), start_(start), window_(window_of(level, start)) {
    if (window_.x1 - window_.x0 < 8 || window_.y1 - window_.y0 < 8) return;
    size_ = cell_size(window_.x1 - window_.x0, window_.y1 - window_.y0);
    columns_ = (window_.x1 - window_.x0) / size_, rows_ = (window_.y1 - window_.y0) / size_;
    errors.resize(static_cast<size_t>(columns_) * static_cast<size_t>(rows_));
    const int at_once = std::max(1, 256 / size_), parts = (columns_ + at_once - 1) / at_once;
    tbb::parallel_for(0, parts * rows_, [&](int i) {
      const int first = i % parts * at_once;
      measure(first, std::min(first + at_once, columns_), i / parts);
    });
  }

  std::vector<Errors> errors;

  int columns() const { return columns_; }
  int rows() const { return rows_; }

 private:
  // The cells [first, last) of a row of cells.
  void measure(int first, int last, int row) {
    const int x = window_.x0 + first * size_, y = window_.y0 + row * size_, width = (last - first) * size_;
    const ShiftPlane out = smoothed(level_.out, x, y, width, size_);
    const ShiftPlane around = smoothed(level_.ref, x - start_.x - 1, y - start_.y - 1, width + 2, size_ + 2);
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        compare(out, around, 1 - dx, 1 - dy, first, row, static_cast<size_t>(3 * (dy + 1) + dx + 1));
    compare(out, smoothed(level_.ref, x, y, width, size_), 0, 0, first, row, kUnshifted);
  }

  void compare(const ShiftPlane& out, const ShiftPlane& ref, int x, int y, int first, int row, size_t which) {
    std::vector<float> squares(static_cast<size_t>(out.width));
    for (int i = 0; i < size_; ++i) add_squares(out.row(i), ref.row(i + y) + x, squares);
    Errors* to = &errors[static_cast<size_t>(row * columns_ + first)];
    for (size_t i = 0; i < squares.size(); ++i) to[i / static_cast<size_t>(size_)][which] += squares[i];
  }

  const ShiftLevel& level_;
  Vec2i start_;
  Window window_;
  int size_ = 0, columns_ = 0, rows_ = 0;
};

// A quadric c + g d + d H d / 2 through the errors around the start, by least squares.
struct Quadric {
  double gx = 0, gy = 0, hxx = 0, hyy = 0, hxy = 0;

  template <class E>
  static Quadric through(const E& e) {
    const auto at = [&](int dx, int dy) { return double{e[static_cast<size_t>(3 * (dy + 1) + dx + 1)]}; };
    const auto column = [&](int dx) { return at(dx, -1) + at(dx, 0) + at(dx, 1); };
    const auto row = [&](int dy) { return at(-1, dy) + at(0, dy) + at(1, dy); };
    return {(column(1) - column(-1)) / 6, (row(1) - row(-1)) / 6, (column(1) + column(-1) - 2 * column(0)) / 3,
            (row(1) + row(-1) - 2 * row(0)) / 3, (at(1, 1) + at(-1, -1) - at(1, -1) - at(-1, 1)) / 4};
  }
  double change(const Vec2d& d) const {
    return gx * d.x + gy * d.y + 0.5 * (hxx * d.x * d.x + hyy * d.y * d.y) + hxy * d.x * d.y;
  }
  Vec2d slope(const Vec2d& d) const { return {gx + hxx * d.x + hxy * d.y, gy + hxy * d.x + hyy * d.y}; }
};

// The inverse of H, without the direction in which it is next to flat: no displacement along it can be told.
struct Inverse {
  double xx = 0, yy = 0, xy = 0;
  Vec2d times(const Vec2d& v) const { return {xx * v.x + xy * v.y, xy * v.x + yy * v.y}; }
};

Inverse inverse_of(const Quadric& q) {
  constexpr double kFlat = 0.01;
  const double middle = 0.5 * (q.hxx + q.hyy), half = std::hypot(0.5 * (q.hxx - q.hyy), q.hxy);
  const double angle = 0.5 * std::atan2(2 * q.hxy, q.hxx - q.hyy), c = std::cos(angle), s = std::sin(angle);
  Inverse inverse;
  const auto add = [&](double value, double x, double y) {
    if (!(value > kFlat * (middle + half))) return;
    inverse.xx += x * x / value, inverse.yy += y * y / value, inverse.xy += x * y / value;
  };
  if (!(middle + half > 0)) return inverse;
  add(middle + half, c, s);
  add(middle - half, -s, c);
  return inverse;
}

struct Totals {
  std::array<double, kErrors> sums{};
  size_t best() const {
    // Of those that are about as good the nearest: along an edge all are.
    constexpr size_t kNearestFirst[] = {1, 3, 5, 7, 0, 2, 6, 8};
    size_t at = kCentre;
    for (size_t i : kNearestFirst)
      if (sums[i] < 0.99 * sums[at]) at = i;
    return at;
  }
};

Totals totals_of(const std::vector<Errors>& cells) {
  Totals totals;
  for (const Errors& cell : cells)
    for (size_t i = 0; i < kErrors; ++i) totals.sums[i] += double{cell[i]};
  return totals;
}

// The variances of a displacement, by how the cells disagree about it.
struct Variances {
  double xx = 0, yy = 0, xy = 0;
  double along(const Vec2d& v) const { return v.x * v.x * xx + v.y * v.y * yy + 2 * v.x * v.y * xy; }
};

Variances variances_of(const std::vector<Errors>& cells, const Inverse& inverse, const Vec2d& step) {
  Variances v;
  for (const Errors& cell : cells) {
    const Vec2d pull = inverse.times(Quadric::through(cell).slope(step));
    v.xx += pull.x * pull.x, v.yy += pull.y * pull.y, v.xy += pull.x * pull.y;
  }
  return v;
}

// What is not certain along an axis counts as 0.
Vec2d without_uncertain(Vec2d step, Vec2i start, const Variances& variances) {
  constexpr double kCertain = 3;
  if (start.x == 0 && std::abs(step.x) < kCertain * std::sqrt(variances.xx)) step.x = 0;
  if (start.y == 0 && std::abs(step.y) < kCertain * std::sqrt(variances.yy)) step.y = 0;
  return step;
}

ShiftFit fit_between(const Cells& measured, Vec2i start) {
  const std::vector<Errors>& cells = measured.errors;
  const Quadric all = Quadric::through(totals_of(cells).sums);
  const Inverse inverse = inverse_of(all);
  Vec2d step = -inverse.times({all.gx, all.gy});
  step = {std::clamp(step.x, -1.0, 1.0), std::clamp(step.y, -1.0, 1.0)};
  const Variances variances = variances_of(cells, inverse, step);
  step = without_uncertain(step, start, variances);
  CellErrors without{measured.columns(), measured.rows(), {}}, with = without;
  for (const Errors& cell : cells) {
    without.sums.push_back(double{cell[kUnshifted]});
    with.sums.push_back(double{cell[kCentre]} + Quadric::through(cell).change(step));
  }
  const Vec2d by(start.x + step.x, start.y + step.y);
  const double variance = variances.along(by);
  return {by, variance > 0 ? by.dot(by) / std::sqrt(variance) : 0, score_of(without, with)};
}

// Four cells each taken together. What is left over at the end of rows and columns is left out.
CellErrors merged(const CellErrors& cells) {
  CellErrors out{cells.columns / 2, cells.rows / 2, {}};
  out.sums.resize(static_cast<size_t>(out.columns) * static_cast<size_t>(out.rows));
  for (int y = 0; y < 2 * out.rows; ++y)
    for (int x = 0; x < 2 * out.columns; ++x)
      out.sums[static_cast<size_t>(y / 2 * out.columns + x / 2)] +=
          cells.sums[static_cast<size_t>(y * cells.columns + x)];
  return out;
}

// The sum in its own standard deviations, if it has no mean.
double deviations(const CellErrors& gains) {
  double sum = 0, squares = 0;
  for (double gain : gains.sums) sum += gain, squares += gain * gain;
  return squares > 0 ? sum / std::sqrt(squares) : 0;
}

}  // namespace

ShiftScore score_of(const CellErrors& without, const CellErrors& with) {
  constexpr int kFewest = 10;  // Cells each way that are merged yet.
  CellErrors gains = without;
  double before = 0, after = 0;
  for (size_t i = 0; i < without.sums.size(); ++i) {
    before += without.sums[i], after += with.sums[i];
    gains.sums[i] -= with.sums[i];
  }
  if (!(before > 0)) return {};
  ShiftScore score{std::max(0.0, after / before), deviations(gains), 0, gains.sums.size()};
  for (score.evidence = score.gains; std::min(gains.columns, gains.rows) >= kFewest;) {
    gains = merged(gains);
    score.evidence = std::min(score.evidence, deviations(gains));
  }
  return score;
}

ShiftFit fit_shift(const ShiftLevel& level, Vec2i start, int steps) {
  for (int i = 0; i < steps; ++i) {
    const Cells cells(level, start);
    if (cells.errors.empty()) return {};
    const int best = static_cast<int>(totals_of(cells.errors).best());
    if (best == static_cast<int>(kCentre) || i + 1 == steps) return fit_between(cells, start);
    start += Vec2i(best % 3 - 1, best / 3 - 1);
  }
  return {};
}

CellErrors cell_errors(const ShiftPlane& a, const ShiftPlane& b) {
  const int size = cell_size(a.width, a.height);
  CellErrors errors{a.width / size, a.height / size, {}};
  errors.sums.resize(static_cast<size_t>(errors.columns) * static_cast<size_t>(errors.rows));
  if (errors.sums.empty()) return errors;
  for (int y = 0; y < errors.rows * size; ++y) {
    const float *ra = a.row(y), *rb = b.row(y);
    double* to = &errors.sums[static_cast<size_t>(y / size * errors.columns)];
    for (int x = 0; x < errors.columns * size; ++x) {
      const double d = double{ra[x]} - double{rb[x]};
      to[x / size] += d * d;
    }
  }
  return errors;
}

}  // namespace whit
