#include "core/check/allowances.h"

#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>

#include "core/check/findings.h"
#include "core/check/names.h"
#include "parser/statements.h"

namespace whit {
namespace {

constexpr std::string_view kMark = "whit:";
constexpr uint64_t kEnd = std::numeric_limits<uint64_t>::max();

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// The byte behind the word, string or bracket at `at`, which is neither space nor a comment.
uint64_t end_of_token(std::string_view text, uint64_t at) {
  const auto ends_word = [](char c) { return is_space(c) || c == '"' || c == '[' || c == ']' || c == '#'; };
  if (text[at] == '"') {
    uint64_t i = at + 1;
    for (; i < text.size() && text[i] != '"' && text[i] != '\n'; ++i)
      if (text[i] == '\\') ++i;
    return std::min<uint64_t>(i + 1, text.size());
  }
  uint64_t i = at + 1;
  if (text[at] == '[' || text[at] == ']') return i;
  while (i < text.size() && !ends_word(text[i])) ++i;
  return i;
}

/// The next token at or behind `at`, comments passed over; the text's size when there is none.
uint64_t next_token(std::string_view text, uint64_t at) {
  while (at < text.size()) {
    if (is_space(text[at])) ++at;
    else if (text[at] == '#') at = std::min(text.find('\n', at), text.size());
    else return at;
  }
  return text.size();
}

/// The byte at which the statement ends that begins at `begin`: where the next one begins.
uint64_t end_of_statement(std::string_view text, uint64_t begin) {
  for (uint64_t at = next_token(text, end_of_token(text, begin)); at < text.size();) {
    const uint64_t end = end_of_token(text, at);
    if (is_directive(text.substr(at, end - at))) return at;
    at = next_token(text, end);
  }
  return text.size();
}

}  // namespace

Allowances::Allowances(const Sources& sources) {
  for (uint32_t file = 0; file < sources.size(); ++file) read(file, sources.text(file));
}

void Allowances::read(uint32_t file, std::string_view text) {
  // Nearly no file has one: whoever has none pays for one search.
  if (text.find(kMark) == std::string_view::npos) return;
  bool any_statement = false;
  uint64_t line = 0;  // Where it begins.
  bool code_on_line = false;
  for (uint64_t at = 0; at < text.size();) {
    if (text[at] == '\n') {
      line = ++at, code_on_line = false;
      continue;
    }
    if (is_space(text[at])) {
      ++at;
      continue;
    }
    if (text[at] != '#') {
      any_statement = code_on_line = true;
      at = end_of_token(text, at);
      continue;
    }
    const uint64_t end = std::min(text.find('\n', at), text.size());
    std::string_view comment = text.substr(at, end - at);
    const uint64_t comment_at = at;
    at = end;
    const auto skip = [&comment](std::string_view word) {
      const size_t first = comment.find_first_not_of(" \t#");
      if (first == std::string_view::npos || !comment.substr(first).starts_with(word)) return false;
      comment.remove_prefix(first + word.size());
      return true;
    };
    if (!skip(kMark) || !skip("allow")) continue;
    uint64_t from = line, to = end;
    if (!code_on_line && !any_statement) {
      from = 0, to = kEnd;
    } else if (!code_on_line) {
      from = next_token(text, end);
      to = from < text.size() ? end_of_statement(text, from) : from;
    }
    for (size_t i = 0; i < comment.size();) {
      const size_t first = comment.find_first_not_of(" \t,\r", i);
      if (first == std::string_view::npos) break;
      i = std::min(comment.find_first_of(" \t,\r", first), comment.size());
      const std::string name(comment.substr(first, i - first));
      if (const std::string problem = problem_of_allowing(name); problem.empty()) {
        all_.push_back({name, file, from, to});
      } else {
        const uint64_t place = comment_at + (end - comment_at - comment.size()) + first;
        said_.warning({file, place}, problem, suggestion(name, names_that_can_be_allowed()), "warning");
      }
    }
  }
}

bool Allowances::allows(const std::string& name, SourcePos where) const {
  return std::any_of(all_.begin(), all_.end(), [&](const Allowance& a) {
    return a.file == where.file && a.name == name && where.offset >= a.begin && where.offset < a.end;
  });
}

}  // namespace whit
