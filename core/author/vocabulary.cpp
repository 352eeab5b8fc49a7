#include "core/author/vocabulary.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace whit::author {
namespace {

struct CategoryRow {
  std::string_view directive;
  const char* category;
  int string = 0;  ///< Which of the statement's strings is the plugin's name.
};
constexpr CategoryRow kCategories[] = {
    {"Camera", "camera"},
    {"Film", "film"},
    {"Filter", "filter"},
    {"PixelFilter", "filter"},
    {"Integrator", "integrator"},
    {"Sampler", "sampler"},
    {"Texture", "float texture", 2},
    {"Texture", "spectrum texture", 2},
    {"Material", "material"},
    {"MakeNamedMaterial", "material", -1},
    {"LightSource", "light"},
    {"AreaLightSource", "area light"},
    {"Shape", "shape"},
};

/// Every float there is: not worth a word.
std::string limits_text(const Range& r) {
  constexpr double most = std::numeric_limits<float>::max();
  return r.min <= -most && r.max >= most ? std::string() : range_text(r);
}

}  // namespace

std::vector<std::string> categories_of(std::string_view directive) {
  std::vector<std::string> out;
  for (const CategoryRow& row : kCategories) {
    if (row.directive == directive) out.emplace_back(row.category);
  }
  return out;
}

std::string category_of(const Statement& s) {
  const std::vector<std::string> all = categories_of(s.row->name);
  if (all.size() < 2) return all.empty() ? std::string() : all.front();
  return s.names.size() > 1 && s.names[1] == "float" ? all[0] : all[1];
}

int plugin_string(std::string_view directive) {
  for (const CategoryRow& row : kCategories) {
    if (row.directive == directive) return row.string;
  }
  return -1;
}

std::string plugin_name(const Statement& s) {
  const int string = plugin_string(s.row->name);
  if (string >= 0) return static_cast<size_t>(string) < s.names.size() ? s.names[static_cast<size_t>(string)] : "";
  for (const Parameter& p : s.parameters) {
    if (p.name == "type" && !p.strings().empty()) return p.strings().front();
  }
  return {};
}

const PluginInfo* plugin_of(const Statement& s) {
  if (!s.row || !s.row->arguments.parameters) return nullptr;
  const std::string category = category_of(s);
  return category.empty() ? nullptr : find_plugin(category, plugin_name(s));
}

bool names_file(const Statement& s, const Parameter& p) {
  if (p.strings().empty()) return false;
  if (p.type == ParamType::Spectrum) return true;
  if (p.type != ParamType::String) return false;
  const PluginInfo* plugin = plugin_of(s);
  const ParamSpec* spec = plugin ? plugin->find_param(p.name) : nullptr;
  return spec && spec->is_file;
}

bool is_colour(ParamType type) {
  return type == ParamType::Rgb || type == ParamType::Xyz || type == ParamType::Blackbody ||
         type == ParamType::Spectrum;
}

std::string describe(const StatementRow& row) {
  const char* const space = row.arguments.usage.empty() ? "" : " ";
  return fmt::format("```pbrt\n{}{}{}\n```\n{}", row.name, space, row.arguments.usage, row.doc);
}

std::string describe(const PluginInfo& plugin) {
  std::string out = fmt::format("**{}** ({}): {}", plugin.name, plugin.category, plugin.doc);
  for (const ParamSpec& p : plugin.params) {
    const std::string more = facts(p);
    out += fmt::format("\n- `{} {}`{}{}{}", param_type_name(p.accepts.front()), p.name, more.empty() ? "" : " (", more,
                       more.empty() ? "" : ")");
  }
  return out;
}

std::string facts(const ParamSpec& p) {
  std::string out;
  const auto add = [&out](const std::string& fact) {
    if (!fact.empty()) out += (out.empty() ? "" : ", ") + fact;
  };
  if (!p.default_text.empty()) add("default " + p.default_text);
  add(unit_name(p.unit));
  add(limits_text(p.range));
  if (!p.choices.empty()) add(fmt::format("one of {}", fmt::join(p.choices, ", ")));
  return out;
}

std::string describe(const ParamSpec& p) {
  std::string types;
  for (const ParamType type : p.accepts) types += (types.empty() ? "" : " | ") + std::string(param_type_name(type));
  std::string out = fmt::format("**{}** ({}): {}", p.name, types, p.doc);
  if (const std::string more = facts(p); !more.empty()) out += "\n\n" + more;
  return out;
}

}  // namespace whit::author
