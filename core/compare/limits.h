// What a comparison accepts, and whether it did.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/compare/comparison.h"
#include "core/compare/measures.h"
#include "core/compare/pair.h"

namespace whit {

struct Limits {
  std::map<std::string, double> of;   ///< By measure, in the place of its default; infinity switches it off.
  std::optional<double> hard_fail;    ///< No channel of any pixel may differ by more.
  std::optional<double> fail_pixels;  ///< Share of the pixels in [0,1] that may differ by more than pixel_error.
  double pixel_error = 0;
  bool exact = false;  ///< Every number equal; then nothing else is asked.
  bool allow_nonfinite = false;
  bool noise = false;    ///< In the place of the measures' defaults: is it only noise?
  double alpha = 0.001;  ///< Of pairs that differ by noise alone, so many are called different.
};

/// "MEASURE=VALUE" into the limits. "" or what is wrong with it, with a remedy. `below`: of measures that fall.
std::string add_limit(const std::string& text, bool below, Limits& limits);

/// The limit of a measure that is in force, none where there is none.
std::optional<double> limit_of(const MeasureRow& row, const Limits& limits);

/// Fills in Comparison::failed from all else.
void judge(const PicturePair& pair, const Limits& limits, Comparison& comparison);

}  // namespace whit
