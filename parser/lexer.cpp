#include "parser/lexer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

namespace whit {

namespace {

enum : uint8_t { kSpace = 1, kDelimiter = 2, kDigit = 4, kNumberStart = 8, kListStop = 16 };

/// Where skip_list() must look: the end of the list, what may hide one, what shows that it was not closed (Include and
/// the Object statements begin with these letters, which no number has).
constexpr char kListStops[] = {']', '[', '"', '#', 'O', 'I'};

constexpr std::array<uint8_t, 256> make_classes() {
  std::array<uint8_t, 256> classes{};
  for (const char c : {' ', '\t', '\n', '\v', '\f', '\r'}) classes[static_cast<uint8_t>(c)] = kSpace | kDelimiter;
  for (const char c : {'[', ']', '"', '#'}) classes[static_cast<uint8_t>(c)] = kDelimiter;
  for (char c = '0'; c <= '9'; ++c) classes[static_cast<uint8_t>(c)] = kDigit | kNumberStart;
  for (const char c : {'+', '-', '.'}) classes[static_cast<uint8_t>(c)] = kNumberStart;
  for (const char c : kListStops) classes[static_cast<uint8_t>(c)] |= kListStop;
  return classes;
}
constexpr std::array<uint8_t, 256> kClasses = make_classes();

bool is(char c, uint8_t what) { return (kClasses[static_cast<uint8_t>(c)] & what) != 0; }

constexpr double kPowersOfTen[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                   1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/// A number too long for the exact short cut of scan_number. Overflow gives infinity, underflow zero.
double convert_slowly(const char* p, const char* stop, int64_t magnitude) {
  if (*p == '+') ++p;
  double value = 0;
  if (std::from_chars(p, stop, value).ec != std::errc::result_out_of_range) return value;
  return magnitude > 0 ? std::numeric_limits<double>::infinity() : 0.0;
}

/// Reads the exponent behind an 'e' into `exponent`; null when there are no digits.
const char* scan_exponent(const char* p, const char* end, int64_t& exponent) {
  const bool negative = p < end && *p == '-';
  if (p < end && (*p == '-' || *p == '+')) ++p;
  const char* digits = p;
  int64_t value = 0;
  for (; p < end && is(*p, kDigit); ++p) value = std::min<int64_t>(value * 10 + (*p - '0'), 1000000);
  exponent += negative ? -value : value;
  return p == digits ? nullptr : p;
}

/// Reads the number at p. Null when the token there is not one number and nothing else.
inline const char* scan_number(const char* p, const char* end, double& value) {
  const char* start = p;
  const bool negative = *p == '-';
  if (*p == '-' || *p == '+') ++p;
  uint64_t mantissa = 0;
  const char* digits = p;
  for (; p < end && is(*p, kDigit); ++p) mantissa = mantissa * 10 + static_cast<uint64_t>(*p - '0');
  int64_t count = p - digits, exponent = 0;
  if (p < end && *p == '.') {
    const char* fraction = ++p;
    for (; p < end && is(*p, kDigit); ++p) mantissa = mantissa * 10 + static_cast<uint64_t>(*p - '0');
    exponent = fraction - p;
    count -= exponent;
  }
  if (count == 0) return nullptr;
  if (p < end && (*p == 'e' || *p == 'E')) {
    p = scan_exponent(p + 1, end, exponent);
    if (!p) return nullptr;
  }
  if (p < end && !is(*p, kDelimiter)) return nullptr;
  // Both factors are exact doubles here, so the one operation rounds correctly (Clinger 1990).
  constexpr uint64_t kExact = uint64_t{1} << 53;
  if (count <= 19 && mantissa <= kExact && exponent >= -22 && exponent <= 22) {
    const auto m = static_cast<double>(mantissa);
    value = exponent < 0 ? m / kPowersOfTen[-exponent] : m * kPowersOfTen[exponent];
    if (negative) value = -value;
  } else {
    value = convert_slowly(start, p, count + exponent);
  }
  return p;
}

/// Reads an integer of up to nine digits at p; null for anything else, which may still be a good number.
inline const char* scan_short_integer(const char* p, const char* end, int32_t& value) {
  const bool negative = *p == '-';
  if (*p == '-' || *p == '+') ++p;
  const char* digits = p;
  int32_t sum = 0;
  for (; p < end && is(*p, kDigit); ++p) {
    if (p - digits == 9) return nullptr;
    sum = sum * 10 + (*p - '0');
  }
  if (p == digits || (p < end && !is(*p, kDelimiter))) return nullptr;
  value = negative ? -sum : sum;
  return p;
}

char resolve_escape(char c) {
  switch (c) {
    case 'b': return '\b';
    case 'f': return '\f';
    case 'n': return '\n';
    case 'r': return '\r';
    case 't': return '\t';
    case '\\':
    case '\'':
    case '"': return c;
    default: return '\0';
  }
}

}  // namespace

Lexer::Lexer(std::string_view text, uint32_t file, Reporter& reporter)
    : begin_(text.data()), end_(text.data() + text.size()), file_(file), reporter_(reporter) {
  if (text.starts_with("\xef\xbb\xbf")) consumed_ = 3;
}

const char* Lexer::pass_comment(const char* p) {
  const char* start = p;
  while (p < end_ && *p != '\n' && *p != '\r') ++p;
  if (comments_)
    comments_->push_back(
        {TokenKind::Word, static_cast<uint64_t>(start - begin_), {start, static_cast<size_t>(p - start)}});
  return p;
}

inline const char* Lexer::skip_space(const char* p) {
  for (;;) {
    while (p < end_ && is(*p, kSpace)) ++p;
    if (p == end_ || *p != '#') return p;
    p = pass_comment(p);
  }
}

Token Lexer::scan_string(const char* p) {
  const char* start = p++;
  const auto token = [&](TokenKind kind) {
    return Token{kind, static_cast<uint64_t>(start - begin_), {start, static_cast<size_t>(p - start)}};
  };
  for (; p < end_ && *p != '\n'; ++p) {
    if (*p == '"') {
      ++p;
      return token(TokenKind::String);
    }
    if (*p == '\\' && p + 1 < end_ && p[1] != '\n') ++p;
  }
  reporter_.error(
      pos(static_cast<uint64_t>(start - begin_)),
      p == end_ ? "string not closed before the end of the file" : "string not closed before the end of the line",
      "add the closing \"");
  return token(TokenKind::Bad);
}

Token Lexer::scan(const char* p) {
  const char* start = p;
  const auto token = [&](TokenKind kind) {
    return Token{kind, static_cast<uint64_t>(start - begin_), {start, static_cast<size_t>(p - start)}};
  };
  if (p == end_) return token(TokenKind::End);
  if (*p == '"') return scan_string(p);
  ++p;
  if (*start == '[') return token(TokenKind::Open);
  if (*start == ']') return token(TokenKind::Close);
  while (p < end_ && !is(*p, kDelimiter)) ++p;
  return token(is(*start, kNumberStart) ? TokenKind::Number : TokenKind::Word);
}

const Token& Lexer::peek() {
  if (!peeked_valid_) {
    peeked_ = scan(skip_space(cursor()));
    peeked_valid_ = true;
  }
  return peeked_;
}

Token Lexer::next() {
  const Token token = peek();
  peeked_valid_ = false;
  consumed_ = token.end();
  return token;
}

void Lexer::consume_to(const char* p) {
  peeked_valid_ = false;
  consumed_ = static_cast<uint64_t>(p - begin_);
}

/// Ends the reading of a list: consumed up to `last`, and the token at p, behind any space, is the next one.
void Lexer::end_list(const char* last, const char* p) {
  consume_to(last);
  peeked_ = scan(p);
  peeked_valid_ = true;
}

std::string Lexer::unquote(const Token& token) {
  const std::string_view inner = token.text.substr(1, token.text.size() - 2);
  if (inner.find('\\') == std::string_view::npos) return std::string(inner);
  std::string out;
  for (size_t i = 0; i < inner.size(); ++i) {
    // The scanner pairs every backslash with what follows, so there always is a next character.
    const char escaped = inner[i] == '\\' ? resolve_escape(inner[i + 1]) : inner[i];
    if (inner[i] == '\\' && escaped != '\0') {
      ++i;
    } else if (inner[i] == '\\') {
      reporter_.error(pos(token.offset + 1 + i), "unknown escape " + in_quotes(inner.substr(i, 2)) + " in a string",
                      "write / between folders, and \\\\ for a backslash");
    }
    out += inner[i] == '\\' && escaped == '\0' ? '\\' : escaped;
  }
  return out;
}

void Lexer::report_bad_number(const char* p) {
  const Token token = scan(p);
  double value = 0;
  const bool overflow = scan_number(p, end_, value) != nullptr;
  const bool comma = token.text.find(',') != std::string_view::npos;
  reporter_.error(pos(token), in_quotes(token.text) + (overflow ? " is too large for a number" : " is not a number"),
                  comma ? "numbers are separated by spaces, their digits by a point" : foreign_characters(token.text));
}

/// Reads the number at p when a comma ends its token, as in "0.5, 0.5", and passes both. Null when that is not so.
const char* Lexer::scan_before_comma(const char* p, double& value) {
  const Token token = scan(p);
  const char* comma = p + token.text.size() - 1;
  if (comma <= p || *comma != ',' || scan_number(p, comma, value) != comma) return nullptr;
  if (!comma_reported_)
    reporter_.warning(pos(token), "a comma behind a number", "commas are passed over; numbers are separated by spaces");
  comma_reported_ = true;
  return comma + 1;
}

bool Lexer::read_number(double& value) {
  const Token token = peek();
  const char* p = begin_ + token.offset;
  const char* behind = scan_number(p, end_, value);
  if (!behind) behind = scan_before_comma(p, value);
  if (behind && std::isfinite(value)) {
    consume_to(behind);
    return true;
  }
  report_bad_number(p);
  return false;
}

template <class T>
void Lexer::reserve_list(std::vector<T>& out, const char* list, const char* p) {
  if (!next_close_ || next_close_ < p) {
    next_close_ = static_cast<const char*>(std::memchr(p, ']', static_cast<size_t>(end_ - p)));
    if (!next_close_) next_close_ = end_;
  }
  const double bytes_each = static_cast<double>(p - list) / static_cast<double>(out.size());
  const double left = static_cast<double>(next_close_ - p) / bytes_each;
  // An eighth more than expected: pages never written cost nothing, moving the list would.
  out.reserve(out.size() + static_cast<size_t>(left * 1.125) + 16);
}

constexpr size_t kSample = 256;  ///< After so many numbers of a list their mean length is a fair estimate.

bool Lexer::read_numbers(std::vector<double>& out) {
  const char* p = cursor();
  const char *list = p, *last = p;
  for (;;) {
    p = skip_space(p);
    if (p == end_ || !is(*p, kNumberStart)) break;
    double value;
    const char* behind = scan_number(p, end_, value);
    if (!behind) behind = scan_before_comma(p, value);
    if (!behind || !(std::abs(value) <= std::numeric_limits<double>::max())) {
      end_list(last, p);
      report_bad_number(p);
      return false;
    }
    out.push_back(value);
    p = last = behind;
    if (out.size() == kSample) reserve_list(out, list, p);
  }
  end_list(last, p);
  return true;
}

bool Lexer::read_odd_integer(const char* p, const char*& behind, int32_t& value, bool& warned) {
  double number = 0;
  behind = scan_number(p, end_, number);
  if (!behind) behind = scan_before_comma(p, number);
  const Token token = scan(p);
  if (!behind) {
    report_bad_number(p);
    return false;
  }
  const double cut = std::trunc(number);
  if (!(cut >= std::numeric_limits<int32_t>::min() && cut <= std::numeric_limits<int32_t>::max())) {
    reporter_.error(pos(token), "integer " + in_quotes(token.text) + " is out of range",
                    "integers go from -2147483648 to 2147483647");
    return false;
  }
  value = static_cast<int32_t>(cut);
  if (cut != number && !warned) {
    warned = true;
    reporter_.warning(pos(token), "the integer " + in_quotes(token.text) + " has a fraction",
                      "it is cut off: " + std::to_string(value) + " is used");
  }
  return true;
}

bool Lexer::read_integers(std::vector<int32_t>& out) {
  const char* p = cursor();
  const char *list = p, *last = p;
  bool warned = false;
  for (;;) {
    p = skip_space(p);
    if (p == end_ || !is(*p, kNumberStart)) break;
    int32_t value = 0;
    const char* behind = scan_short_integer(p, end_, value);
    if (!behind && !read_odd_integer(p, behind, value, warned)) {
      end_list(last, p);
      return false;
    }
    out.push_back(value);
    p = last = behind;
    if (out.size() == kSample) reserve_list(out, list, p);
  }
  end_list(last, p);
  return true;
}

namespace {

/// The first character in [p, end) that is in kListStops.
const char* find_list_stop(const char* p, const char* end) {
  // Block by block, without a way out inside and with minima instead of comparisons: of that all compilers make vector
  // code.
  constexpr ptrdiff_t kBlock = 64;
  for (; end - p >= kBlock; p += kBlock) {
    uint8_t least = 255;
    for (ptrdiff_t i = 0; i < kBlock; ++i)
      for (const char stop : kListStops) least = std::min(least, static_cast<uint8_t>(p[i] ^ stop));
    if (least == 0) break;
  }
  while (p < end && !is(*p, kListStop)) ++p;
  return p;
}

}  // namespace

bool Lexer::skip_list() {
  const char* p = cursor();
  for (;;) {
    p = find_list_stop(p, end_);
    consume_to(p);
    if (p == end_) return false;
    if (*p == '#') {
      p = pass_comment(p);
      continue;
    }
    const Token token = next();
    if (token.kind == TokenKind::Close) return true;
    if (token.kind != TokenKind::String) return false;
    p = begin_ + token.end();
  }
}

void Lexer::resynchronise(bool (*starts_statement)(std::string_view)) {
  const char* p = skip_space(cursor());
  const Token here = peeked_valid_ ? peeked_ : Token{};
  if (here.kind == TokenKind::Word && starts_statement(here.text)) return;
  const char* line = p;
  while (line > begin_ && is(line[-1], kSpace) && line[-1] != '\n') --line;
  bool at_line_start = line == begin_ || line[-1] == '\n';
  for (;;) {
    const char* word = p;
    while (word < end_ && !is(*word, kDelimiter)) ++word;
    if (at_line_start && starts_statement({p, static_cast<size_t>(word - p)})) break;
    const void* newline = std::memchr(p, '\n', static_cast<size_t>(end_ - p));
    if (!newline) {
      p = end_;
      break;
    }
    p = static_cast<const char*>(newline) + 1;
    while (p < end_ && is(*p, kSpace)) ++p;
    at_line_start = true;
  }
  consume_to(p);
}

std::string_view token_at(std::string_view text, uint64_t offset) {
  if (offset >= text.size()) return {};
  Diagnostics ignored;
  Reporter reporter(ignored);
  Lexer lexer(text.substr(offset), 0, reporter);
  const Token& token = lexer.peek();
  return token.offset == 0 ? token.text : std::string_view();
}

SourcePos value_position(const Sources& sources, const Parameter& parameter, size_t i) {
  const std::string_view text = sources.text(parameter.values_at.file);
  if (parameter.values_at.offset >= text.size()) return parameter.values_at;
  Diagnostics ignored;
  Reporter reporter(ignored);
  const uint64_t start = parameter.values_at.offset;
  Lexer lexer(text.substr(start), parameter.values_at.file, reporter);
  if (lexer.peek().kind != TokenKind::Open) return parameter.values_at;
  lexer.next();
  for (size_t n = 0;; ++n) {
    const Token token = lexer.next();
    if (token.kind != TokenKind::Number && token.kind != TokenKind::String) return parameter.values_at;
    if (n == i) return {parameter.values_at.file, start + token.offset};
  }
}

}  // namespace whit
