// Text that comes from outside, made fit for where it goes.
#pragma once

#include <string>
#include <string_view>

namespace whit {

/// For a terminal, or anything else that wants a line: control characters become spaces, bytes that are not UTF-8 "?".
std::string one_line(std::string_view text);

/// The same between HTML tags, or in an attribute between double quotes.
std::string html_text(std::string_view text);

/// The same text in small letters of ASCII.
std::string lower_case(std::string text);

/// A name in double quotes, for a message.
std::string quoted_name(std::string_view name);

/// A JSON parser's message without the prefix that names its class, at most 300 characters long, those beyond ASCII "?":
/// "parse error at line 3, column 7: ...". Without the text that stands there, which may be that of any file.
std::string json_message(const std::string& what);

}  // namespace whit
