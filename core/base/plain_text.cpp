#include "core/base/plain_text.h"

#include <algorithm>
#include <cctype>

namespace whit {
namespace {

// How many bytes the UTF-8 character at the start of the text has; 0 where there is none.
size_t character_length(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const size_t length = first >= 0xf5 ? 0 : first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : first >= 0xc2 ? 2 : 0;
  if (length == 0 || length > text.size()) return 0;
  for (size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  // Characters spelt longer than needed, halves of surrogate pairs, and what is beyond Unicode.
  if ((first == 0xe0 && byte(1) < 0xa0) || (first == 0xed && byte(1) > 0x9f)) return 0;
  if ((first == 0xf0 && byte(1) < 0x90) || (first == 0xf4 && byte(1) > 0x8f)) return 0;
  return length;
}

std::string_view escaped(std::string_view character) {
  if (character == "<") return "&lt;";
  if (character == ">") return "&gt;";
  if (character == "&") return "&amp;";
  if (character == "\"") return "&quot;";
  if (character == "'") return "&#39;";
  return character;
}

// The text, each character of it as `of` says.
template <class Of>
std::string each_character(std::string_view text, const Of& of) {
  std::string out;
  for (std::string_view rest = text; !rest.empty();) {
    const size_t length = character_length(rest);
    out += length == 0 ? std::string_view("?") : of(rest.substr(0, length));
    rest.remove_prefix(std::max<size_t>(1, length));
  }
  return out;
}

// Below a space, "delete", and U+0080 to U+009F, which terminals obey too.
bool is_control(std::string_view character) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(character[i]); };
  return byte(0) < 0x20 || byte(0) == 0x7f || (byte(0) == 0xc2 && byte(1) < 0xa0);
}

}  // namespace

std::string one_line(std::string_view text) {
  return each_character(text, [](std::string_view c) { return is_control(c) ? std::string_view(" ") : c; });
}

std::string html_text(std::string_view text) { return each_character(one_line(text), escaped); }

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string quoted_name(std::string_view name) {
  std::string text("\"");
  text.append(name);
  text.append("\"");
  return text;
}

std::string json_message(const std::string& what) {
  const size_t end = what.find("] ");
  std::string text = end == what.npos ? what : what.substr(end + 2);
  // The place is enough: what stands there may be part of a file that is no JSON at all.
  if (const size_t quoted = text.find("; last read: '"); quoted != text.npos) {
    const size_t expected = text.rfind("; expected ");
    text.erase(quoted, expected == text.npos || expected < quoted ? text.npos : expected - quoted);
  }
  constexpr size_t kMost = 300;
  if (text.size() > kMost) text = text.substr(0, kMost) + "...";
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126) c = '?';
  return text;
}

}  // namespace whit
