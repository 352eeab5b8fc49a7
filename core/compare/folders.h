// Folders of pictures, compared pair by pair.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/compare/compare.h"

namespace whit {

/// What two folders have, by names relative to them with '/' between, sorted.
struct FolderPairs {
  std::vector<std::string> both;     ///< Pictures that both have.
  std::vector<std::string> missing;  ///< The references have them, A does not.
  std::vector<std::string> extra;    ///< A has them, the references do not.
  /// Of missing pictures the extra ones that may be meant: the same but for the ending or the case of letters.
  std::map<std::string, std::string> alike;
};

/// Finds the pictures, by their endings, in all subfolders. Left out is what is hidden, and so is one of the two folders
/// where it lies inside the other. Symbolic links are followed, but not back to a folder that they are in. The error
/// names what cannot be read.
Result<FolderPairs> pair_folders(const std::string& a, const std::string& b);

/// A pair that has been compared.
struct ComparedPair {
  const std::string& name;
  const Comparison& comparison;
  const PicturePair& pair;  ///< Empty where they cannot be compared.
  double seconds;           ///< Reading and comparing it took.
};

/// Compares pairs on all cores, at most as many at a time as there are threads; `done` gets them in the order of `names`,
/// one at a time. `request` is asked by one thread at a time, too.
void compare_folders(const std::string& a, const std::string& b, const std::vector<std::string>& names,
                     const std::function<CompareRequest(const std::string& name)>& request,
                     const std::function<void(const ComparedPair&)>& done);

/// Copies a file over another, which appears whole or stays as it is, with the permissions that it had; a symbolic link
/// is followed. "" or the reason.
std::string replace_with(const std::string& from, const std::string& to);

}  // namespace whit
