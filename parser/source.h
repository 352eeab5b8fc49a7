// The source files of a scene: their bytes, mapped into memory, and the way from a byte back to line and column.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/diagnostics.h"

namespace whit {

/// A position as people count: both from 1; the column in UTF-8 code points (an invalid byte counts as one).
struct SourcePlace {
  uint64_t line = 0;
  uint64_t column = 0;
};

/// Owns the text of every file of a scene for as long as anything refers to it. A regular file is mapped
/// read-only (it must not be shortened while in use), anything else (a pipe, standard input) is read into memory.
class Sources {
 public:
  Sources();
  ~Sources();
  Sources(const Sources&) = delete;
  Sources& operator=(const Sources&) = delete;

  /// Opens a file and returns its number; the same unchanged file opened again keeps its number and first name.
  /// On failure nothing, and `problem` says why ("No such file or directory").
  std::optional<uint32_t> open(const std::string& path, std::string& problem);

  /// From now on a file is this text, as an editor has it that has not saved: opening `path`, or another path to the
  /// same file, gives it. Nothing of it is read from the disk, where it need not be.
  void stand_in(const std::string& path, std::string text);

  /// From now on files are read into memory when they are opened, instead of mapped: others may then do with them what
  /// they like.
  void copy_files() { copies_ = true; }

  /// Adds text that is no file, under the name that messages will show.
  uint32_t add_text(std::string name, std::string text);

  /// The bytes of a file; empty for a number that names none.
  std::string_view text(uint32_t file) const;

  /// Gives the memory of a file's bytes in [begin, end) back to the system, which reads them again should anyone look.
  void release(uint32_t file, uint64_t begin, uint64_t end) const;

  /// The name as the user gave it, relative when it was; "" for a number that names none.
  const std::string& name(uint32_t file) const;

  /// How many files there are; they are numbered from 0.
  size_t size() const { return files_.size(); }

  /// Line and column of a position; {0, 0} when it is not known. Thread-safe, as all const functions here.
  SourcePlace place(SourcePos where) const;

  /// "scene.pbrt:8:31", or "" when the position is not known.
  std::string location(SourcePos where) const;

  /// A diagnostic as lines of text that end in a newline: place, severity and message, the line of source with a
  /// caret below the place, the remedy. `colour` adds ANSI colours.
  std::string render_diagnostic(const Diagnostic& diagnostic, bool colour) const;

 private:
  class File;
  const File* find(uint32_t file) const;
  std::string excerpt(SourcePos where, bool colour) const;

  std::optional<uint32_t> stand_in_for(const std::string& path) const;

  std::vector<std::unique_ptr<File>> files_;
  std::map<std::string, uint32_t> stand_ins_;  ///< By canonical path.
  bool copies_ = false;
};

/// Text for a message: in double quotes, unprintable bytes escaped, cut after 60 characters.
std::string in_quotes(std::string_view text);

/// The same for the path of a file, of which a thousand characters are shown, the last ones.
std::string quoted_path(std::string_view path);

/// Text that may go to a terminal: control characters and characters that cannot be seen are escaped.
std::string printable(std::string_view text);

/// A remedy for text in the grammar that looks right and is not: no-break spaces, typographic and single quotes, signs
/// that are dashes, comments of other languages. "" when there is none in it.
std::string foreign_characters(std::string_view text);

/// Why `text` cannot be a scene file ("it holds binary data", "it is compressed"), or "" when it may be one.
std::string why_not_text(std::string_view text);

}  // namespace whit
