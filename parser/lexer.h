// Tokens of the pbrt file format, and lists of numbers straight into vectors.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/diagnostics.h"
#include "core/base/parameter.h"
#include "parser/reporter.h"
#include "parser/source.h"

namespace whit {

enum class TokenKind : uint8_t {
  End,     ///< The end of the file.
  Word,    ///< A directive, or any other unquoted word that does not start as a number does.
  Number,  ///< Starts with a digit, sign or point; not yet known to be well-formed.
  String,  ///< Quoted; the text includes the quotes.
  Open,    ///< [
  Close,   ///< ]
  Bad,     ///< A string that is not closed on its line; reported when the token is read.
};

struct Token {
  TokenKind kind = TokenKind::End;
  uint64_t offset = 0;    ///< Of its first byte in the file.
  std::string_view text;  ///< Points into the file.
  uint64_t end() const { return offset + text.size(); }
};

/// Reads one file token by token. Comments (# to the end of the line) count as space.
class Lexer {
 public:
  /// `text` must outlive the lexer. A byte-order mark at its start is skipped.
  Lexer(std::string_view text, uint32_t file, Reporter& reporter);

  /// Goes on at another byte, where a token begins or may begin.
  void start_at(uint64_t offset) { consumed_ = offset, peeked_valid_ = false; }

  /// The next token, left where it is.
  const Token& peek();

  /// The next token, consumed.
  Token next();

  /// The byte behind the last thing consumed.
  uint64_t consumed() const { return consumed_; }

  SourcePos pos(uint64_t offset) const { return {file_, offset}; }
  SourcePos pos(const Token& token) const { return {file_, token.offset}; }
  std::string_view text() const { return {begin_, static_cast<size_t>(end_ - begin_)}; }
  Reporter& reporter() { return reporter_; }

  /// The value of a String token: without quotes, escapes resolved. An unknown escape is an error and kept as is.
  std::string unquote(const Token& token);

  /// Consumes one number, or reports what is wrong with it: false, and it is left where it is.
  bool read_number(double& value);

  /// Appends every number up to the first token that is none. False when one is malformed or not finite:
  /// reported, and left where it is. A comma right behind a number is passed over, as by pbrt, with a warning.
  bool read_numbers(std::vector<double>& out);

  /// The same for 32-bit integers. A fraction is cut off, as pbrt does, with one warning a list; a number
  /// that does not fit is an error.
  bool read_integers(std::vector<int32_t>& out);

  /// Consumes the rest of a list whose [ was the last token, its ] included, without a look at the values. False, and
  /// somewhere inside, when it is not closed or holds what no list does, such as another [ or a directive.
  bool skip_list();

  /// Moves on to the next place where a statement may start: here if the next token is a directive, else the
  /// first line that begins with a word for which `starts_statement` holds, else the end of the file.
  void resynchronise(bool (*starts_statement)(std::string_view));

  /// From now on every comment passed over is appended to `comments` (null: no longer).
  void collect_comments(std::vector<Token>* comments) { comments_ = comments; }

 private:
  const char* skip_space(const char* p);
  const char* pass_comment(const char* p);
  Token scan(const char* p);
  Token scan_string(const char* p);
  void consume_to(const char* p);
  void end_list(const char* last, const char* p);
  void report_bad_number(const char* p);
  const char* scan_before_comma(const char* p, double& value);
  bool read_odd_integer(const char* p, const char*& behind, int32_t& value, bool& warned);
  /// Where reading goes on: the token peeked at, or behind the last one consumed.
  const char* cursor() const { return begin_ + (peeked_valid_ ? peeked_.offset : consumed_); }
  template <class T>
  void reserve_list(std::vector<T>& out, const char* list, const char* p);

  const char* begin_;
  const char* end_;
  uint32_t file_;
  Reporter& reporter_;
  uint64_t consumed_ = 0;
  Token peeked_;
  bool peeked_valid_ = false;
  bool comma_reported_ = false;
  std::vector<Token>* comments_ = nullptr;
  const char* next_close_ = nullptr;  ///< The first ] at or behind the place where one was last looked for.
};

/// The word, number or string that begins at a byte of a file, quotes included; "" where none does.
std::string_view token_at(std::string_view text, uint64_t offset);

/// Where the i-th value of a parameter is in its file, counted as tokens in the list: found by reading the list
/// again, so that it costs nothing to know. The start of the values when there is no such value.
SourcePos value_position(const Sources& sources, const Parameter& parameter, size_t i);

}  // namespace whit
