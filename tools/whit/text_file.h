// Texts for machines and people, into a file or to standard output ("-").
#pragma once

#include <string>

namespace whit {

/// Whether a path stands for standard output.
bool is_stdout(const std::string& path);

/// "" or why no text can be written there; "", for none, and "-" can always be.
std::string text_file_problem(const std::string& path);

/// Writes a text: a file appears complete or not at all. "" or why it is not there.
std::string write_text(const std::string& path, const std::string& text);

}  // namespace whit
