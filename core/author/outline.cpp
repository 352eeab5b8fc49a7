#include "core/author/outline.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/author/vocabulary.h"
#include "parser/lexer.h"

namespace whit::author {
namespace {

using Kind = OutlineSymbol::Kind;

std::optional<Kind> kind_of(const StatementRow& row) {
  static constexpr std::pair<std::string_view, Kind> kRows[] = {{"WorldBegin", Kind::World},
                                                                {"AttributeBegin", Kind::Block},
                                                                {"TransformBegin", Kind::Block},
                                                                {"ObjectBegin", Kind::Object},
                                                                {"ObjectInstance", Kind::Object},
                                                                {"Texture", Kind::Texture},
                                                                {"Material", Kind::Material},
                                                                {"MakeNamedMaterial", Kind::Material},
                                                                {"Shape", Kind::Shape},
                                                                {"LightSource", Kind::Light},
                                                                {"AreaLightSource", Kind::Light},
                                                                {"Camera", Kind::Camera},
                                                                {"Film", Kind::Option},
                                                                {"Sampler", Kind::Option},
                                                                {"Integrator", Kind::Option},
                                                                {"PixelFilter", Kind::Option},
                                                                {"Filter", Kind::Option},
                                                                {"Include", Kind::File},
                                                                {"MakeNamedMedium", Kind::Material}};
  for (const auto& [name, kind] : kRows) {
    if (name == row.name) return kind;
  }
  return std::nullopt;
}

/// Nobody opens more blocks in one another by hand, and whoever shows them goes down one by one.
constexpr size_t kDeepest = 100;
/// Nor does anybody look for one of more than this in one block, and an editor would take seconds to show them.
constexpr size_t kMostOfBlock = 5000;

bool opens(const StatementRow& row) { return row.nesting > 0 || row.name == "WorldBegin"; }
bool closes(const StatementRow& row) { return row.nesting < 0 || row.name == "WorldEnd"; }

/// The first string of a statement without its quotes, found without reading the rest.
std::string first_string(std::string_view text, const Item& item) {
  const size_t quote = text.substr(0, item.at.end).find('"', item.at.begin);
  if (quote == std::string_view::npos) return {};
  const Span at = string_at(text, quote);
  return std::string(text.substr(at.begin + 1, at.size() < 2 ? 0 : at.size() - 2));
}

OutlineSymbol symbol_of(std::string_view text, const Item& item, Kind kind) {
  OutlineSymbol out;
  out.kind = kind;
  const std::string name = first_string(text, item);
  const std::string directive(item.row->name);
  const bool named = !name.empty() && !opens(*item.row);
  out.name = named || kind == Kind::Object ? name : directive;
  if (out.name.empty()) out.name = directive;
  out.detail = out.name == directive ? "" : directive;
  out.whole = item.at;
  out.at = {item.at.begin, item.at.begin + directive.size()};
  return out;
}

}  // namespace

std::vector<OutlineSymbol> outline(const File& file) {
  std::vector<OutlineSymbol> stack(1);
  const auto add = [&](OutlineSymbol symbol) {
    std::vector<OutlineSymbol>& beside = stack.back().children;
    if (beside.size() < kMostOfBlock) beside.push_back(std::move(symbol));
  };
  const auto close = [&](uint64_t end) {
    OutlineSymbol done = std::move(stack.back());
    stack.pop_back();
    done.whole.end = end;
    add(std::move(done));
  };
  uint64_t end = 0;
  size_t too_deep = 0;  ///< Blocks that are open and not shown.
  for (const Item& item : file.index.items()) {
    end = item.at.end;
    if (!item.row) continue;
    if (closes(*item.row)) {
      const bool world = item.row->name == "WorldEnd";
      if (world) too_deep = 0;
      if (too_deep > 0) {
        --too_deep;
        continue;
      }
      // The end of the world ends what is open in it.
      while (world && stack.size() > 1 && stack.back().kind != Kind::World) close(item.at.begin);
      if (stack.size() > 1 && (world || stack.back().kind != Kind::World)) close(end);
      continue;
    }
    const std::optional<Kind> kind = kind_of(*item.row);
    if (!kind) continue;
    OutlineSymbol symbol = symbol_of(file.text(), item, *kind);
    if (opens(*item.row) && stack.size() > kDeepest) ++too_deep;
    else if (opens(*item.row)) stack.push_back(std::move(symbol));
    else add(std::move(symbol));
  }
  while (stack.size() > 1) close(end);
  return std::move(stack.front().children);
}

std::vector<Fold> folds(const File& file) {
  std::vector<Fold> out;
  const auto line = [&](uint64_t offset) { return static_cast<uint32_t>(file.document.line_of(offset)); };
  const auto add = [&](uint32_t first, uint32_t last, bool comment) {
    if (last > first) out.push_back({first, last, comment});
  };
  std::vector<std::pair<uint32_t, bool>> open;  // line, and whether it is the world's
  for (const Item& item : file.index.items()) {
    if (!item.row) continue;
    const uint32_t first = line(item.at.begin);
    if (opens(*item.row)) {
      open.push_back({first, item.row->name == "WorldBegin"});
    } else if (closes(*item.row)) {
      const bool world = item.row->name == "WorldEnd";
      while (world && !open.empty() && !open.back().second) open.pop_back();
      // The line of the end stays to be seen.
      if (!open.empty() && open.back().second == world) {
        add(open.back().first, std::max(first, uint32_t{1}) - 1, false);
        open.pop_back();
      }
    } else if (item.at.size() > 1) {
      add(first, line(item.at.end - 1), false);
    }
  }
  // Lines that hold nothing but a comment, one below another.
  uint32_t run = 0;
  const auto lines = static_cast<uint32_t>(file.document.lines());
  for (uint32_t i = 0; i <= lines; ++i) {
    const Span at = file.document.line(i);
    const std::string_view text = file.text().substr(at.begin, at.size());
    const size_t start = text.find_first_not_of(" \t");
    const bool comment = i < lines && start != std::string_view::npos && text[start] == '#';
    if (comment) {
      ++run;
    } else if (run > 0) {
      add(i - run, i - 1, true);
      run = 0;
    }
  }
  std::sort(out.begin(), out.end(), [](const Fold& a, const Fold& b) {
    return a.first_line != b.first_line ? a.first_line < b.first_line : a.last_line > b.last_line;
  });
  return out;
}

namespace {

/// Sorts the tokens of a file by what they mean, statement by statement.
class WordReader {
 public:
  explicit WordReader(std::string_view text) : text_(text) {}

  void pass(const Token& token) {
    switch (token.kind) {
      case TokenKind::Word: word(token); break;
      case TokenKind::Number: put({token.offset, token.end()}, WordKind::Number); break;
      case TokenKind::String:
      case TokenKind::Bad: string(token); break;
      case TokenKind::Open: in_list_ = true; break;
      case TokenKind::Close: in_list_ = value_ = false; break;
      case TokenKind::End: break;
    }
    if (token.kind == TokenKind::Number && !in_list_) value_ = false;
  }
  void comment(const Token& token) { put({token.offset, token.end()}, WordKind::Comment); }

  std::vector<ColouredWord> take() {
    std::sort(out_.begin(), out_.end(), [](const auto& a, const auto& b) { return a.at.begin < b.at.begin; });
    return std::move(out_);
  }

 private:
  void put(Span at, WordKind kind, bool defines = false) {
    if (at.end > at.begin) out_.push_back({at, kind, defines});
  }

  void word(const Token& token) {
    row_ = find_statement(token.text);
    if (row_) strings_ = 0, value_ = in_list_ = false;
    put({token.offset, token.end()}, row_ ? WordKind::Directive : WordKind::Keyword);
  }

  void string(const Token& token) {
    const Span at{token.offset, token.end()};
    if (!row_ || value_) {
      const std::string_view inside = token.text.substr(1, token.text.size() < 2 ? 0 : token.text.size() - 2);
      const bool truth = inside == "true" || inside == "false";
      put(at, truth ? WordKind::Keyword : name_follows_ ? WordKind::Name : WordKind::String);
      if (!in_list_) value_ = false;
      return;
    }
    if (strings_ < row_->arguments.max_strings) {
      const int index = strings_++;
      const bool plugin = index == plugin_string(row_->name);
      const bool defines = index == 0 && (row_->name == "Texture" || row_->name.starts_with("MakeNamed") ||
                                          row_->name == "ObjectBegin" || row_->name == "CoordinateSystem");
      const bool type = row_->name == "Texture" && index == 1;
      put(at,
          plugin                    ? WordKind::Plugin
          : type                    ? WordKind::Type
          : row_->name == "Include" ? WordKind::String
                                    : WordKind::Name,
          defines);
      return;
    }
    declaration(token);
  }

  /// "type name", the quotes going with what is beside them.
  void declaration(const Token& token) {
    const std::string_view t = token.text;
    const size_t space = t.find_first_of(" \t");
    const size_t name = space == std::string_view::npos ? space : t.find_first_not_of(" \t", space);
    value_ = true;
    name_follows_ = t.substr(1).starts_with("texture") || t.find("namedmaterial") != std::string_view::npos;
    if (name == std::string_view::npos) return put({token.offset, token.end()}, WordKind::String);
    put({token.offset, token.offset + space}, WordKind::Type);
    put({token.offset + name, token.end()}, WordKind::Parameter);
  }

  std::string_view text_;
  const StatementRow* row_ = nullptr;
  int strings_ = 0;
  bool value_ = false, in_list_ = false, name_follows_ = false;
  std::vector<ColouredWord> out_;
};

}  // namespace

std::vector<ColouredWord> words(const File& file, Span span) {
  Diagnostics ignored;
  Reporter reporter(ignored);
  std::vector<Token> comments;
  Lexer lexer(file.text(), 0, reporter);
  lexer.collect_comments(&comments);
  const size_t item = file.index.item_at(span.begin);
  if (item < file.index.items().size()) lexer.start_at(file.index.items()[item].at.begin);
  WordReader reader(file.text());
  while (lexer.peek().kind != TokenKind::End && lexer.peek().offset < span.end) reader.pass(lexer.next());
  for (const Token& c : comments) {
    if (c.offset < span.end) reader.comment(c);
  }
  std::vector<ColouredWord> out = reader.take();
  std::erase_if(out, [span](const ColouredWord& w) { return w.at.end <= span.begin || w.at.begin >= span.end; });
  return out;
}

}  // namespace whit::author
