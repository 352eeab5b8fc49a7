// Sampling cells of a grid in proportion to weights: the importance sampling of maps.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace whit {

/// Cells 0 .. n-1 with probabilities in proportion to weights. Probabilities are whole multiples of 2^-24, the spacing
/// of the samplers' numbers, so the probability stated is exactly the share of the numbers that lead to a cell, and
/// they add up to exactly 1. Every cell of positive weight has at least one such unit; cells of weight 0 have none.
///
/// Writes the cumulative distribution, weights.size() + 1 values from 0 to 1. Weights must be finite and >= 0, and
/// fewer than 2^23; if all are 0 every cell counts the same. Returns the sum of the weights.
double build_cell_cdf(std::span<const double> weights, float* cdf);

/// Cells of a grid of rows and columns with probabilities in proportion to weights: first a row is drawn, then a
/// column within it (Pharr, Jakob, Humphreys, Physically Based Rendering, 3rd ed., 13.6.7; searched by bisection).
class GridDistribution {
 public:
  GridDistribution() = default;
  /// To be told the weights of each row, and finished, before it is asked.
  GridDistribution(int columns, int rows);
  /// The weights of the cells of a row, >= 0 and finite. Threads may set different rows at the same time.
  void set_row(int row, std::span<const double> weights);
  /// All rows are set.
  void finish();

  int columns() const { return columns_; }
  int rows() const { return rows_; }

  /// What a loop over lanes needs of the distribution.
  struct View {
    int columns;
    const float *rows_cdf, *columns_cdf;
    /// The probability of a cell. All together they are 1 up to the rounding of a product.
    float probability(int column, int row) const {
      const float* c = columns_cdf + static_cast<ptrdiff_t>(row) * (columns + 1) + column;
      return (c[1] - c[0]) * (rows_cdf[row + 1] - rows_cdf[row]);
    }
  };
  View view() const { return {columns_, rows_cdf_.data(), columns_cdf_.get()}; }

  /// Cells for n pairs of uniform numbers in [0,1), u along a row and v across the rows, with the rest of the numbers
  /// as position within the cell: du, dv in [0,1).
  void sample(int n, const float* u, const float* v, int* column, int* row, float* du, float* dv) const;

 private:
  int columns_ = 0, rows_ = 0;
  std::vector<double> row_sums_;          ///< Until it is finished.
  std::vector<float> rows_cdf_;           ///< rows + 1
  std::unique_ptr<float[]> columns_cdf_;  ///< rows x (columns + 1)
};

}  // namespace whit
