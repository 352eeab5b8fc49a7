// Everything there is to say of a scene file: its mistakes, what a render would warn of, and what the scene does that its
// author hardly meant (core/check/findings.h). `whit check` and the language server ask here.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/session/session.h"

namespace whit {

struct CheckOptions {
  /// Reads the files that the scene names and builds it: finds what pictures, meshes and rays tell. Without it only the
  /// text is looked at, which is cheap enough for every keystroke.
  bool build = true;
  std::vector<std::string> allowed = {};    ///< Names of findings that are not wanted.
  std::vector<std::string> asked_for = {};  ///< Names of findings to look for that are off by default.
  std::function<bool()> give_up = {};       ///< Asked before long steps; what is returned after a yes is of no use.
};

/// All that is to say of a parsed file, file by file in the order of its lines. What is rendered past as pbrt-v3 does is
/// an error here (Diagnostic::excused). Everything has a name. What the file or the options allow is left out, but no
/// error can be. `path` is the file's, for the name of the picture that it makes. The file should have been read with
/// ReadOptions::read_unplaced.
Diagnostics check_file(const ParsedFile& file, const std::string& path, const CheckOptions& options = {});

}  // namespace whit
