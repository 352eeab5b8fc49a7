// All that is wrong with a scene, file by file, with the texts of an editor in the place of files.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/author/document.h"
#include "core/base/diagnostics.h"

namespace whit::author {

/// A place in a file.
struct Place {
  std::string path;
  Position begin, end;
};

/// A diagnostic where an editor shows it.
struct Finding {
  Severity severity = Severity::Error;
  Position begin, end;
  std::string message, remedy, name;
  Slip slip;
  std::optional<std::pair<Position, Position>> word;  ///< Where what the slip corrects begins and ends.
  std::optional<Place> other;
};

/// A text that is open in an editor.
struct OpenText {
  std::string path;
  std::shared_ptr<const std::string> text;
};

struct DiagnoseOptions {
  Encoding encoding = Encoding::Utf16;
  bool thorough = false;               ///< Reads all files that a render would read: then it is what `whit check` says.
  std::function<bool()> give_up = {};  ///< Asked now and then; whatever is returned then is of no use.
};

/// By canonical path, for every file of the scene, those of which nothing is said too. What has no place in a file is said
/// at the beginning of the main file.
using Findings = std::map<std::string, std::vector<Finding>>;
Findings diagnose(const std::string& main_file, const std::vector<OpenText>& open, const DiagnoseOptions& options);

}  // namespace whit::author
