// The front door: two pictures in, what they differ by out.
#pragma once

#include <string>
#include <vector>

#include "core/compare/comparison.h"
#include "core/compare/limits.h"
#include "core/compare/pair.h"

namespace whit {

struct CompareRequest {
  PairRequest pair;
  Limits limits;
  std::vector<std::string> slow;  ///< Measures to take although they are slow; those with a limit are taken anyway.
};

/// Compares what was read.
Comparison compare_pair(const PicturePair& pair, const CompareRequest& request);

/// Reads and compares. `pair` keeps what was read, for reports that show pictures; null does not.
Comparison compare_files(const std::string& a, const std::string& b, const CompareRequest& request,
                         PicturePair* pair = nullptr);

}  // namespace whit
