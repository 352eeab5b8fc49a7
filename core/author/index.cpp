#include "core/author/index.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/author/vocabulary.h"

namespace whit::author {
namespace {

/// Collects the names in statements.
class MentionFinder {
 public:
  MentionFinder(std::string_view text, std::vector<Mention>& out) : text_(text), out_(out) {}

  void find(const Statement& s) {
    const size_t first = out_.size();
    add_names(s);
    for (const Parameter& p : s.parameters) add_parameter(s, p);
    std::sort(out_.begin() + static_cast<std::ptrdiff_t>(first), out_.end(),
              [](const Mention& a, const Mention& b) { return a.at.begin < b.at.begin; });
  }

 private:
  void add(NameKind kind, bool defines, Span at, const std::string& name) { out_.push_back({kind, defines, at, name}); }

  void add_name(const Statement& s, size_t i, NameKind kind, bool defines) {
    if (i < s.names.size()) add(kind, defines, string_at(text_, s.names_at[i].offset), s.names[i]);
  }

  void add_names(const Statement& s) {
    struct Row {
      std::string_view directive;
      NameKind kind;
      bool defines;
    };
    static constexpr Row kRows[] = {
        {"MakeNamedMaterial", NameKind::Material, true},
        {"NamedMaterial", NameKind::Material, false},
        {"ObjectBegin", NameKind::Object, true},
        {"ObjectInstance", NameKind::Object, false},
        {"CoordinateSystem", NameKind::CoordinateSystem, true},
        {"CoordSysTransform", NameKind::CoordinateSystem, false},
        {"MakeNamedMedium", NameKind::Medium, true},
        {"Include", NameKind::Include, false},
    };
    const std::string_view directive = s.row->name;
    if (directive == "Texture" && s.names.size() == 3)
      add_name(s, 0, s.names[1] == "float" ? NameKind::FloatTexture : NameKind::ColourTexture, true);
    for (size_t i = 0; directive == "MediumInterface" && i < s.names.size(); ++i) {
      if (!s.names[i].empty()) add_name(s, i, NameKind::Medium, false);
    }
    for (const Row& row : kRows) {
      if (row.directive == directive) add_name(s, 0, row.kind, row.defines);
    }
  }

  void add_parameter(const Statement& s, const Parameter& p) {
    if (const auto* textures = std::get_if<std::vector<TextureRef>>(&p.values)) {
      const std::vector<Span> at = value_spans(text_, p);
      for (size_t i = 0; i < textures->size() && i < at.size(); ++i)
        add(NameKind::AnyTexture, false, at[i], (*textures)[i].name);
      return;
    }
    if (p.strings().empty()) return;
    const bool material = p.name.starts_with("namedmaterial") && plugin_name(s) == "mix";
    if (!material && !names_file(s, p)) return;
    const std::vector<Span> at = value_spans(text_, p);
    for (size_t i = 0; i < p.strings().size() && i < at.size(); ++i)
      add(material ? NameKind::Material : NameKind::Asset, false, at[i], p.strings()[i]);
  }

  std::string_view text_;
  std::vector<Mention>& out_;
};

void shift(Span& span, uint64_t by) { span.begin += by, span.end += by; }  // modulo 2^64, so that it may also go back

}  // namespace

Span string_at(std::string_view text, uint64_t offset) {
  uint64_t end = offset + 1;
  while (end < text.size() && text[end] != '"' && text[end] != '\n') end += text[end] == '\\' ? 2 : 1;
  end = std::min<uint64_t>(end, text.size());
  if (end < text.size() && text[end] == '"') ++end;
  return {offset, end};
}

std::vector<Span> value_spans(std::string_view text, const Parameter& parameter) {
  std::vector<Span> out;
  const uint64_t start = parameter.values_at.offset;
  if (start >= text.size()) return out;
  Diagnostics ignored;
  Reporter reporter(ignored);
  Lexer lexer(text.substr(start), 0, reporter);
  const bool list = lexer.peek().kind == TokenKind::Open;
  if (list) lexer.next();
  do {
    const Token token = lexer.next();
    if (token.kind != TokenKind::Number && token.kind != TokenKind::String && token.kind != TokenKind::Word) break;
    out.push_back({start + token.offset, start + token.end()});
  } while (list);
  return out;
}

bool read_at(std::string_view text, uint64_t offset, Statement& out) {
  Diagnostics ignored;
  Reporter reporter(ignored);
  Lexer lexer(text, 0, reporter);
  lexer.start_at(offset);
  return read_statement(lexer, out) == ReadResult::Good;
}

size_t FileIndex::item_at(uint64_t offset) const {
  const auto behind = std::upper_bound(items_.begin(), items_.end(), offset,
                                       [](uint64_t o, const Item& item) { return o < item.at.begin; });
  return behind == items_.begin() ? items_.size() : static_cast<size_t>(behind - items_.begin()) - 1;
}

size_t FileIndex::first_mention(uint64_t offset) const {
  return static_cast<size_t>(std::partition_point(mentions_.begin(), mentions_.end(),
                                                  [offset](const Mention& m) { return m.at.begin < offset; }) -
                             mentions_.begin());
}

const Mention* FileIndex::mention_at(uint64_t offset) const {
  const size_t behind = first_mention(offset + 1);
  return behind > 0 && mentions_[behind - 1].at.holds(offset) ? &mentions_[behind - 1] : nullptr;
}

bool FileIndex::has(std::string_view directive) const {
  const StatementRow* row = find_statement(directive);
  return std::any_of(items_.begin(), items_.end(), [row](const Item& item) { return item.row == row; });
}

/// A statement depends on its own text and on the first word of the next, which ends where nothing has changed when a
/// third one begins before the change. Behind it, reading goes on until it comes to where a statement began before.
void FileIndex::renew(std::string_view text, Span old, uint64_t length) {
  const auto behind = std::partition_point(items_.begin(), items_.end(),
                                           [&old](const Item& item) { return item.at.begin < old.begin; });
  const auto kept = static_cast<size_t>(std::max<std::ptrdiff_t>(0, behind - items_.begin() - 2));
  const uint64_t start = kept < items_.size() && kept > 0 ? items_[kept].at.begin : 0;
  const uint64_t by = length - old.size();  // modulo 2^64
  auto next = std::partition_point(items_.begin(), items_.end(), [&](const Item& i) { return i.at.begin < old.end; });

  std::vector<Item> items;
  std::vector<Mention> mentions;
  Diagnostics ignored;
  Reporter reporter(ignored);
  Lexer lexer(text, 0, reporter);
  if (start > 0) lexer.start_at(start);
  MentionFinder finder(text, mentions);
  Statement s;
  uint64_t end = text.size();
  for (;;) {
    const uint64_t at = lexer.peek().offset;
    while (next != items_.end() && next->at.begin + by < at) ++next;
    if (next != items_.end() && next->at.begin + by == at) {
      end = at;
      break;
    }
    const ReadResult result = read_statement(lexer, s);
    if (result == ReadResult::End) {
      next = items_.end();
      break;
    }
    const bool good = result == ReadResult::Good;
    items.push_back({good ? s.row : nullptr, {s.where.offset, s.end}});
    if (good) finder.find(s);
  }

  const uint64_t old_end = end - by;
  const auto first_name = std::partition_point(mentions_.begin(), mentions_.end(),
                                               [start](const Mention& m) { return m.at.begin < start; });
  const auto next_name = next == items_.end()
                             ? mentions_.end()
                             : std::partition_point(mentions_.begin(), mentions_.end(),
                                                    [&](const auto& m) { return m.at.begin < old_end; });
  for (auto i = next; i != items_.end(); ++i) shift(i->at, by);
  for (auto m = next_name; m != mentions_.end(); ++m) shift(m->at, by);
  const auto put = [](auto& all, auto first, auto last, auto& by_these) {
    const auto at = all.erase(first, last);
    all.insert(at, std::make_move_iterator(by_these.begin()), std::make_move_iterator(by_these.end()));
  };
  put(items_, items_.begin() + static_cast<std::ptrdiff_t>(kept), next, items);
  put(mentions_, first_name, next_name, mentions);
}

}  // namespace whit::author
