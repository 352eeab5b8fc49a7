#include "tests/fuzz/shared/scene_text.h"

#include <algorithm>

#include "parser/statements.h"

namespace whit::fuzz {
namespace {

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }
bool ends_word(char c) { return is_space(c) || c == '"' || c == '[' || c == ']' || c == '#'; }

/// The byte behind the token at `at`, which is not white space.
size_t end_of_token(std::string_view text, size_t at) {
  const auto upto = [&](size_t found) { return std::min(found, text.size()); };
  if (text[at] == '#') return upto(text.find('\n', at));
  if (text[at] == '[' || text[at] == ']') return at + 1;
  if (text[at] == '"') return upto(upto(text.find_first_of("\"\n", at + 1)) + 1);
  while (at < text.size() && !ends_word(text[at])) ++at;
  return at;
}

}  // namespace

std::vector<Tokens> split_statements(std::string_view text) {
  std::vector<Tokens> all(1);
  for (size_t at = 0; at < text.size();) {
    if (is_space(text[at])) {
      ++at;
      continue;
    }
    const size_t end = end_of_token(text, at);
    const std::string_view token = text.substr(at, end - at);
    if (is_directive(token)) all.emplace_back();
    if (token.front() != '#') all.back().emplace_back(token);
    at = end;
  }
  if (all.front().empty()) all.erase(all.begin());
  return all;
}

std::string join_statements(const std::vector<Tokens>& statements) {
  std::string out;
  for (const Tokens& statement : statements) {
    for (const std::string& token : statement) out += (&token == &statement.front() ? "" : " ") + token;
    out += '\n';
  }
  return out;
}

bool is_quoted(const std::string& token) { return token.size() > 1 && token.front() == '"' && token.back() == '"'; }

bool is_number(const std::string& token) {
  return !token.empty() && (std::string_view("+-.0123456789").find(token.front()) != std::string_view::npos);
}

}  // namespace whit::fuzz
