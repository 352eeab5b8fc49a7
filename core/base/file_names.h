// Names of files: one for each, and as URIs have them.
#pragma once

#include <string>
#include <string_view>

namespace whit {

/// One name for each file, absolute and without links, as far as its folders are there.
std::string canonical_path(const std::string& path);

/// A path as a part of a URI: all but letters, digits and -._~/ as %XX (RFC 3986).
std::string percent_encoded(std::string_view path);

/// The other way. A % that no two hexadecimal digits follow stays.
std::string percent_decoded(std::string_view text);

/// A name as a shell takes it for one word: as it is where nothing in it means anything to a shell, else in quotes.
std::string shell_word(const std::string& word);

}  // namespace whit
