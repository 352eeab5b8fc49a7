#include "parser/statements.h"

#include <algorithm>
#include <unordered_map>

#include "parser/parameters.h"
#include "parser/scene_builder.h"

namespace whit {

namespace {

constexpr Arguments nothing() { return {}; }
constexpr Arguments numbers(uint8_t n) { return {0, 0, false, n, false}; }
constexpr Arguments names(uint8_t least, uint8_t most) { return {least, most, false, 0, false}; }
constexpr Arguments name() { return names(1, 1); }
constexpr Arguments word() { return {0, 0, true, 0, false}; }
constexpr Arguments plugin(uint8_t strings = 1) { return {strings, strings, false, 0, true}; }

using B = SceneBuilder;

// clang-format off
constexpr StatementRow kStatements[] = {
    {"Identity",           nothing(),   Block::Both,    &B::identity},
    {"Translate",          numbers(3),  Block::Both,    &B::translate},
    {"Scale",              numbers(3),  Block::Both,    &B::scale},
    {"Rotate",             numbers(4),  Block::Both,    &B::rotate},
    {"LookAt",             numbers(9),  Block::Both,    &B::look_at},
    {"Transform",          numbers(16), Block::Both,    &B::transform},
    {"ConcatTransform",    numbers(16), Block::Both,    &B::concat_transform},
    {"CoordinateSystem",   name(),      Block::Both,    &B::coordinate_system},
    {"CoordSysTransform",  name(),      Block::Both,    &B::coord_sys_transform},
    {"ActiveTransform",    word(),      Block::Both,    &B::active_transform},
    {"TransformTimes",     numbers(2),  Block::Options, &B::transform_times},

    {"Accelerator",        plugin(),    Block::Options, &B::accelerator},
    {"Camera",             plugin(),    Block::Options, &B::camera},
    {"Film",               plugin(),    Block::Options, &B::film},
    {"Filter",             plugin(),    Block::Options, &B::pixel_filter},
    {"PixelFilter",        plugin(),    Block::Options, &B::pixel_filter},
    {"Integrator",         plugin(),    Block::Options, &B::integrator},
    {"Sampler",            plugin(),    Block::Options, &B::sampler},

    {"MakeNamedMedium",    plugin(),    Block::Both,    &B::make_named_medium},
    {"MediumInterface",    names(1, 2), Block::Both,    &B::medium_interface},
    {"Include",            name(),      Block::Both,    &B::include},

    {"WorldBegin",         nothing(),   Block::Options, &B::begin_world},
    {"WorldEnd",           nothing(),   Block::World,   &B::end_world},
    {"AttributeBegin",     nothing(),   Block::World,   &B::begin_attribute, 1},
    {"AttributeEnd",       nothing(),   Block::World,   &B::end_attribute, -1},
    {"TransformBegin",     nothing(),   Block::World,   &B::begin_transform, 1},
    {"TransformEnd",       nothing(),   Block::World,   &B::end_transform, -1},
    {"ObjectBegin",        name(),      Block::World,   &B::begin_object, 1},
    {"ObjectEnd",          nothing(),   Block::World,   &B::end_object, -1},
    {"ObjectInstance",     name(),      Block::World,   &B::object_instance},
    {"ReverseOrientation", nothing(),   Block::World,   &B::reverse_orientation},

    {"Texture",            plugin(3),   Block::World,   &B::texture},
    {"Material",           plugin(),    Block::World,   &B::material},
    {"MakeNamedMaterial",  plugin(),    Block::World,   &B::make_named_material},
    {"NamedMaterial",      name(),      Block::World,   &B::named_material},
    {"LightSource",        plugin(),    Block::World,   &B::light_source},
    {"AreaLightSource",    plugin(),    Block::World,   &B::area_light_source},
    {"Shape",              plugin(),    Block::World,   &B::shape},
};
// clang-format on

/// Directives of other versions of pbrt, and what to write instead.
constexpr std::pair<std::string_view, std::string_view> kForeign[] = {
    {"SurfaceIntegrator", "this is pbrt-v2: in pbrt-v3 it is Integrator"},
    {"VolumeIntegrator", "this is pbrt-v2: in pbrt-v3 an Integrator does volumes too"},
    {"Renderer", "this is pbrt-v2: in pbrt-v3 it is Integrator"},
    {"Volume", "this is pbrt-v2: in pbrt-v3 it is MakeNamedMedium"},
    {"Option", "this is pbrt-v4; pbrt-v3 has no such statement"},
    {"ColorSpace", "this is pbrt-v4; pbrt-v3 has no such statement"},
    {"Attribute", "this is pbrt-v4; in pbrt-v3 parameters stand at each statement"},
};

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

/// The directive that `word` is but for the case of its letters, or "".
std::string_view find_ignoring_case(std::string_view word) {
  const std::string wanted = lower(word);
  for (const StatementRow& row : kStatements)
    if (lower(row.name) == wanted) return row.name;
  return {};
}

/// True for a word with the shape of a directive, as "Spheer", but not for the numbers some programs write.
bool looks_like_directive(std::string_view word) {
  const auto is_upper = [](char c) { return c >= 'A' && c <= 'Z'; };
  const auto is_lower = [](char c) { return c >= 'a' && c <= 'z'; };
  const auto is_letter = [&](char c) { return is_upper(c) || is_lower(c); };
  if (word.size() < 3 || !is_upper(word[0]) || !is_lower(word[1])) return false;
  return word != "NaN" && word != "Nan" && word != "Inf" && word != "Infinity" &&
         std::all_of(word.begin(), word.end(), is_letter);
}

/// A word at the start of a line at which reading may go on after a mistake. Misspelt directives count too, so
/// that each of them is reported.
bool starts_statement(std::string_view word) {
  // Most lines passed over are numbers: those are told apart first, and cheaply.
  const bool letter = !word.empty() && ((word[0] >= 'A' && word[0] <= 'Z') || (word[0] >= 'a' && word[0] <= 'z'));
  if (!letter || word.size() > 20) return false;
  return is_directive(word) || looks_like_directive(word) || !find_ignoring_case(word).empty();
}

std::string unknown_directive_remedy(std::string_view word) {
  for (const auto& [foreign, remedy] : kForeign)
    if (foreign == word) return std::string(remedy);
  const std::string_view other_case = find_ignoring_case(word);
  if (!other_case.empty()) return "directives are case sensitive: write " + std::string(other_case);
  std::vector<std::string> known;
  for (const StatementRow& row : kStatements) known.emplace_back(row.name);
  const std::string nearest = nearest_name(std::string(word), known);
  return nearest.empty() ? std::string() : "did you mean " + nearest + "?";
}

void report_no_directive(Lexer& lexer, const Token& token) {
  Reporter& reporter = lexer.reporter();
  const SourcePos where = lexer.pos(token);
  switch (token.kind) {
    case TokenKind::Word:
      reporter.error(where, "unknown directive " + in_quotes(token.text),
                     lexer.reporter().crowded() ? "" : unknown_directive_remedy(token.text));
      break;
    case TokenKind::Open:
    case TokenKind::Close: reporter.error(where, "unexpected " + std::string(token.text)); break;
    case TokenKind::Number:
      reporter.error(where, "unexpected number " + in_quotes(token.text), "a statement starts with a directive");
      break;
    case TokenKind::String:
      reporter.error(where, "unexpected string " + in_quotes(token.text.substr(1, token.text.size() - 2)),
                     "a statement starts with a directive");
      break;
    case TokenKind::Bad:  // Reported by the lexer.
    case TokenKind::End: break;
  }
}

std::string plural(size_t n, const std::string& thing) { return std::to_string(n) + " " + thing + (n == 1 ? "" : "s"); }

bool read_names(Lexer& lexer, Statement& out) {
  const Arguments& wanted = out.row->arguments;
  while (out.names.size() < wanted.max_strings && lexer.peek().kind == TokenKind::String) {
    const Token token = lexer.next();
    out.names_at.push_back(lexer.pos(token));
    out.names.push_back(lexer.unquote(token));
  }
  if (out.names.size() >= wanted.min_strings) return true;
  if (lexer.peek().kind == TokenKind::Bad) return false;
  const bool one = wanted.min_strings == 1;
  lexer.reporter().error(out.where,
                         std::string(out.row->name) + " needs " +
                             (one ? "a name in quotes" : plural(wanted.min_strings, "string") + " in quotes"));
  return false;
}

bool read_word(Lexer& lexer, Statement& out) {
  if (lexer.peek().kind == TokenKind::Word && !is_directive(lexer.peek().text)) {
    out.word = std::string(lexer.next().text);
    return true;
  }
  if (lexer.peek().kind != TokenKind::Bad)
    lexer.reporter().error(out.where, std::string(out.row->name) + " needs a word behind it, without quotes");
  return false;
}

bool read_fixed_numbers(Lexer& lexer, Statement& out) {
  const size_t wanted = out.row->arguments.numbers;
  const bool bracketed = lexer.peek().kind == TokenKind::Open;
  if (bracketed) lexer.next();
  size_t count = 0;
  while (count < wanted && lexer.peek().kind == TokenKind::Number)
    if (!lexer.read_number(out.numbers[count++])) return false;
  const Token token = lexer.peek();
  if (token.kind == TokenKind::Bad) return false;
  const bool more = token.kind == TokenKind::Number;
  const std::string need = std::string(out.row->name) + " needs " + plural(wanted, "number");
  if (token.kind == TokenKind::Word && !is_directive(token.text)) {
    lexer.reporter().error(lexer.pos(token), in_quotes(token.text) + " is not a number", need);
  } else if (count < wanted || more) {
    lexer.reporter().error(out.where, need + ", but there are " + (more ? "more" : std::to_string(count)));
  } else if (bracketed && token.kind != TokenKind::Close) {
    lexer.reporter().error(out.arguments_at, "list not closed", "add the closing ]");
  } else {
    if (bracketed) lexer.next();
    return true;
  }
  return false;
}

bool read_arguments(Lexer& lexer, Statement& out) {
  const Arguments& arguments = out.row->arguments;
  out.arguments_at = lexer.pos(lexer.peek());
  if (arguments.max_strings > 0 && !read_names(lexer, out)) return false;
  if (arguments.word && !read_word(lexer, out)) return false;
  if (arguments.numbers > 0 && !read_fixed_numbers(lexer, out)) return false;
  return !arguments.parameters || read_parameters(lexer, out.parameters);
}

}  // namespace

const StatementRow* find_statement(std::string_view name) {
  static const auto* const rows = [] {
    auto* map = new std::unordered_map<std::string_view, const StatementRow*>;
    for (const StatementRow& row : kStatements) map->emplace(row.name, &row);
    return map;
  }();
  const auto found = rows->find(name);
  return found == rows->end() ? nullptr : found->second;
}

bool is_directive(std::string_view name) { return find_statement(name) != nullptr; }

ReadResult read_statement(Lexer& lexer, Statement& out) {
  out = Statement();
  const Token token = lexer.next();
  out.where = lexer.pos(token);
  if (token.kind == TokenKind::End) return ReadResult::End;
  if (token.kind == TokenKind::Word) out.row = find_statement(token.text);
  if (!out.row) report_no_directive(lexer, token);
  const bool good = out.row && read_arguments(lexer, out);
  if (!good) lexer.resynchronise(starts_statement);
  out.end = lexer.consumed();
  return good ? ReadResult::Good : ReadResult::Broken;
}

}  // namespace whit
