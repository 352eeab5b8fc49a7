#include "tests/fuzz/shared/scene_vocabulary.h"

#include <algorithm>

#include "parser/parameters.h"
#include "parser/statements.h"
#include "tools/whit/plugin_statements.h"

namespace whit::fuzz {
namespace {

std::string quoted(const std::string& text) { return '"' + text + '"'; }

template <class T>
const T& any(const std::vector<T>& list, Dice& dice) {
  return dice.one_of(list);
}

/// Files of tests/fuzz/corpus/files, and one that is not there.
constexpr std::string_view kFiles[] = {"grey.png",   "half.jpg",      "pole.pfm",   "tiny.exr",
                                       "tiny.tga",   "triangle.ply",  "lamp.spd",   "lens.dat",
                                       "small.bsdf", "triangle.gltf", "shape.pbrt", "missing"};
constexpr std::string_view kNames[] = {"a", "b", "t1", "t2", "m1", "m2", "", "camera", "world"};

std::string string_value(const ParamSpec& spec, Dice& dice) {
  if (!spec.choices.empty() && !dice.one_in(16)) return quoted(any(spec.choices, dice));
  if (spec.is_file && !dice.one_in(16)) return quoted(std::string(dice.one_of(kFiles)));
  return any_name(dice);
}

void add_value(ParamType type, const ParamSpec& spec, Dice& dice, Tokens& out) {
  switch (type) {
    case ParamType::Bool: out.emplace_back(dice.one_in(2) ? "\"true\"" : "\"false\""); break;
    case ParamType::String: out.push_back(string_value(spec, dice)); break;
    case ParamType::Texture: out.push_back(any_name(dice)); break;
    default:
      if (type == ParamType::Spectrum && dice.one_in(2)) {
        out.emplace_back("\"lamp.spd\"");
        break;
      }
      for (size_t i = 0; i < numbers_a_value(type); ++i) out.push_back(odd_number(dice));
  }
}

/// Small indices, in threes, are what meshes are made of: odd numbers alone would never make one.
void add_indices(Dice& dice, Tokens& out) {
  for (size_t n = 3 * (1 + dice.below(4)); n > 0; --n) out.push_back(std::to_string(dice.below(4)));
}

void append(Tokens& out, Tokens more) { out.insert(out.end(), more.begin(), more.end()); }

/// The category whose plugins a statement names: of several one.
std::string category_of(std::string_view statement, Dice& dice) {
  const auto found = categories_of(statement);
  return found.empty() ? "" : found[dice.below(found.size())];
}

/// A plugin's name in quotes with some of its parameters.
Tokens make_plugin(const std::string& category, Dice& dice) {
  const PluginInfo& info = *any(list_plugins(category), dice);
  Tokens out{quoted(info.name)};
  for (size_t n = dice.below(5); n > 0; --n) append(out, make_parameter(info, dice));
  return out;
}

}  // namespace

std::string any_name(Dice& dice) { return quoted(std::string(dice.one_of(kNames))); }

std::string any_type(Dice& dice) {
  static const std::vector<std::string> types = param_type_names();
  return any(types, dice);
}

std::string other_plugin(const PluginInfo& info, Dice& dice) {
  return quoted(any(list_plugins(dice.one_in(16) ? "" : info.category), dice)->name);
}

Tokens make_parameter(const PluginInfo& info, Dice& dice) {
  if (info.params.empty()) return {};
  const ParamSpec& spec = any(info.params, dice);
  const ParamType type = any(spec.accepts, dice);
  Tokens out{quoted(std::string(param_type_name(type)) + " " + spec.name), "["};
  if (spec.is_list && type == ParamType::Integer && !dice.one_in(4)) add_indices(dice, out);
  else
    for (size_t n = spec.is_list ? 1 + dice.below(5) : 1; n > 0; --n) add_value(type, spec, dice, out);
  out.emplace_back("]");
  return out;
}

const PluginInfo* plugin_of(const Tokens& statement) {
  if (statement.empty()) return nullptr;
  const bool is_texture = statement[0] == "Texture";
  const size_t at = is_texture ? 3 : 1;
  if (statement.size() <= at || !is_quoted(statement[at])) return nullptr;
  const std::string name = statement[at].substr(1, statement[at].size() - 2);
  for (const char* category : categories_of(statement[0]))
    if (const PluginInfo* info = find_plugin(category, name)) return info;
  return nullptr;
}

Tokens make_statement(Dice& dice) {
  const StatementRow& row = dice.one_of(statements());
  Tokens out{std::string(row.name)};
  const std::string category = category_of(row.name, dice);
  if (row.name == "Texture") append(out, {any_name(dice), quoted(category.substr(0, category.find(' ')))});
  if (row.name == "MakeNamedMaterial") {
    Tokens plugin = make_plugin(category, dice);
    append(out, {any_name(dice), "\"string type\"", plugin.front()});
    plugin.erase(plugin.begin());
    append(out, std::move(plugin));
  } else if (!category.empty()) {
    append(out, make_plugin(category, dice));
  } else if (row.name == "Include") {
    out.emplace_back("\"shape.pbrt\"");
  } else {
    for (size_t n = row.arguments.min_strings; n > 0; --n) out.push_back(any_name(dice));
  }
  if (row.arguments.word) out.emplace_back(dice.one_in(2) ? "All" : dice.one_in(2) ? "StartTime" : "EndTime");
  for (size_t n = row.arguments.numbers; n > 0; --n) out.push_back(odd_number(dice));
  return out;
}

}  // namespace whit::fuzz
