// `whit check --fix`: corrects in scene files what is beyond doubt.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/diagnostics.h"
#include "core/session/session.h"

namespace whit {

/// Corrects the files of scenes, one scene after the other. What was corrected once is not turned back, for a scene that
/// shares a file with an earlier one neither.
class Fixer {
 public:
  /// Texts that stand for files, as ReadOptions::unsaved.
  using Texts = std::vector<std::pair<std::string, std::string>>;

  /// Applies the corrections that diagnostics know of, until none is left: a correction may bring the next to light.
  /// `read` reads the scene anew, with copies of its files, `check` says what is wrong with it. A file that is included
  /// several times is corrected where all inclusions ask for the same. Says on stderr what was changed. Files are written
  /// at the end, each once; the result is why some could not be.
  std::vector<std::string> fix(const std::function<ParsedFile(const Texts&)>& read,
                               const std::function<Diagnostics(const ParsedFile&)>& check);

 private:
  /// File, line, what was written, what it is now.
  std::set<std::tuple<std::string, uint64_t, std::string, std::string>> done_;
};

}  // namespace whit
