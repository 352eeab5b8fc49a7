// libFuzzer entry: any bytes are read token by token, in every way that the lexer has. It must always get on, and what it
// returns must lie in the text.
#include "parser/lexer.h"
#include "tests/fuzz/shared/fuzz.h"

namespace {

using whit::fuzz::require;

bool starts_statement(std::string_view word) { return word == "Shape" || word == "Include"; }

/// Reads on behind a token in one of the ways that suit it. `turn` goes through them.
void read_on(whit::Lexer& lexer, const whit::Token& token, unsigned turn) {
  std::vector<double> numbers;
  std::vector<int32_t> integers;
  switch (token.kind) {
    case whit::TokenKind::String: lexer.unquote(token); break;
    case whit::TokenKind::Open:
      if (turn % 3 == 0) lexer.skip_list();
      if (turn % 3 == 1) lexer.read_numbers(numbers);
      if (turn % 3 == 2) lexer.read_integers(integers);
      break;
    case whit::TokenKind::Bad: lexer.resynchronise(starts_statement); break;
    default: break;
  }
  for (const double v : numbers) require(v - v == 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  whit::Diagnostics said;
  whit::Reporter reporter(said);
  whit::Lexer lexer(text, 0, reporter);
  std::vector<whit::Token> comments;
  if (size % 2 == 0) lexer.collect_comments(&comments);
  for (unsigned turn = 0;; ++turn) {
    const uint64_t before = lexer.consumed();
    const whit::Token token = lexer.peek();
    if (token.kind == whit::TokenKind::End) break;
    require(token.offset >= before && token.end() <= size && !token.text.empty());
    double number = 0;
    if (token.kind == whit::TokenKind::Number && lexer.read_number(number)) continue;
    require(lexer.next().offset == token.offset);
    read_on(lexer, token, turn);
    require(lexer.consumed() >= token.end() && lexer.consumed() <= size);
  }
  for (const whit::Token& comment : comments) require(comment.end() <= size && comment.text.front() == '#');
  reporter.finish();
  return 0;
}
