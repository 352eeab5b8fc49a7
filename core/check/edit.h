// Corrections of a scene file's text, where a diagnostic knows of one beyond doubt.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "parser/source.h"

namespace whit {

/// Bytes of a file that are to be replaced.
struct Edit {
  uint32_t file = SourcePos::kNoFile;
  uint64_t begin = 0, end = 0;
  std::string text;
};

/// What a diagnostic's slip comes to, or nothing where it has none or the word is not there.
std::optional<Edit> edit_of(const Sources& sources, const Diagnostic& diagnostic);

/// A text with some edits made, which must be in order and not overlap.
std::string edited(std::string_view text, const std::vector<Edit>& edits);

}  // namespace whit
