#include "core/compare/junit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace whit {
namespace {

/// The character that begins at text[at], of `length` bytes; length 0 when these bytes are no UTF-8.
struct Character {
  uint32_t code = 0;
  size_t length = 0;
};

Character character_at(std::string_view text, size_t at) {
  const auto byte = [&](size_t i) { return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0u; };
  const unsigned first = byte(0);
  const size_t length = first < 0x80                    ? 1
                        : first >= 0xc2 && first < 0xe0 ? 2
                        : first >> 4 == 0xe             ? 3
                        : first < 0xf5                  ? 4
                                                        : 0;
  if (length == 0 || (first >= 0x80 && first < 0xc2)) return {};
  uint32_t code = length == 1 ? first : first & (0x7fu >> length);
  for (size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3f);
  }
  // Longer than need be, halves of pairs of UTF-16, beyond Unicode's end.
  constexpr uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  if (code < kLeast[length] || (code >= 0xd800 && code < 0xe000) || code > 0x10ffff) return {};
  return {code, length};
}

/// What XML 1.0 has no place for, in any spelling.
bool is_forbidden(uint32_t code) {
  return (code < 0x20 && code != '\t' && code != '\n' && code != '\r') || code == 0xfffe || code == 0xffff;
}

/// Text between tags, or in an attribute, where white space would become blanks.
enum class Place : uint8_t { Text, Attribute };

std::string xml(std::string_view text, Place place) {
  std::string out;
  for (size_t i = 0; i < text.size();) {
    const Character c = character_at(text, i);
    const size_t length = std::max<size_t>(c.length, 1);
    const bool white = c.code == '\r' || (place == Place::Attribute && (c.code == '\t' || c.code == '\n'));
    if (c.length == 0 || is_forbidden(c.code)) {
      for (size_t k = 0; k < length; ++k) out += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[i + k]));
    } else if (c.code == '<' || c.code == '>' || c.code == '&' || c.code == '"' || white) {
      out += fmt::format("&#{};", c.code);
    } else {
      out += text.substr(i, length);
    }
    i += length;
  }
  return out;
}

std::string attribute(std::string_view text) { return xml(text, Place::Attribute); }

/// Neither schema has room for infinities.
double finite_seconds(double seconds) { return std::isfinite(seconds) ? std::clamp(seconds, 0.0, 1e9) : 0; }

std::string outcome(const char* element, const std::string& type, const std::string& message,
                    const std::string& details) {
  if (message.empty()) return {};
  return fmt::format("      <{0}{1} message=\"{2}\">{3}</{0}>\n", element,
                     type.empty() ? "" : fmt::format(" type=\"{}\"", type), attribute(message),
                     xml(details, Place::Text));
}

/// A case has one outcome: that it could not be compared goes before all.
std::string case_text(const std::string& suite, const JUnitCase& c) {
  const std::string inside = !c.error.empty()     ? outcome("error", "cannot compare", c.error, c.details)
                             : !c.failure.empty() ? outcome("failure", "differs", c.failure, c.details)
                                                  : outcome("skipped", "", c.skipped, "");
  const std::string start = fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"", attribute(suite),
                                        attribute(c.name), finite_seconds(c.seconds));
  return inside.empty() ? start + "/>\n" : start + ">\n" + inside + "    </testcase>\n";
}

}  // namespace

std::string junit_text(const std::string& suite, const std::vector<JUnitCase>& cases, const std::string& time_stamp) {
  size_t errors = 0, failures = 0, skipped = 0;
  double seconds = 0;
  std::string body, passed;
  for (const JUnitCase& c : cases) {
    if (!c.error.empty()) ++errors;
    else if (!c.failure.empty()) ++failures;
    else if (!c.skipped.empty()) ++skipped;
    else if (!c.details.empty()) passed += c.name + "\n" + c.details + (c.details.back() == '\n' ? "" : "\n");
    seconds += finite_seconds(c.seconds);
    body += case_text(suite, c);
  }
  const std::string name = suite.empty() ? "whit diff" : suite;
  // Ant's schema wants each of these, a case with one outcome and no output of its own, and no attribute outside.
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
      "  <testsuite name=\"{}\" package=\"whit\" id=\"0\" timestamp=\"{}\" hostname=\"localhost\" tests=\"{}\" "
      "failures=\"{}\" errors=\"{}\" skipped=\"{}\" time=\"{:.3f}\">\n    <properties/>\n{}    "
      "<system-out>{}</system-out>\n    <system-err/>\n  </testsuite>\n</testsuites>\n",
      attribute(name), attribute(time_stamp), cases.size(), failures, errors, skipped, seconds, body,
      xml(passed, Place::Text));
}

}  // namespace whit
