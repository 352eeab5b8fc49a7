// The table that `whit diff` prints of folders: a row for each picture.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/compare/comparison.h"

namespace whit {

/// What became of a picture, the worst first.
enum class DiffStatus : uint8_t { Missing, Cannot, Differs, Extra, Skipped, Same };

struct DiffRow {
  DiffStatus status = DiffStatus::Same;
  std::string name;
  std::string reason;     ///< A line; "" where there is nothing to say.
  Comparison comparison;  ///< Of what was compared.
  double seconds = 0;
};

/// The row of a picture that was compared.
DiffRow row_of(const std::string& name, const Comparison& comparison, double seconds);

/// How many there are of a status.
size_t count_of(const std::vector<DiffRow>& rows, DiffStatus status);

/// A line for each row that is not the same, worst first, and how many there are of each; `verbose` all rows, with what
/// was measured of them. `columns`: longer lines are cut, 0 cuts none.
std::string diff_table(const std::vector<DiffRow>& rows, bool verbose, bool colour, size_t columns);

}  // namespace whit
