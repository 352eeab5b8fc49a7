#include "parser/statements.h"

#include <algorithm>
#include <unordered_map>

#include "parser/parameters.h"
#include "parser/scene_builder.h"

namespace whit {

namespace {

constexpr ArgumentRule nothing() { return {}; }
constexpr ArgumentRule numbers(uint8_t n, std::string_view usage) { return {0, 0, false, n, false, usage}; }
constexpr ArgumentRule name(std::string_view usage = "\"name\"") { return {1, 1, false, 0, false, usage}; }
constexpr ArgumentRule media() { return {1, 2, false, 0, false, "\"inside\" \"outside\""}; }
constexpr ArgumentRule word(std::string_view usage) { return {0, 0, true, 0, false, usage}; }
constexpr ArgumentRule plugin(std::string_view usage = "\"plugin\" parameters") {
  return {1, 1, false, 0, true, usage};
}
constexpr ArgumentRule texture() {
  return {3, 3, false, 0, true, "\"name\" (\"float\" | \"spectrum\") \"plugin\" parameters"};
}
constexpr ArgumentRule named() { return plugin("\"name\" \"string type\" [\"plugin\"] parameters"); }
constexpr ArgumentRule matrix() { return numbers(16, "[m00 m10 m20 m30 ... m33]"); }

using B = SceneBuilder;

// clang-format off
constexpr StatementRow kStatements[] = {
    {"Identity", nothing(), Block::Both, &B::identity,
     "Forgets the transforms so far."},
    {"Translate", numbers(3, "x y z"), Block::Both, &B::translate,
     "Moves what follows."},
    {"Scale", numbers(3, "x y z"), Block::Both, &B::scale,
     "Scales what follows, axis by axis; an odd number of negative factors mirrors."},
    {"Rotate", numbers(4, "degrees x y z"), Block::Both, &B::rotate,
     "Turns what follows about an axis through the origin."},
    {"LookAt", numbers(9, "eye_x eye_y eye_z at_x at_y at_z up_x up_y up_z"), Block::Both, &B::look_at,
     "Before Camera: places it at the eye, looking at a point, with the direction up at the picture's top."},
    {"Transform", matrix(), Block::Both, &B::transform,
     "Replaces the transforms so far by a matrix, column by column: the translation stands last."},
    {"ConcatTransform", matrix(), Block::Both, &B::concat_transform,
     "Applies a matrix to what follows."},
    {"CoordinateSystem", name(), Block::Both, &B::coordinate_system,
     "Names the current transform."},
    {"CoordSysTransform", name(), Block::Both, &B::coord_sys_transform,
     "Takes up a named transform. In the world block \"camera\" and \"world\" are there."},
    {"ActiveTransform", word("All | StartTime | EndTime"), Block::Both, &B::active_transform,
     "Whether transform statements change the start of the motion, its end, or both."},
    {"TransformTimes", numbers(2, "start end"), Block::Options, &B::transform_times,
     "The times, in seconds, at which motion starts and ends; by default 0 and 1."},

    {"Accelerator", plugin(), Block::Options, &B::accelerator,
     "Accepted; Embree builds its own."},
    {"Camera", plugin(), Block::Options, &B::camera,
     "The camera, at the origin, looking along +z: transforms before it move the world. Without one: perspective."},
    {"Film", plugin(), Block::Options, &B::film,
     "The picture: its size and file. Without one: image."},
    {"Filter", plugin(), Block::Options, &B::pixel_filter,
     "Another name of PixelFilter."},
    {"PixelFilter", plugin(), Block::Options, &B::pixel_filter,
     "How much samples count in the pixels around them. Without one: box."},
    {"Integrator", plugin(), Block::Options, &B::integrator,
     "What light does. Without one: whitted, which also stands in for every other."},
    {"Sampler", plugin(), Block::Options, &B::sampler,
     "How many samples a pixel has, and where. Without one: sobol."},

    {"MakeNamedMedium", named(), Block::Both, &B::make_named_medium,
     "Accepted; media are not simulated."},
    {"MediumInterface", media(), Block::Both, &B::medium_interface,
     "Accepted; media are not simulated."},
    {"Include", plugin("\"file\""), Block::Both, &B::include,
     "Reads a file as if it stood here. Its path starts at the folder of the main file. Parameters behind it belong to the file's last statement. Files include one another at most 256 deep, and 500,000 times in all."},

    {"WorldBegin", nothing(), Block::Options, &B::begin_world,
     "Ends the options, forgets the transforms and begins the scene."},
    {"WorldEnd", nothing(), Block::World, &B::end_world,
     "Ends the scene. Options and a WorldBegin may follow, for another picture."},
    {"AttributeBegin", nothing(), Block::World, &B::begin_attribute,
     "Remembers transform, material, area light, orientation, and what names stand for.", 1},
    {"AttributeEnd", nothing(), Block::World, &B::end_attribute,
     "Goes back to what the last AttributeBegin remembered.", -1},
    {"TransformBegin", nothing(), Block::World, &B::begin_transform,
     "Remembers the transform.", 1},
    {"TransformEnd", nothing(), Block::World, &B::end_transform,
     "Goes back to what the last TransformBegin remembered.", -1},
    {"ObjectBegin", name(), Block::World, &B::begin_object,
     "Begins an object, whose shapes appear where ObjectInstance says. Remembers as AttributeBegin does.", 1},
    {"ObjectEnd", nothing(), Block::World, &B::end_object,
     "Ends the object.", -1},
    {"ObjectInstance", name(), Block::World, &B::object_instance,
     "Places an object."},
    {"ReverseOrientation", nothing(), Block::World, &B::reverse_orientation,
     "Turns the normals of the shapes that follow, and so the side on which area lights shine."},

    {"Texture", texture(), Block::World, &B::texture,
     "Makes a texture, which parameters of what follows can name."},
    {"Material", plugin(), Block::World, &B::material,
     "The material of the shapes that follow. Without one: matte."},
    {"MakeNamedMaterial", named(), Block::World, &B::make_named_material,
     "Makes a material for NamedMaterial to name."},
    {"NamedMaterial", name(), Block::World, &B::named_material,
     "Gives the shapes that follow a named material."},
    {"LightSource", plugin(), Block::World, &B::light_source,
     "A light."},
    {"AreaLightSource", plugin(), Block::World, &B::area_light_source,
     "Makes the shapes that follow shine. \"\" ends that, and so does AttributeEnd."},
    {"Shape", plugin(), Block::World, &B::shape,
     "A shape. Its parameters may include some of its material's, which hold for this shape."},
};
// clang-format on

/// Directives of other versions of pbrt, and what to write instead.
struct ForeignDirective {
  std::string_view name, version, remedy;
};
constexpr ForeignDirective kForeignDirectives[] = {
    {"SurfaceIntegrator", "pbrt-v2", "in pbrt-v3 it is Integrator"},
    {"VolumeIntegrator", "pbrt-v2", "in pbrt-v3 an Integrator does volumes too"},
    {"Renderer", "pbrt-v2", "in pbrt-v3 it is Integrator"},
    {"Volume", "pbrt-v2", "in pbrt-v3 it is MakeNamedMedium"},
    {"Option", "pbrt-v4", ""},
    {"ColorSpace", "pbrt-v4", ""},
    {"Import", "pbrt-v4", "in pbrt-v3 it is Include"},
    {"Attribute", "pbrt-v4", "in pbrt-v3 parameters stand at each statement"},
};

/// Plugins that pbrt-v4 alone has, by the statements that name them.
struct ForeignPlugin {
  std::string_view name, instead;  ///< "" where nothing of pbrt-v3 is like it.
};
struct ForeignPlugins {
  std::string_view directive;
  std::array<ForeignPlugin, 9> plugins;
};
constexpr ForeignPlugins kForeignPlugins[] = {
    {"Film", {{{"rgb", "image"}, {"gbuffer", "image"}, {"spectral", "image"}}}},
    {"Camera", {{{"spherical", "environment"}}}},
    {"Sampler",
     {{{"zsobol", "sobol"}, {"paddedsobol", "sobol"}, {"independent", "random"}, {"pmj02bn", "02sequence"}}}},
    {"Integrator",
     {{{"simplepath", "path"},
       {"simplevolpath", "path"},
       {"lightpath", "path"},
       {"randomwalk", "path"},
       {"function", ""}}}},
    {"Material",
     {{{"diffuse", "matte"},
       {"conductor", "metal"},
       {"dielectric", "glass"},
       {"thindielectric", "glass"},
       {"coateddiffuse", "plastic"},
       {"coatedconductor", "metal"},
       {"diffusetransmission", "translucent"},
       {"interface", "none"},
       {"measured", ""}}}},
    {"MakeNamedMedium", {{{"uniformgrid", ""}, {"rgbgrid", ""}, {"cloud", ""}, {"nanovdb", ""}}}},
    {"Shape", {{{"bilinearmesh", "trianglemesh"}}}},
};

/// The plugin that a statement asks for.
std::string plugin_of(const Statement& s) {
  if (!s.row->name.starts_with("MakeNamed")) return s.names.back();
  for (const Parameter& p : s.parameters)
    if (p.name == "type" && !p.strings().empty()) return p.strings().front();
  return {};
}

/// Takes down a plugin that shows the file to be one of pbrt-v4. It is no error: something stands in for it, or not.
void note_foreign_plugin(const Statement& s, Reporter& reporter) {
  if (!s.row->arguments.parameters || s.names.empty()) return;
  const std::string_view directive = s.row->name == "MakeNamedMaterial" ? "Material" : s.row->name;
  for (const ForeignPlugins& foreign : kForeignPlugins) {
    if (foreign.directive != directive) continue;
    const std::string plugin = plugin_of(s);
    const auto found = std::find_if(foreign.plugins.begin(), foreign.plugins.end(),
                                    [&](const ForeignPlugin& p) { return !plugin.empty() && p.name == plugin; });
    if (found == foreign.plugins.end()) continue;
    // At the name, where whoever binds the plugin says that it is unknown.
    reporter.foreign(s.names_at.back(), "pbrt-v4", Severity::Warning,
                     "pbrt-v3 has no " + std::string(directive) + " " + in_quotes(plugin),
                     found->instead.empty() ? "" : "in pbrt-v3 " + in_quotes(found->instead) + " is like it");
  }
}

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
  if (word.starts_with("//")) return true;  // Meant as a comment, which it is not.
  if (!letter || word.size() > 20) return false;
  return is_directive(word) || looks_like_directive(word) || !find_ignoring_case(word).empty();
}

const std::vector<std::string>& known_directives() {
  static const auto* const known = [] {
    auto* names = new std::vector<std::string>;
    for (const StatementRow& row : kStatements) names->emplace_back(row.name);
    return names;
  }();
  return *known;
}

Remedy unknown_directive_remedy(std::string_view word) {
  const std::string foreign = foreign_characters(word);
  if (!foreign.empty()) return foreign;
  const std::string_view other_case = find_ignoring_case(word);
  if (!other_case.empty())
    return {"directives are case sensitive: write " + std::string(other_case),
            {std::string(word), std::string(other_case)}};
  const std::string nearest = nearest_name(std::string(word), known_directives());
  if (nearest.empty()) return {};
  return {"did you mean " + nearest + "?", suggestion(std::string(word), known_directives()).slip};
}

void report_unknown_directive(Reporter& reporter, SourcePos where, std::string_view word) {
  for (const ForeignDirective& foreign : kForeignDirectives) {
    if (foreign.name != word) continue;
    reporter.foreign(where, std::string(foreign.version), Severity::Error,
                     "pbrt-v3 has no statement " + std::string(word), std::string(foreign.remedy));
    return;
  }
  // The same words at every such line, so that they are shown a few times only.
  const bool comment = word.starts_with("//");
  reporter.error(where, comment ? "unknown directive \"//\"" : "unknown directive " + in_quotes(word),
                 reporter.crowded() ? Remedy() : unknown_directive_remedy(word));
}

void report_no_directive(Lexer& lexer, const Token& token) {
  Reporter& reporter = lexer.reporter();
  const SourcePos where = lexer.pos(token);
  switch (token.kind) {
    case TokenKind::Word: report_unknown_directive(reporter, where, token.text); break;
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
  const ArgumentRule& wanted = out.row->arguments;
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
                             (one ? "a name in quotes" : plural(wanted.min_strings, "string") + " in quotes"),
                         foreign_characters(lexer.peek().text));
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

/// True for a directive, and for a word at the start of a line that looks like one: it is reported when it is read.
bool begins_statement(Lexer& lexer, const Token& token) {
  if (is_directive(token.text)) return true;
  const std::string_view between = lexer.text().substr(lexer.consumed(), token.offset - lexer.consumed());
  return between.find('\n') != std::string_view::npos && starts_statement(token.text);
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
  // Without brackets the statement ends with its last number, whatever follows.
  if (count == wanted && !bracketed && !more) return true;
  const std::string need = std::string(out.row->name) + " needs " + plural(wanted, "number");
  if (token.kind == TokenKind::Word && !begins_statement(lexer, token)) {
    const std::string foreign = foreign_characters(token.text);
    lexer.reporter().error(lexer.pos(token), in_quotes(token.text) + " is not a number",
                           need + (foreign.empty() ? "" : "; " + foreign));
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
  const ArgumentRule& arguments = out.row->arguments;
  out.arguments_at = lexer.pos(lexer.peek());
  if (arguments.max_strings > 0 && !read_names(lexer, out)) return false;
  if (arguments.word && !read_word(lexer, out)) return false;
  if (arguments.numbers > 0 && !read_fixed_numbers(lexer, out)) return false;
  return !arguments.parameters || read_parameters(lexer, out.parameters);
}

}  // namespace

std::span<const StatementRow> statements() { return kStatements; }

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

bool resembles_directive(std::string_view word) {
  const auto is_it = [&](const ForeignDirective& foreign) { return foreign.name == word; };
  return is_directive(word) || std::any_of(std::begin(kForeignDirectives), std::end(kForeignDirectives), is_it) ||
         !find_ignoring_case(word).empty() || !nearest_name(std::string(word), known_directives()).empty();
}

ReadResult read_statement(Lexer& lexer, Statement& out) {
  out = Statement();
  const Token token = lexer.next();
  out.where = lexer.pos(token);
  if (token.kind == TokenKind::End) return ReadResult::End;
  if (token.kind == TokenKind::Word) out.row = find_statement(token.text);
  if (!out.row) report_no_directive(lexer, token);
  const bool good = out.row && read_arguments(lexer, out);
  if (good) note_foreign_plugin(out, lexer.reporter());
  if (!good) lexer.resynchronise(starts_statement);
  out.end = lexer.consumed();
  return good ? ReadResult::Good : ReadResult::Broken;
}

}  // namespace whit
