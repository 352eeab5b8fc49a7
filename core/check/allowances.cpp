#include "core/check/allowances.h"

#include <algorithm>
#include <limits>
#include <optional>
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

/// A comment and what stands before it.
struct Comment {
  uint64_t at = 0, end = 0;
  uint64_t line = 0;             ///< Where its line begins.
  bool behind_code = false;      ///< On the same line.
  bool after_statement = false;  ///< Of the file.
};

template <class F>
void for_comments(std::string_view text, const F& f) {
  Comment here;
  for (uint64_t at = 0; at < text.size();) {
    if (text[at] == '\n') {
      here.line = ++at, here.behind_code = false;
    } else if (is_space(text[at])) {
      ++at;
    } else if (text[at] == '#') {
      here.at = at, here.end = at = std::min(text.find('\n', at), text.size());
      f(here);
    } else {
      here.behind_code = here.after_statement = true;
      at = end_of_token(text, at);
    }
  }
}

/// Where the names begin behind "# whit: allow", from the comment's beginning; nothing for other comments.
std::optional<size_t> names_of(std::string_view comment) {
  size_t at = 0;
  for (const std::string_view word : {kMark, std::string_view("allow")}) {
    at = comment.find_first_not_of(" \t#", at);
    if (at == std::string_view::npos || !comment.substr(at).starts_with(word)) return std::nullopt;
    at += word.size();
  }
  return at;
}

/// What a comment is about: its line, the next statement, or before all statements the file.
std::pair<uint64_t, uint64_t> reach_of(std::string_view text, const Comment& comment) {
  if (comment.behind_code) return {comment.line, comment.end};
  if (!comment.after_statement) return {0, kEnd};
  const uint64_t from = next_token(text, comment.end);
  return {from, from < text.size() ? end_of_statement(text, from) : from};
}

}  // namespace

Allowances::Allowances(const Sources& sources) {
  for (uint32_t file = 0; file < sources.size(); ++file) read(file, sources.text(file));
}

void Allowances::read(uint32_t file, std::string_view text) {
  // Nearly no file has one: whoever has none pays for a search or two. What is no text may be large, and is not searched.
  if (!why_not_text(text).empty() || text.find(kMark) == std::string_view::npos) return;
  for_comments(text, [&](const Comment& comment) {
    const std::string_view words = text.substr(comment.at, comment.end - comment.at);
    const std::optional<size_t> names = names_of(words);
    if (!names) return;
    const auto [from, to] = reach_of(text, comment);
    for (size_t first = *names; (first = words.find_first_not_of(" \t,\r", first)) != std::string_view::npos;) {
      const size_t end = std::min(words.find_first_of(" \t,\r", first), words.size());
      take({std::string(words.substr(first, end - first)), file, from, to}, comment.at + first);
      first = end;
    }
  });
}

void Allowances::take(Allowance allowance, uint64_t place) {
  const std::string problem = problem_of_allowing(allowance.name);
  if (problem.empty()) {
    all_.push_back(std::move(allowance));
  } else {
    said_.warning({allowance.file, place}, problem, suggestion(allowance.name, names_that_can_be_allowed()), "warning");
  }
}

bool Allowances::allows(const std::string& name, SourcePos where) const {
  return std::any_of(all_.begin(), all_.end(), [&](const Allowance& a) {
    return a.file == where.file && a.name == name && where.offset >= a.begin && where.offset < a.end;
  });
}

}  // namespace whit
