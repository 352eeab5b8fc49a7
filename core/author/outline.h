// How a scene file is laid out: its blocks, what can be folded, and what each word is.
#pragma once

#include <string>
#include <vector>

#include "core/author/workspace.h"

namespace whit::author {

/// A block, a definition or a statement worth finding.
struct OutlineSymbol {
  enum class Kind : uint8_t {
    World,
    Block,
    Object,
    Material,
    Texture,
    Shape,
    Light,
    Camera,
    Option,
    File
  } kind = Kind::Block;
  std::string name, detail;
  Span whole, at;
  std::vector<OutlineSymbol> children;
};
std::vector<OutlineSymbol> outline(const File& file);

struct Fold {
  uint32_t first_line = 0, last_line = 0;
  bool comment = false;
};
std::vector<Fold> folds(const File& file);

/// What a word is.
enum class WordKind : uint8_t { Directive, Plugin, Type, Parameter, Name, String, Number, Keyword, Comment };
struct ColouredWord {
  Span at;
  WordKind kind = WordKind::Number;
  bool defines = false;
};
/// The words of a span of a file, in order; none goes over the end of a line.
std::vector<ColouredWord> words(const File& file, Span span);

}  // namespace whit::author
