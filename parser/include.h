// What parsing and formatting share about main files and the files they include.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "parser/reporter.h"
#include "parser/source.h"
#include "parser/statements.h"

namespace whit {

/// Reports why a file is no scene at all: it is empty, or not text. True when parsing may go on.
bool check_is_scene(const Sources& sources, uint32_t file, Reporter& reporter);

/// `path` itself when it is absolute, else below `folder`.
std::string join_path(const std::string& folder, const std::string& path);

/// Opens the file an Include at `where` asks for. Nothing, and a report, when it cannot be read, is no text, or
/// `is_open` says that it is being read already. `folder` is the main file's, also inside included files.
std::optional<uint32_t> open_include(Sources& sources, Reporter& reporter, const std::string& folder,
                                     const std::string& path, SourcePos where,
                                     const std::function<bool(uint32_t)>& is_open);

/// For an Include whose file need not be read: false, and the report open_include() would make, when it is not there.
bool check_include_exists(Reporter& reporter, const std::string& folder, const std::string& path, SourcePos where);

/// Gives `trailing`, the parameters behind an Include, to the last statement of its file: for pbrt a parameter list does
/// not end where a file ends. Call with every statement read from that file; the others are left as they are.
void append_trailing(Lexer& lexer, ReadResult result, ParameterList& trailing, Statement& statement);

}  // namespace whit
