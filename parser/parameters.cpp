#include "parser/parameters.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <tuple>

#include "parser/statements.h"

namespace whit {

size_t numbers_a_value(ParamType type) {
  switch (type) {
    case ParamType::Point2:
    case ParamType::Vector2:
    case ParamType::Blackbody:
    case ParamType::Spectrum: return 2;
    case ParamType::Point3:
    case ParamType::Vector3:
    case ParamType::Normal3:
    case ParamType::Rgb:
    case ParamType::Xyz: return 3;
    default: return 1;
  }
}

namespace {

struct TypeName {
  std::string_view name;
  ParamType type;
};

constexpr TypeName kTypes[] = {
    {"integer", ParamType::Integer},   {"float", ParamType::Float},
    {"bool", ParamType::Bool},         {"string", ParamType::String},
    {"point2", ParamType::Point2},     {"point3", ParamType::Point3},
    {"point", ParamType::Point3},      {"vector2", ParamType::Vector2},
    {"vector3", ParamType::Vector3},   {"vector", ParamType::Vector3},
    {"normal3", ParamType::Normal3},   {"normal", ParamType::Normal3},
    {"rgb", ParamType::Rgb},           {"color", ParamType::Rgb},
    {"xyz", ParamType::Xyz},           {"blackbody", ParamType::Blackbody},
    {"spectrum", ParamType::Spectrum}, {"texture", ParamType::Texture},
};

Remedy type_remedy(const std::string& name) {
  const std::vector<std::string> names = param_type_names();
  if (Remedy remedy = suggestion(name, names); !remedy.text.empty()) return remedy;
  std::string list = "the types are";
  for (const std::string& type : names) list += (type == names.front() ? " " : ", ") + type;
  return list;
}

bool is_spectral(ParamType type) {
  return type == ParamType::Rgb || type == ParamType::Xyz || type == ParamType::Blackbody ||
         type == ParamType::Spectrum;
}

bool takes_numbers(ParamType type) {
  return type != ParamType::Bool && type != ParamType::String && type != ParamType::Texture;
}

bool takes_strings(ParamType type) { return !takes_numbers(type) || type == ParamType::Spectrum; }

std::string wanted(ParamType type) {
  switch (type) {
    case ParamType::Bool: return "the strings \"true\" and \"false\"";
    case ParamType::String: return "strings in quotes";
    case ParamType::Texture: return "the name of a texture in quotes";
    case ParamType::Spectrum: return "numbers or the names of .spd files in quotes";
    default: return "numbers";
  }
}

/// The type and name of a declaration such as "float radius"; words that are missing are empty.
struct Declaration {
  std::string type, name;
  bool extra = false;
};

Declaration split_declaration(std::string_view text) {
  Declaration out;
  const auto word = [&text] {
    const size_t start = std::min(text.find_first_not_of(" \t"), text.size());
    const size_t stop = std::min(text.find_first_of(" \t", start), text.size());
    std::string found(text.substr(start, stop - start));
    text.remove_prefix(stop);
    return found;
  };
  out.type = word();
  out.name = word();
  out.extra = !word().empty();
  return out;
}

/// The text between the quotes, escapes left as they are.
std::string_view inside(const Token& string) { return string.text.substr(1, string.text.size() - 2); }

/// Reads one parameter. A declaration that was understood, then its values, then what can only be checked
/// when all are there.
class ParameterReader {
 public:
  explicit ParameterReader(Lexer& lexer) : lexer_(lexer), reporter_(lexer.reporter()) {}

  /// False when reading has to resynchronise. `good` tells whether `out` is usable.
  bool read(Parameter& out, bool& good) {
    const Token declaration = lexer_.next();
    out.where = lexer_.pos(declaration);
    good = declare(declaration, out);
    if (!good) return skip_value();
    const Token value = lexer_.peek();
    out.values_at = lexer_.pos(value);
    if (value.kind == TokenKind::Bad) return false;
    if (value.kind == TokenKind::Open) {
      lexer_.next();
      if (!read_list(value, out, good)) return false;
      if (good) good = check_list(out);
      return true;
    }
    good = read_bare(value, out);
    if (good) good = check_list(out);
    return true;
  }

 private:
  bool declare(const Token& token, Parameter& out);
  bool skip_value();
  bool skip_list(const Token& open);
  bool read_bare(const Token& value, Parameter& out);
  bool read_list(const Token& open, Parameter& out, bool& good);
  bool append(Parameter& out);
  void append_string(const Token& token, Parameter& out);
  void report_misfit(const Token& token, const Parameter& out);
  bool check_list(Parameter& out);
  void check_wavelengths(Parameter& out);
  std::string title(const Parameter& p) const { return in_quotes(std::string(param_type_name(p.type)) + " " + p.name); }

  Lexer& lexer_;
  Reporter& reporter_;
};

bool ParameterReader::declare(const Token& token, Parameter& out) {
  const Declaration words = split_declaration(lexer_.unquote(token));
  const std::optional<ParamType> type = find_param_type(words.type);
  if (words.name.empty() || words.extra) {
    const std::string example = type || words.type.empty() ? "float radius" : "float " + words.type;
    const std::string foreign = foreign_characters(inside(token));
    reporter_.error(lexer_.pos(token), "a parameter is declared by a type and a name, not " + in_quotes(inside(token)),
                    "as in " + in_quotes(example) + (foreign.empty() ? "" : "; " + foreign));
    return false;
  }
  if (!type) {
    reporter_.error(lexer_.pos(token), "unknown parameter type " + in_quotes(words.type), type_remedy(words.type));
    return false;
  }
  out.type = *type;
  out.name = words.name;
  if (out.type == ParamType::Integer) {
    out.values = std::vector<int32_t>();
  } else if (out.type == ParamType::Bool) {
    out.values = std::vector<uint8_t>();
  } else if (out.type == ParamType::String) {
    out.values = std::vector<std::string>();
  } else if (out.type == ParamType::Texture) {
    out.values = std::vector<TextureRef>();
  } else {
    out.values = std::vector<double>();
  }
  return true;
}

/// Passes over the value of a declaration that was not understood.
bool ParameterReader::skip_value() {
  const Token value = lexer_.peek();
  if (value.kind == TokenKind::Bad) return false;
  if (value.kind == TokenKind::Open) return skip_list(lexer_.next());
  if (value.kind == TokenKind::Number || value.kind == TokenKind::String) lexer_.next();
  return true;
}

/// Passes over the rest of a list, nested ones included; false when it is not closed before the next statement.
bool ParameterReader::skip_list(const Token& open) {
  for (int depth = 1; depth > 0;) {
    const Token token = lexer_.peek();
    const bool directive = token.kind == TokenKind::Word && is_directive(token.text);
    if (token.kind == TokenKind::Bad) return false;
    if (token.kind == TokenKind::End || directive) {
      reporter_.error(lexer_.pos(open), "list not closed", "add the closing ]");
      return false;
    }
    if (token.kind == TokenKind::Open) ++depth;
    if (token.kind == TokenKind::Close) --depth;
    lexer_.next();
  }
  return true;
}

/// Consumes what fits the parameter's type from here on; false when something was reported.
bool ParameterReader::append(Parameter& out) {
  const Token token = lexer_.peek();
  if (token.kind == TokenKind::String && takes_strings(out.type)) {
    append_string(lexer_.next(), out);
    return true;
  }
  if (out.type == ParamType::Integer) return lexer_.read_integers(std::get<std::vector<int32_t>>(out.values));
  return lexer_.read_numbers(std::get<std::vector<double>>(out.values));
}

void ParameterReader::append_string(const Token& token, Parameter& out) {
  std::string text = lexer_.unquote(token);
  if (out.type == ParamType::Texture) {
    std::get<std::vector<TextureRef>>(out.values).push_back({std::move(text), -1, -1});
  } else if (out.type == ParamType::Bool) {
    if (text != "true" && text != "false")
      reporter_.warning(lexer_.pos(token), "bool value " + in_quotes(text) + " is neither \"true\" nor \"false\"",
                        "\"false\" is used");
    std::get<std::vector<uint8_t>>(out.values).push_back(text == "true" ? 1 : 0);
  } else {
    // A spectrum that names files turns from numbers into strings at the first name.
    if (!std::holds_alternative<std::vector<std::string>>(out.values)) out.values = std::vector<std::string>();
    std::get<std::vector<std::string>>(out.values).push_back(std::move(text));
  }
}

bool fits(const Token& token, const Parameter& out) {
  if (token.kind == TokenKind::Number) return takes_numbers(out.type) && out.strings().empty();
  return token.kind == TokenKind::String && takes_strings(out.type) && out.numbers().empty();
}

bool is_truth(const Token& token) { return token.text == "true" || token.text == "false"; }

void ParameterReader::report_misfit(const Token& token, const Parameter& out) {
  const SourcePos where = lexer_.pos(token);
  const std::string foreign = foreign_characters(token.kind == TokenKind::Word ? token.text : std::string_view());
  const bool first = out.numbers().empty() && out.integers().empty() && out.strings().empty() && out.bools().empty() &&
                     out.textures().empty();
  if (token.kind == TokenKind::Open) {
    reporter_.error(where, "a list inside a list", "values are written without inner brackets");
  } else if (token.kind == TokenKind::Word && takes_numbers(out.type)) {
    reporter_.error(where, in_quotes(token.text) + " is not a number",
                    title(out) + " takes " + wanted(out.type) + (foreign.empty() ? "" : "; " + foreign));
  } else if (out.type == ParamType::Bool && is_truth(token) && reporter_.is_foreign("pbrt-v4")) {
    reporter_.foreign(where, "pbrt-v4", Severity::Error, title(out) + " takes " + wanted(out.type));
  } else if (out.type == ParamType::Bool) {
    reporter_.error(where, title(out) + " takes " + wanted(out.type) + ", not " + in_quotes(token.text),
                    is_truth(token) ? "put it in quotes" : foreign);
  } else if (!first) {
    reporter_.error(where, "numbers and strings in one list", title(out) + " takes " + wanted(out.type));
  } else {
    const std::string_view text = token.kind == TokenKind::String ? inside(token) : token.text;
    const char* kind = token.kind == TokenKind::String   ? "the string "
                       : token.kind == TokenKind::Number ? "the number "
                                                         : "";
    reporter_.error(where, title(out) + " takes " + wanted(out.type) + ", not " + kind + in_quotes(text), foreign);
  }
}

/// Reads values up to the closing bracket. False when reading has to resynchronise.
bool ParameterReader::read_list(const Token& open, Parameter& out, bool& good) {
  for (;;) {
    const Token token = lexer_.peek();
    if (token.kind == TokenKind::Close) {
      lexer_.next();
      return true;
    }
    if (token.kind == TokenKind::Bad) return false;
    const bool ends = token.kind == TokenKind::End || (token.kind == TokenKind::Word && is_directive(token.text));
    good = !ends && fits(token, out);
    if (!good && !ends) report_misfit(token, out);
    if (good) good = append(out);
    if (!good) return skip_list(open);
  }
}

/// Reads a value without brackets; false when there is none or it was reported.
bool ParameterReader::read_bare(const Token& value, Parameter& out) {
  const bool declares = value.kind == TokenKind::String && !takes_strings(out.type) &&
                        find_param_type(split_declaration(inside(value)).type).has_value();
  const bool word = value.kind == TokenKind::Word && !is_directive(value.text);
  if (declares || (value.kind != TokenKind::Number && value.kind != TokenKind::String && !word)) {
    reporter_.error(out.where, title(out) + " has no value", "it takes " + wanted(out.type));
    return false;
  }
  if (!fits(value, out)) {
    report_misfit(value, out);
    lexer_.next();
    return false;
  }
  bool good = append(out);
  if (!good) {
    lexer_.next();
    return false;
  }
  // append() took every number there was; only one of them needs no brackets.
  const size_t count = std::max(out.numbers().size(), out.integers().size());
  if (count > 1) {
    reporter_.error(out.values_at, "several values of " + title(out) + " without brackets",
                    "write [ and ] around them");
    good = false;
  }
  return good;
}

bool ParameterReader::check_list(Parameter& out) {
  if (out.is_empty()) return true;  // Whether that is a mistake depends on the parameter.
  const size_t numbers = out.numbers().size();
  const size_t each = numbers_a_value(out.type);
  if (numbers % each != 0) {
    std::string message = title(out) + " has " + std::to_string(numbers) + (numbers == 1 ? " number" : " numbers");
    if (out.type == ParamType::Spectrum) {
      message += ", but a spectrum is pairs of wavelength and value";
    } else if (out.type == ParamType::Blackbody) {
      message += ", but a blackbody is pairs of temperature and scale";
    } else {
      message += ", but one " + std::string(param_type_name(out.type)) + " is " + std::to_string(each);
    }
    reporter_.error(out.values_at, message);
    return false;
  }
  if (out.type == ParamType::Spectrum) check_wavelengths(out);
  return true;
}

/// Sorts the pairs of a spectrum, as pbrt does, so that everything behind can rely on their order.
void ParameterReader::check_wavelengths(Parameter& out) {
  const std::vector<double>& flat = out.numbers();
  std::vector<std::pair<double, double>> pairs;
  for (size_t i = 0; i + 1 < flat.size(); i += 2) pairs.emplace_back(flat[i], flat[i + 1]);
  const auto by_wavelength = [](const auto& a, const auto& b) { return a.first < b.first; };
  if (std::is_sorted(pairs.begin(), pairs.end(), by_wavelength)) return;
  reporter_.warning(out.values_at, "the wavelengths of " + title(out) + " do not increase", "they are sorted");
  std::stable_sort(pairs.begin(), pairs.end(), by_wavelength);
  auto& sorted = std::get<std::vector<double>>(out.values);
  for (size_t i = 0; i < pairs.size(); ++i) std::tie(sorted[2 * i], sorted[2 * i + 1]) = pairs[i];
}

/// Drops every parameter that a later one of the same name and type replaces. All ways to write a spectrum
/// are one type here, as in pbrt. Saying the same twice, as exporters do, is not worth a warning.
void drop_duplicates(ParameterList& list, Reporter& reporter) {
  if (list.size() < 2) return;
  const auto key = [&](size_t i) {
    const ParamType type = is_spectral(list[i].type) ? ParamType::Spectrum : list[i].type;
    return std::tuple<ParamType, const std::string&, size_t>(type, list[i].name, i);
  };
  std::vector<size_t> order(list.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return key(a) < key(b); });
  std::vector<bool> dropped(list.size(), false);
  bool any = false;
  for (size_t n = 0; n + 1 < order.size(); ++n) {
    const auto a = key(order[n]), b = key(order[n + 1]);
    if (std::get<0>(a) != std::get<0>(b) || std::get<1>(a) != std::get<1>(b)) continue;
    dropped[order[n]] = any = true;
    const Parameter &first = list[order[n]], &last = list[order[n + 1]];
    if (first.type == last.type && first.values == last.values) continue;
    reporter.warning(last.where, "parameter " + in_quotes(last.name) + " is given twice", "the last one is used");
  }
  if (!any) return;
  ParameterList kept;
  for (size_t i = 0; i < list.size(); ++i)
    if (!dropped[i]) kept.push_back(std::move(list[i]));
  list = std::move(kept);
}

}  // namespace

std::optional<ParamType> find_param_type(std::string_view name) {
  for (const TypeName& type : kTypes)
    if (type.name == name) return type.type;
  return std::nullopt;
}

std::vector<std::string> param_type_names() {
  std::vector<std::string> names;
  for (const TypeName& type : kTypes) names.emplace_back(type.name);
  return names;
}

bool read_parameters(Lexer& lexer, ParameterList& out) {
  ParameterReader reader(lexer);
  while (lexer.peek().kind == TokenKind::String) {
    Parameter parameter;
    bool good = false;
    const bool goes_on = reader.read(parameter, good);
    if (good && goes_on) out.push_back(std::move(parameter));
    if (!goes_on) return false;
  }
  drop_duplicates(out, lexer.reporter());
  return lexer.peek().kind != TokenKind::Bad;
}

void append_parameters(ParameterList& out, ParameterList&& more, Reporter& reporter) {
  std::move(more.begin(), more.end(), std::back_inserter(out));
  drop_duplicates(out, reporter);
}

}  // namespace whit
