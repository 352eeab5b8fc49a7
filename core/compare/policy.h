// A project's limits, which it keeps beside its references: a JSON file (docs/diff-in-ci.md).
#pragma once

#include <string>
#include <vector>

#include "core/compare/settings.h"

namespace whit {

/// A rule: of the pictures whose names match, what it says.
struct PolicyRule {
  std::string place;  ///< Its JSON pointer.
  std::string match;  ///< A pattern for whole names: see matches_path().
  CompareSettings says;
};

struct Policy {
  std::string path;
  std::vector<PolicyRule> rules;

  /// What the rules that match a picture say of it, by its name relative to the folder of the references with '/'
  /// between; later rules win, for each thing they say.
  CompareSettings settings_for(const std::string& name) const;
  /// The name of a reference that is compared alone: relative to the policy's folder if it is below it, so that it is
  /// the same as among all of the folder's, else the file's.
  std::string name_of(const std::string& reference) const;
  /// A sentence for each rule that matches none of these.
  std::vector<std::string> unmatched(const std::vector<std::string>& names) const;
  /// Of a reference that is compared alone: a sentence for each rule that is for more of its path than its name, and one
  /// when no rule is for it though its name is a guess, as it is outside of the policy's folder.
  std::vector<std::string> missed(const std::string& reference) const;
};

/// Reads a policy. The error has a line for each mistake with the file, the place in it (a JSON pointer; line and column
/// where it is no JSON) and the remedy; unknown names are mistakes.
Result<Policy> read_policy(const std::string& path);

/// True when `name` is what a pattern says, all of it: * any characters and ? one within a folder's or file's name,
/// ** any folders.
bool matches_path(const std::string& pattern, const std::string& name);

}  // namespace whit
