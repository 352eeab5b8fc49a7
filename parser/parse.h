// From a .pbrt file, or text, to SceneDescriptions.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/diagnostics.h"
#include "parser/models.h"
#include "parser/scene_description.h"
#include "parser/source.h"

namespace whit {

struct ParseResult {
  std::vector<SceneDescription> scenes;  ///< One for each WorldBegin; usable only when there are no errors.
  Diagnostics diagnostics;
  uint64_t bytes = 0;  ///< Bytes of text parsed, included files counted each time.
};

struct ParseOptions {
  /// Reads also the files that are included in definitions of objects that are never placed. Without it they are listed
  /// in SceneDescription::unread_files instead.
  bool read_unplaced = false;
  /// Reads models; without it a Shape "gltf" stays the statement that it is. Must outlive the call alone.
  ModelReader* models = nullptr;
  bool is_model = false;  ///< The text is a model's, of what `models` has read, with its attachments.
};

/// Parses a file and all it includes. `sources` keeps their text, which every SourcePos refers to.
ParseResult parse_file(Sources& sources, const std::string& path, const ParseOptions& options = {});

/// Parses text that is no file: standard input, a test. Includes and assets are relative to `folder`
/// ("" is the current one).
ParseResult parse_text(Sources& sources, std::string name, std::string text, std::string folder,
                       const ParseOptions& options = {});

}  // namespace whit
