#include "core/author/document.h"

#include <algorithm>
#include <utility>

namespace whit::author {
namespace {

/// How many bytes the character at `at` takes, and how many units of UTF-16.
struct Character {
  size_t bytes = 1, units = 1;
};

Character character_at(std::string_view text, size_t at) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(at);
  if (lead < 0xc2 || lead > 0xf4) return {};
  const size_t length = lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
  if (at + length > text.size()) return {};
  for (size_t i = 1; i < length; ++i) {
    if ((byte(at + i) & 0xc0) != 0x80) return {};
  }
  return {length, length == 4 ? size_t{2} : size_t{1}};
}

}  // namespace

uint64_t utf16_length(std::string_view utf8) {
  uint64_t units = 0;
  for (size_t at = 0; at < utf8.size();) {
    const Character c = character_at(utf8, at);
    at += c.bytes, units += c.units;
  }
  return units;
}

Document::Document(std::string text, Encoding encoding) : text_(std::move(text)), encoding_(encoding) { find_lines(); }

void Document::find_lines() {
  starts_.assign(1, 0);
  const size_t size = text_.size();
  for (size_t at = 0; at < size; ++at) {
    const char c = text_[at];
    if (c > '\r') continue;  // As nearly all are.
    if (c == '\n' || (c == '\r' && (at + 1 == size || text_[at + 1] != '\n'))) starts_.push_back(at + 1);
  }
}

Span Document::line(size_t number) const {
  if (number >= starts_.size()) return {text_.size(), text_.size()};
  const uint64_t begin = starts_[number];
  uint64_t end = number + 1 < starts_.size() ? starts_[number + 1] : text_.size();
  if (number + 1 < starts_.size()) {
    --end;
    if (end > begin && text_[end] == '\n' && text_[end - 1] == '\r') --end;
  }
  return {begin, end};
}

size_t Document::line_of(uint64_t offset) const {
  return static_cast<size_t>(std::upper_bound(starts_.begin(), starts_.end(), offset) - starts_.begin()) - 1;
}

uint64_t Document::offset(Position at) const {
  const Span whole = line(at.line);
  if (encoding_ == Encoding::Utf8) return std::min(whole.end, whole.begin + at.character);
  const std::string_view text = std::string_view(text_).substr(0, whole.end);
  uint64_t offset = whole.begin;
  for (uint64_t units = 0; offset < whole.end;) {
    const Character c = character_at(text, offset);
    // Between the halves of a character is at its beginning.
    if (units + c.units > at.character) break;
    offset += c.bytes, units += c.units;
  }
  return offset;
}

Position Document::position(uint64_t offset) const {
  offset = std::min<uint64_t>(offset, text_.size());
  const size_t number = line_of(offset);
  const Span whole = line(number);
  const uint64_t character = characters({whole.begin, std::min(offset, whole.end)});
  return {static_cast<uint32_t>(number), static_cast<uint32_t>(character)};
}

uint64_t Document::characters(Span piece) const {
  if (encoding_ == Encoding::Utf8) return piece.size();
  return utf16_length(std::string_view(text_).substr(piece.begin, piece.size()));
}

Position Positions::at(uint64_t offset) {
  // Behind the end of the line it may be another one; and back, or in front of all, it is counted anew.
  if (offset < offset_ || offset > line_.end) {
    position_ = document_.position(offset);
    line_ = document_.line(position_.line);
    offset_ = std::clamp(offset, line_.begin, line_.end);
    return position_;
  }
  position_.character += static_cast<uint32_t>(document_.characters({offset_, offset}));
  offset_ = offset;
  return position_;
}

Span Document::replace(Span old, std::string_view by) {
  text_.replace(old.begin, old.size(), by);
  find_lines();
  return {old.begin, old.begin + by.size()};
}

}  // namespace whit::author
