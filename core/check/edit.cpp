#include "core/check/edit.h"

#include "parser/lexer.h"

namespace whit {
namespace {

bool is_part_of_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// Where a word stands in a token by itself, the last time: of `"float float"` it is the name, not the type.
size_t find_word(std::string_view token, std::string_view word) {
  for (size_t at = token.rfind(word); at != std::string_view::npos;
       at = at > 0 ? token.rfind(word, at - 1) : token.npos) {
    const size_t end = at + word.size();
    const bool begins = at == 0 || !is_part_of_word(token[at - 1]) || !is_part_of_word(word.front());
    const bool ends = end == token.size() || !is_part_of_word(token[end]) || !is_part_of_word(word.back());
    if (begins && ends) return at;
  }
  return std::string_view::npos;
}

}  // namespace

std::optional<Edit> edit_of(const Sources& sources, const Diagnostic& diagnostic) {
  const auto& [written, meant] = diagnostic.slip;
  if (!diagnostic.slip.known() || written.empty() || !diagnostic.where.known()) return std::nullopt;
  const std::string_view text = sources.text(diagnostic.where.file);
  if (diagnostic.where.offset >= text.size()) return std::nullopt;
  const size_t at = find_word(token_at(text, diagnostic.where.offset), written);
  if (at == std::string_view::npos) return std::nullopt;
  const uint64_t begin = diagnostic.where.offset + at;
  return Edit{diagnostic.where.file, begin, begin + written.size(), meant};
}

std::string edited(std::string_view text, const std::vector<Edit>& edits) {
  std::string out;
  uint64_t done = 0;
  for (const Edit& edit : edits) {
    out.append(text.substr(done, edit.begin - done)).append(edit.text);
    done = edit.end;
  }
  return out.append(text.substr(done));
}

}  // namespace whit
