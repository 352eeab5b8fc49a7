// What parsing and formatting share about main files and the files they include.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

#include "parser/reporter.h"
#include "parser/source.h"
#include "parser/statements.h"

namespace whit {

/// Opens the file that a command names. Nothing, and a report, when it cannot be read. Only here may it be a pipe: one of
/// the program's own, as /dev/stdin and what shells write for <(...).
std::optional<uint32_t> open_main(Sources& sources, const std::string& path, Diagnostics& diagnostics);

/// Reports why a file is no scene at all: it is empty, or not text, or, on disk, begins with no statement. Of such a file
/// nothing is quoted, whatever is said of it: a scene may name any file, and messages may go to others than its owner.
/// True when parsing may go on.
bool check_is_scene(Sources& sources, uint32_t file, Reporter& reporter);

/// Reports a file that was written to while it was read, instead of all that was found in it. True when there is none.
bool check_unchanged(const Sources& sources, Diagnostics& diagnostics);

/// `path` itself when it is absolute, else below `folder`.
std::string join_path(const std::string& folder, const std::string& path);

/// The files that are being read, each included by the one before, and what they may include.
class Inclusion {
 public:
  /// `folder` is the main file's, also inside included files.
  Inclusion(Sources& sources, Reporter& reporter, const std::string& folder)
      : sources_(sources), reporter_(reporter), folder_(folder) {}

  void enter(uint32_t file) { reading_.push_back(file); }
  void leave() { reading_.pop_back(); }

  /// Opens the file an Include at `where` asks for. Nothing, and a report, when it cannot be read, is no scene, is being
  /// read already, or one of the limits kIncludeDepth and kIncludes is reached.
  std::optional<uint32_t> open(const std::string& path, SourcePos where);

  /// True once there were too many: reading on would take for ever.
  bool exhausted() const;

 private:
  bool check_limits(SourcePos where);

  Sources& sources_;
  Reporter& reporter_;
  const std::string& folder_;
  std::vector<uint32_t> reading_;
  std::unordered_set<uint32_t> good_;  ///< Those that are known to be scenes.
  uint64_t opened_ = 0;
};

/// For an Include whose file need not be read: false, and the report Inclusion::open() would make, when it is not there.
bool check_include_exists(Reporter& reporter, const std::string& folder, const std::string& path, SourcePos where);

/// Gives `trailing`, the parameters behind an Include, to the last statement of its file: for pbrt a parameter list does
/// not end where a file ends. Call with every statement read from that file; the others are left as they are.
void append_trailing(Lexer& lexer, ReadResult result, ParameterList& trailing, Statement& statement);

}  // namespace whit
