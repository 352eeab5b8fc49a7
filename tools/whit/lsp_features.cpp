// What the server does for an editor beside diagnostics: a handler for each request, which turns what core/author knows
// into JSON.

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "core/author/colours.h"
#include "core/author/complete.h"
#include "core/author/hover.h"
#include "core/author/names.h"
#include "core/author/outline.h"
#include "core/base/file_names.h"
#include "parser/editor_config.h"
#include "parser/format.h"
#include "tools/whit/lsp_server.h"

namespace whit::lsp {
namespace {

using author::File;
using author::Span;

uint64_t offset_of(const File& file, const Value& params) {
  return file.document.offset(position_of(params.at("position")));
}

Span span_of(const File& file, const Value& range) {
  const uint64_t begin = file.document.offset(position_of(range.at("start")));
  return {begin, std::max(begin, file.document.offset(position_of(range.at("end"))))};
}

Value range_of(const File& file, Span span) {
  return range_json(file.document.position(span.begin), file.document.position(span.end));
}

Value location(const Server& server, const author::SpanAt& at) {
  return {{"uri", server.uri_of(*at.file)}, {"range", range_of(*at.file, at.span)}};
}

Value markup(const Server& server, const std::string& markdown) {
  return {{"kind", server.client.markdown ? "markdown" : "plaintext"}, {"value", markdown}};
}

/// Edits of files, as the client wants them.
Value workspace_edit(const Server& server, const std::vector<std::pair<File*, Value>>& edits) {
  if (!server.client.document_changes) {
    Value changes = Value::object();
    for (const auto& [file, list] : edits) changes[server.uri_of(*file)] = list;
    return {{"changes", std::move(changes)}};
  }
  Value changes = Value::array();
  for (const auto& [file, list] : edits) {
    const Value version = file->open ? Value(file->version) : Value();
    changes.push_back({{"textDocument", {{"uri", server.uri_of(*file)}, {"version", version}}}, {"edits", list}});
  }
  return {{"documentChanges", std::move(changes)}};
}

// ------------------------------------------------------------------------------------------------ completion

/// The numbers of CompletionItemKind.
int completion_kind(author::Proposal::Kind kind) {
  switch (kind) {
    case author::Proposal::Kind::Statement: return 14;  // Keyword
    case author::Proposal::Kind::Plugin: return 7;      // Class
    case author::Proposal::Kind::Parameter: return 5;   // Field
    case author::Proposal::Kind::Value: return 12;      // Value
    case author::Proposal::Kind::Name: return 6;        // Variable
    case author::Proposal::Kind::File: return 17;       // File
    case author::Proposal::Kind::Folder: return 19;     // Folder
  }
  return 1;
}

/// A snippet as plain text: its places with what they suggest.
std::string without_places(const std::string& snippet) {
  std::string out;
  for (size_t i = 0; i < snippet.size(); ++i) {
    if (snippet[i] != '$') {
      out += snippet[i];
      continue;
    }
    if (++i < snippet.size() && snippet[i] != '{') continue;
    const size_t end = snippet.find('}', i);
    const size_t start = snippet.find_first_of(":|", i);
    if (end == std::string::npos || start == std::string::npos || start > end) break;
    const std::string inside = snippet.substr(start + 1, end - start - 1);
    out += inside.substr(0, inside.find_first_of(",|"));
    i = end;
  }
  return out;
}

Value complete(Server& server, const Value& params) {
  File& file = server.file_of(params);
  Value items = Value::array();
  for (const author::Proposal& p : author::complete(server.workspace, file, offset_of(file, params))) {
    const bool snippet = p.snippet && server.client.snippets;
    Value item{{"label", p.label},
               {"kind", completion_kind(p.kind)},
               {"filterText", p.filter},
               {"sortText", fmt::format("{:05}", items.size())},
               {"insertTextFormat", snippet ? 2 : 1},
               {"textEdit",
                {{"range", range_of(file, p.replaces)},
                 {"newText", p.snippet && !snippet ? without_places(p.text) : p.text}}}};
    if (!p.detail.empty()) item["detail"] = p.detail;
    if (!p.doc.empty()) item["documentation"] = {{"kind", "markdown"}, {"value", p.doc}};
    items.push_back(std::move(item));
  }
  return {{"isIncomplete", false}, {"items", std::move(items)}};
}

Value hover(Server& server, const Value& params) {
  File& file = server.file_of(params);
  const auto found = author::hover(server.workspace, file, offset_of(file, params));
  if (!found) return nullptr;
  return {{"contents", markup(server, found->markdown)}, {"range", range_of(file, found->at)}};
}

// ----------------------------------------------------------------------------------------------------- names

Value definition(Server& server, const Value& params) {
  File& file = server.file_of(params);
  Value out = Value::array();
  for (const author::SpanAt& at : author::definition_at(server.workspace, file, offset_of(file, params)))
    out.push_back(location(server, at));
  return out;
}

Value references(Server& server, const Value& params) {
  File& file = server.file_of(params);
  const bool with_definitions = params.at("context").value("includeDeclaration", true);
  Value out = Value::array();
  for (const author::SpanAt& at :
       author::references_at(server.workspace, file, offset_of(file, params), with_definitions))
    out.push_back(location(server, at));
  return out;
}

Value highlight(Server& server, const Value& params) {
  File& file = server.file_of(params);
  constexpr int kRead = 2, kWrite = 3;
  Value out = Value::array();
  const auto add = [&](const std::vector<author::MentionAt>& mentions, int kind) {
    for (const author::MentionAt& m : mentions) {
      if (m.file == &file) out.push_back({{"range", range_of(file, m.get().at)}, {"kind", kind}});
    }
  };
  if (const auto symbol = author::symbol_at(server.workspace, file, offset_of(file, params)))
    add(symbol->definitions, kWrite), add(symbol->uses, kRead);
  return out;
}

/// The symbol to be renamed; throws where there is none that a file gives its name.
author::Symbol renamed(Server& server, File& file, uint64_t offset) {
  auto symbol = author::symbol_at(server.workspace, file, offset);
  if (!symbol) throw RequestError{ErrorCode::RequestFailed, "here is no name"};
  if (symbol->definitions.empty())
    throw RequestError{ErrorCode::RequestFailed, fmt::format("nothing is named \"{}\" here", symbol->name)};
  return std::move(*symbol);
}

Value prepare_rename(Server& server, const Value& params) {
  File& file = server.file_of(params);
  const uint64_t offset = offset_of(file, params);
  const author::Symbol symbol = renamed(server, file, offset);
  return {{"range", range_of(file, author::inside(*file.index.mention_at(offset)))}, {"placeholder", symbol.name}};
}

Value rename(Server& server, const Value& params) {
  File& file = server.file_of(params);
  const auto name = params.at("newName").get<std::string>();
  if (const std::string why = author::why_no_name(name); !why.empty())
    throw RequestError{ErrorCode::InvalidParams, why};
  author::Symbol symbol = renamed(server, file, offset_of(file, params));
  if (name != symbol.name && author::is_taken(server.workspace, file, symbol.kind, name))
    throw RequestError{ErrorCode::RequestFailed, fmt::format("\"{}\" is the name of something else here", name)};
  std::vector<author::MentionAt> all = std::move(symbol.definitions);
  all.insert(all.end(), symbol.uses.begin(), symbol.uses.end());
  std::vector<std::pair<File*, Value>> edits;
  for (const author::MentionAt& m : all) {
    auto of_file = std::find_if(edits.begin(), edits.end(), [&](const auto& e) { return e.first == m.file; });
    if (of_file == edits.end()) of_file = edits.insert(edits.end(), {m.file, Value::array()});
    of_file->second.push_back(
        {{"range", range_of(*m.file, author::inside(m.get()))}, {"newText", author::escaped(name)}});
  }
  return workspace_edit(server, edits);
}

// ---------------------------------------------------------------------------------------------------- layout

/// One edit, of the lines that differ.
Value format(Server& server, const Value& params) {
  File& file = server.file_of(params);
  Sources sources;
  std::ostringstream text;
  const EditorConfig config = read_editor_config(file.path);
  FormatOptions options;
  options.indent = config.indent;
  format_text(sources, file.path, file.document.text(), "", text, options);
  const std::string now = config.line_ends(text.str());
  const std::string_view was = file.text();
  if (now == was || now.empty()) return Value::array();
  size_t same = 0;
  while (same < now.size() && same < was.size() && now[same] == was[same]) ++same;
  while (same > 0 && now[same - 1] != '\n') --same;
  size_t tail = 0;
  while (tail < now.size() - same && tail < was.size() - same &&
         now[now.size() - 1 - tail] == was[was.size() - 1 - tail])
    ++tail;
  // From the beginning of a line, so that no character and no \r\n is taken apart.
  const auto begins_line = [&tail](std::string_view whole) {
    return tail == whole.size() || whole[whole.size() - 1 - tail] == '\n';
  };
  while (tail > 0 && !(begins_line(now) && begins_line(was))) --tail;
  return Value::array({{{"range", range_of(file, {same, was.size() - tail})},
                        {"newText", now.substr(same, now.size() - tail - same)}}});
}

/// The numbers of SymbolKind.
int symbol_kind(author::OutlineSymbol::Kind kind) {
  using Kind = author::OutlineSymbol::Kind;
  switch (kind) {
    case Kind::World: return 3;  // Namespace
    case Kind::Block: return 3;
    case Kind::Object: return 5;     // Class
    case Kind::Material: return 13;  // Variable
    case Kind::Texture: return 14;   // Constant
    case Kind::Shape: return 19;     // Object
    case Kind::Light: return 24;     // Event
    case Kind::Camera: return 8;     // Field
    case Kind::Option: return 7;     // Property
    case Kind::File: return 1;       // File
  }
  return 13;
}

Value symbol_tree(const File& file, const std::vector<author::OutlineSymbol>& symbols) {
  Value out = Value::array();
  for (const author::OutlineSymbol& s : symbols) {
    Value one{{"name", s.name},
              {"kind", symbol_kind(s.kind)},
              {"range", range_of(file, s.whole)},
              {"selectionRange", range_of(file, s.at)}};
    if (!s.detail.empty()) one["detail"] = s.detail;
    if (!s.children.empty()) one["children"] = symbol_tree(file, s.children);
    out.push_back(std::move(one));
  }
  return out;
}

void symbol_list(const Server& server, const File& file, const std::vector<author::OutlineSymbol>& symbols,
                 const std::string& within, Value& out) {
  for (const author::OutlineSymbol& s : symbols) {
    out.push_back({{"name", s.name},
                   {"kind", symbol_kind(s.kind)},
                   {"location", {{"uri", server.uri_of(file)}, {"range", range_of(file, s.whole)}}},
                   {"containerName", within}});
    symbol_list(server, file, s.children, s.name, out);
  }
}

Value symbols(Server& server, const Value& params) {
  const File& file = server.file_of(params);
  const std::vector<author::OutlineSymbol> found = author::outline(file);
  if (server.client.nested_symbols) return symbol_tree(file, found);
  Value out = Value::array();
  symbol_list(server, file, found, "", out);
  return out;
}

Value fold(Server& server, const Value& params) {
  Value out = Value::array();
  for (const author::Fold& f : author::folds(server.file_of(params))) {
    Value one{{"startLine", f.first_line}, {"endLine", f.last_line}};
    one["kind"] = f.comment ? "comment" : "region";
    out.push_back(std::move(one));
  }
  return out;
}

/// The types of tokens that the protocol knows, by author::WordKind.
constexpr const char* kTokenTypes[] = {"keyword", "class",  "type",  "property", "variable",
                                       "string",  "number", "macro", "comment"};

Value tokens(const File& file, Span span) {
  Value data = Value::array();
  author::Position last;
  author::Positions positions(file.document);
  for (const author::ColouredWord& w : author::words(file, span)) {
    const author::Position at = positions.at(w.at.begin), end = positions.at(w.at.end);
    if (end.line != at.line) continue;
    const bool same_line = at.line == last.line;
    for (const uint32_t n : {at.line - last.line, same_line ? at.character - last.character : at.character,
                             end.character - at.character, static_cast<uint32_t>(w.kind), w.defines ? 1u : 0u})
      data.push_back(n);
    last = at;
  }
  return {{"data", std::move(data)}};
}

Value all_tokens(Server& server, const Value& params) {
  const File& file = server.file_of(params);
  return tokens(file, {0, file.text().size()});
}

Value some_tokens(Server& server, const Value& params) {
  const File& file = server.file_of(params);
  return tokens(file, span_of(file, params.at("range")));
}

// --------------------------------------------------------------------------------------------------- colours

Value colours(Server& server, const Value& params) {
  const File& file = server.file_of(params);
  Value out = Value::array();
  for (const author::ColourAt& c : author::colours_in(file, {0, file.text().size()})) {
    const author::ShownColour s = author::shown(c.linear);
    out.push_back({{"range", range_of(file, c.values)},
                   {"color", {{"red", s.red}, {"green", s.green}, {"blue", s.blue}, {"alpha", 1}}}});
  }
  return out;
}

/// The numbers of a colour; as bright as those that stand there where these are brighter than any that can be chosen.
Value present_colour(Server& server, const Value& params) {
  const File& file = server.file_of(params);
  const Span span = span_of(file, params.at("range"));
  double scale = 1;
  for (const author::ColourAt& c : author::colours_in(file, span)) {
    if (c.values == span) scale = author::shown(c.linear).scale;
  }
  const Value& c = params.at("color");
  const std::string text =
      author::written(c.at("red").get<double>(), c.at("green").get<double>(), c.at("blue").get<double>(), scale);
  return Value::array({{{"label", text}, {"textEdit", {{"range", range_of(file, span)}, {"newText", text}}}}});
}

// --------------------------------------------------------------------------------------------------- actions

/// The word that a slip corrects, where it is still there.
std::optional<Span> slip_span(const File& file, const author::Finding& f) {
  if (!f.word) return std::nullopt;
  const Span at{file.document.offset(f.word->first), file.document.offset(f.word->second)};
  if (at.end < at.begin || file.text().substr(at.begin, at.size()) != f.slip.written) return std::nullopt;
  return at;
}

Value slip_edit(const File& file, Span at, const Slip& slip) {
  return {{"range", range_of(file, at)}, {"newText", slip.meant}};
}

bool wanted(const Value& context, const std::string& kind) {
  const Value only = context.value("only", Value());
  return !only.is_array() || std::any_of(only.begin(), only.end(), [&](const Value& v) {
    const std::string asked = v.is_string() ? v.get<std::string>() : "";
    return kind == asked || kind.starts_with(asked + ".") || asked.empty();
  });
}

Value actions(Server& server, const Value& params) {
  File& file = server.file_of(params);
  const Span asked = span_of(file, params.at("range"));
  const Value& context = params.at("context");
  Value out = Value::array(), all = Value::array();
  std::vector<Span> corrected;
  for (const author::Finding& f : server.findings_in(file.path)) {
    const std::optional<Span> at = slip_span(file, f);
    if (!at || std::find(corrected.begin(), corrected.end(), *at) != corrected.end()) continue;
    corrected.push_back(*at);
    const Value edit = slip_edit(file, *at, f.slip);
    all.push_back(edit);
    const Span shown{file.document.offset(f.begin), file.document.offset(f.end)};
    if (shown.end < asked.begin || shown.begin > asked.end || !wanted(context, "quickfix")) continue;
    Value action{{"title", fmt::format("Change {} to {}", f.slip.written, f.slip.meant)},
                 {"kind", "quickfix"},
                 {"isPreferred", true},
                 {"edit", workspace_edit(server, {{&file, Value::array({edit})}})}};
    Value solved = Value::array();
    const Value from_editor = context.value("diagnostics", Value::array());
    for (const Value& d : from_editor) {
      if (d.value("range", Value()) == range_json(f.begin, f.end)) solved.push_back(d);
    }
    action["diagnostics"] = std::move(solved);
    out.push_back(std::move(action));
  }
  if (!all.empty() && wanted(context, "source.fixAll")) {
    out.push_back({{"title", fmt::format("Correct {} misspelt word{}", all.size(), all.size() == 1 ? "" : "s")},
                   {"kind", "source.fixAll"},
                   {"edit", workspace_edit(server, {{&file, all}})}});
  }
  return out;
}

Value links(Server& server, const Value& params) {
  File& file = server.file_of(params);
  const File& main = *server.workspace.main_of(file);
  Value out = Value::array();
  for (const author::Mention& m : file.index.mentions()) {
    if (m.kind != author::NameKind::Include && m.kind != author::NameKind::Asset) continue;
    const std::string path = canonical_path(server.workspace.resolve(main, m.name));
    out.push_back({{"range", range_of(file, author::inside(m))}, {"target", uri_of_path(path)}});
  }
  return out;
}

}  // namespace

std::vector<Method> feature_methods() {
  return {
      {"textDocument/completion", true, complete},
      {"textDocument/hover", true, hover},
      {"textDocument/definition", true, definition},
      {"textDocument/references", true, references},
      {"textDocument/documentHighlight", true, highlight},
      {"textDocument/prepareRename", true, prepare_rename},
      {"textDocument/rename", true, rename},
      {"textDocument/formatting", true, format},
      {"textDocument/documentSymbol", true, symbols},
      {"textDocument/foldingRange", true, fold},
      {"textDocument/semanticTokens/full", true, all_tokens},
      {"textDocument/semanticTokens/range", true, some_tokens},
      {"textDocument/documentColor", true, colours},
      {"textDocument/colorPresentation", true, present_colour},
      {"textDocument/codeAction", true, actions},
      {"textDocument/documentLink", true, links},
  };
}

Value feature_capabilities() {
  Value types = Value::array();
  for (const char* type : kTokenTypes) types.push_back(type);
  return {{"completionProvider", {{"triggerCharacters", {"\"", "/"}}}},
          {"hoverProvider", true},
          {"definitionProvider", true},
          {"referencesProvider", true},
          {"documentHighlightProvider", true},
          {"renameProvider", {{"prepareProvider", true}}},
          {"documentFormattingProvider", true},
          {"documentSymbolProvider", true},
          {"foldingRangeProvider", true},
          {"semanticTokensProvider",
           {{"legend", {{"tokenTypes", types}, {"tokenModifiers", Value::array({"definition"})}}},
            {"full", true},
            {"range", true}}},
          {"colorProvider", true},
          {"codeActionProvider", {{"codeActionKinds", Value::array({"quickfix", "source.fixAll"})}}},
          {"documentLinkProvider", {{"resolveProvider", false}}}};
}

}  // namespace whit::lsp
