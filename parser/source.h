// The source files of a scene: their bytes, mapped into memory, and the way from a byte back to line and column.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/diagnostics.h"

namespace whit {

/// A position as people count: both from 1; the column in UTF-8 code points (an invalid byte counts as one).
struct SourcePlace {
  uint64_t line = 0;
  uint64_t column = 0;
};

/// Whether what a pipe brings may be taken for a file: the main one, where a command names it /dev/stdin.
enum class Pipes : uint8_t { Refuse, Read };

/// Owns the text of every file of a scene for as long as anything refers to it. A small file is read into memory, a
/// larger one is mapped: see problem() for what others may do to it meanwhile. What is no regular file is not read, but
/// for pipes where they are allowed.
class Sources {
 public:
  Sources();
  ~Sources();
  Sources(const Sources&) = delete;
  Sources& operator=(const Sources&) = delete;

  /// Opens a file and returns its number; the same unchanged file opened again keeps its number and first name.
  /// On failure nothing, and `problem` says why ("No such file or directory").
  std::optional<uint32_t> open(const std::string& path, std::string& problem, Pipes pipes = Pipes::Refuse);

  /// "", or which of the files was written to since it was opened: "scene.pbrt: it changed while it was read". What was
  /// made of its text up to now may be of no use then. Of a file read into memory it is open() that says so.
  std::string problem() const;

  /// The same of one file, without its name.
  std::string problem(uint32_t file) const;

  /// From now on a file is this text, as an editor has it that has not saved: opening `path`, or another path to the
  /// same file, gives it. Nothing of it is read from the disk, where it need not be.
  void stand_in(const std::string& path, std::string text);

  /// From now on files of up to 64 MiB are read into memory when they are opened, instead of mapped: others may then do
  /// with them what they like, and messages go on to quote them.
  void copy_files() { copied_bytes_ = size_t{1} << 26; }

  /// Adds text that is no file, under the name that messages will show.
  uint32_t add_text(std::string name, std::string text);

  /// The bytes of a file; empty for a number that names none.
  std::string_view text(uint32_t file) const;

  /// Gives the memory of a file's bytes in [begin, end) back to the system, which reads them again should anyone look.
  void release(uint32_t file, uint64_t begin, uint64_t end) const;

  /// From now on no line of the file is shown: it is none that should appear in messages.
  void hide(uint32_t file);

  /// Whether the text is that of a file on disk, and not the user's own: unsaved, or from a pipe.
  bool is_on_disk(uint32_t file) const;

  /// The name as the user gave it, relative when it was; "" for a number that names none.
  const std::string& name(uint32_t file) const;

  /// How many files there are; they are numbered from 0.
  size_t size() const { return files_.size(); }

  /// Line and column of a position; {0, 0} when it is not known, as in a file that has changed since it was opened.
  /// Thread-safe, as all const functions here.
  SourcePlace place(SourcePos where) const;

  /// "scene.pbrt:8:31", or "" when the position is not known; "scene.pbrt (changed since)" where lines and columns are no
  /// longer those that were read.
  std::string location(SourcePos where) const;

  /// A diagnostic as lines of text that end in a newline: place, severity and message, the line of source with a
  /// caret below the place, the remedy. `colour` adds ANSI colours. Of a file that has changed since, no line.
  std::string render_diagnostic(const Diagnostic& diagnostic, bool colour) const;

 private:
  class File;
  const File* find(uint32_t file) const;
  std::string excerpt(SourcePos where, bool colour) const;

  std::optional<uint32_t> stand_in_for(const std::string& path) const;
  std::optional<uint32_t> open_pipe(const std::string& path, std::string& problem);

  std::vector<std::unique_ptr<File>> files_;
  std::map<std::string, uint32_t> stand_ins_;  ///< By canonical path.
  /// The number of a file as it was last opened, by device and inode.
  std::map<std::pair<uint64_t, uint64_t>, uint32_t> on_disk_;
  size_t copied_bytes_;
};

/// All that comes through a pipe, up to the limit kPipedBytes; nothing, and `problem`, when there is more or reading fails.
std::optional<std::string> read_pipe(int descriptor, std::string& problem);

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
