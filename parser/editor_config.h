// What .editorconfig files say of how a file is to be laid out: https://spec.editorconfig.org, as far as it concerns
// scene files.
#pragma once

#include <string>
#include <string_view>

namespace whit {

struct EditorConfig {
  std::string indent = "  ";  ///< One step of it: indent_style, indent_size and tab_width.
  bool crlf = false;          ///< end_of_line

  /// A text of lines that end in \n with the ends that are wanted.
  std::string line_ends(const std::string& text) const;
};

/// For a file, from the .editorconfig files of its folder and those above, up to one that has root = true. What is no
/// such file, or not understood in one, counts as not said.
EditorConfig read_editor_config(const std::string& path);

/// Whether a path relative to the folder of a .editorconfig file, with / between, is one that a section's glob is for.
bool matches_glob(std::string_view glob, std::string_view path);

}  // namespace whit
