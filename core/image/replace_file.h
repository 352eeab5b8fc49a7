// Rewriting a file of the user's, with all that belongs to it.
#pragma once

#include <string>
#include <string_view>

namespace whit {

/// Gives a file a new text. It keeps its mode, owner, access list and all its names: a symbolic link is followed, hard
/// links stay. Whatever goes wrong, the file holds the old text or the new one. "" or why it was not done; a file without
/// permission to write is refused, to the superuser too. The same text again leaves the file untouched.
std::string replace_file(const std::string& path, const std::string& text);

/// Whether a file can be read and has just this text.
bool holds_text(const std::string& path, std::string_view text);

}  // namespace whit
