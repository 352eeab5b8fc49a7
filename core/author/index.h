// What a file says where: its statements and the names in them, kept up to date while the file is edited.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/author/document.h"
#include "parser/statements.h"

namespace whit::author {

/// What has a name in scene files.
enum class NameKind : uint8_t {
  FloatTexture,
  ColourTexture,
  AnyTexture,
  Material,
  Object,
  CoordinateSystem,
  Medium,
  Include,
  Asset
};

/// A name in a file, where it is given a meaning or used.
struct Mention {
  NameKind kind = NameKind::Material;
  bool defines = false;
  Span at;  ///< The string with its quotes.
  std::string name;
};

/// A statement; what it says beside its names is read again when somebody asks.
struct Item {
  const StatementRow* row = nullptr;  ///< Null where it cannot be read.
  Span at;
};

/// The statements of one text, in order, and the names in them.
class FileIndex {
 public:
  explicit FileIndex(std::string_view text = {}) { renew(text, {0, 0}, 0); }

  /// The text has changed: what was `old` has `length` bytes now. What is far from it is not read again.
  void update(std::string_view text, Span old, uint64_t length) { renew(text, old, length); }

  const std::vector<Item>& items() const { return items_; }
  const std::vector<Mention>& mentions() const { return mentions_; }

  /// The last statement that begins at or before an offset, or items().size() when there is none.
  size_t item_at(uint64_t offset) const;
  /// The first of the mentions at or behind an offset.
  size_t first_mention(uint64_t offset) const;
  const Mention* mention_at(uint64_t offset) const;

  bool begins_world() const { return has("WorldBegin"); }
  bool ends_world() const { return has("WorldEnd"); }

 private:
  bool has(std::string_view directive) const;
  void renew(std::string_view text, Span old, uint64_t length);

  std::vector<Item> items_;
  std::vector<Mention> mentions_;
};

/// Reads the statement that begins at an offset; its places are those of `text`, in file 0. False when it is broken.
bool read_at(std::string_view text, uint64_t offset, Statement& out);

/// Where the values of a parameter are: the strings or numbers of its list, one by one.
std::vector<Span> value_spans(std::string_view text, const Parameter& parameter);

/// A string that begins at an offset, quotes included, even where it has no end.
Span string_at(std::string_view text, uint64_t offset);

}  // namespace whit::author
