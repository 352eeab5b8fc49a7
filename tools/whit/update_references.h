// `whit diff --update`: pictures in the place of the references that they differ from.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "core/compare/compare.h"

namespace whit {

/// A picture that was compared.
struct Compared {
  std::string name;      ///< As people are told of it.
  std::string from, to;  ///< The picture and its reference.
  bool same = true;      ///< It passed; its reference stays.
  CompareRequest request;
};

/// Why references cannot be replaced at all: nobody can be asked, and `yes` does not say so beforehand. "" when they can.
std::string update_problem(bool yes);

/// Says which references of those that differ it will replace, and which not for what reason, asks unless `yes`, copies,
/// and says what was replaced. A reference stays when its picture cannot be read, has numbers that are not finite (unless
/// allowed) or lacks channels or pixels that the reference has, or when it is the same file as another picture's
/// reference. Words go to `out`, the question to stderr. Returns the names of those that were replaced.
std::vector<std::string> update_references(const std::vector<Compared>& compared, bool yes, std::FILE* out);

}  // namespace whit
