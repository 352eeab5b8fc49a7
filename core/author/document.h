// The text of a file as an editor has it: edited piece by piece, its places counted as the protocol of language servers
// counts them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace whit::author {

/// What a character is where places are counted: a byte, or a unit of UTF-16.
enum class Encoding : uint8_t { Utf8, Utf16 };

/// Line and character, both from 0.
struct Position {
  uint32_t line = 0, character = 0;
  bool operator==(const Position&) const = default;
  auto operator<=>(const Position&) const = default;
};

/// Bytes of a text, from the first to the one behind the last.
struct Span {
  uint64_t begin = 0, end = 0;
  uint64_t size() const { return end - begin; }
  bool holds(uint64_t offset) const { return offset >= begin && offset <= end; }
  bool operator==(const Span&) const = default;
};

/// A text and where its lines begin; lines end at \n, \r\n or \r.
class Document {
 public:
  explicit Document(std::string text = {}, Encoding encoding = Encoding::Utf16);

  const std::string& text() const { return text_; }

  /// The byte of a position: the end of its line where the line is shorter, the end of the text behind the last line.
  uint64_t offset(Position at) const;
  Position position(uint64_t offset) const;
  /// How many characters a piece of a line has.
  uint64_t characters(Span piece) const;

  /// Puts other text in the place of a span. Returns where the text differs now.
  Span replace(Span old, std::string_view by);

  size_t lines() const { return starts_.size(); }
  /// A line without its end.
  Span line(size_t number) const;
  size_t line_of(uint64_t offset) const;

 private:
  void find_lines();

  std::string text_;
  Encoding encoding_;
  std::vector<uint64_t> starts_;
};

/// How many units of UTF-16 some UTF-8 takes; a byte that is none of UTF-8 takes one.
uint64_t utf16_length(std::string_view utf8);

/// Positions of offsets that mostly ascend, each counted from the one before.
class Positions {
 public:
  explicit Positions(const Document& document) : document_(document) {}
  Position at(uint64_t offset);

 private:
  const Document& document_;
  uint64_t offset_ = 0;
  Position position_;
  Span line_;
};

}  // namespace whit::author
