// A scene's text as statements of tokens, for mutators: no grammar beyond that is known here.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace whit::fuzz {

/// A directive and what follows it up to the next one; the first statement of a text may have no directive.
using Tokens = std::vector<std::string>;

/// The statements of a text. Strings keep their quotes; comments and white space are lost.
std::vector<Tokens> split_statements(std::string_view text);

/// Their text, a statement a line.
std::string join_statements(const std::vector<Tokens>& statements);

bool is_quoted(const std::string& token);
bool is_number(const std::string& token);

}  // namespace whit::fuzz
