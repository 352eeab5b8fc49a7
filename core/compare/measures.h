// The measures: a table, a row for each, and how they are taken.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/compare/comparison.h"
#include "core/compare/flip.h"
#include "core/compare/pair.h"

namespace whit {

/// One measure.
struct MeasureRow {
  const char* name;               ///< As people ask for it.
  const char* doc;                ///< What it is, with its formula, a sentence.
  bool falls = false;             ///< Lower is worse.
  std::optional<double> limit{};  ///< The default, where there is one.
  bool slow = false;              ///< Measured when asked for only: takes longer than all the others together.
};

/// The table, in the order of reports.
std::span<const MeasureRow> all_measures();
/// The row of a name; null when there is none.
const MeasureRow* find_measure(const std::string& name);

/// The names of those that fall, or of those that do not.
std::vector<std::string> measure_names(bool falls);

/// Measures every layer of a pair, appending to `measured`: by all that are not slow, and by the slow ones named. Returns how
/// many pixels have a number that is not equal.
int64_t measure_pair(const PicturePair& pair, const std::vector<std::string>& slow, std::vector<Measured>& measured);

/// FLIP of the beauty with B as the reference: of display values LDR-FLIP, of light HDR-FLIP.
Flip flip_of(const PicturePair& pair);

}  // namespace whit
