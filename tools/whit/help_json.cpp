#include "tools/whit/help_json.h"

#include <cmath>

#include "core/plugin/registry.h"
#include "core/render/aovs.h"
#include "parser/parameters.h"
#include "parser/statements.h"
#include "tools/whit/help_text.h"
#include "tools/whit/json.h"
#include "tools/whit/plugin_statements.h"

namespace whit {
namespace {

Json describe(const ParamSpec& p) {
  Json::Array types;
  for (const ParamType type : p.accepts) types.push_back(param_type_name(type));
  Json::Object j{{"name", p.name}, {"types", types}};
  if (!p.default_text.empty()) j.emplace_back("default", p.default_text);
  if (p.unit != Unit::None) j.emplace_back("unit", unit_name(p.unit));
  if (const std::string limits = limits_text(p.range); !limits.empty()) {
    j.emplace_back("range", limits);
    if (std::isfinite(p.range.min)) j.emplace_back("minimum", p.range.min);
    if (std::isfinite(p.range.max)) j.emplace_back("maximum", p.range.max);
  }
  if (!p.choices.empty()) j.emplace_back("choices", p.choices);
  j.emplace_back("doc", p.doc);
  return j;
}

Json describe(const PluginInfo& p) {
  Json::Array parameters;
  for (const ParamSpec& spec : p.params) parameters.push_back(describe(spec));
  return Json::Object{
      {"category", p.category}, {"name", p.name}, {"aliases", p.aliases}, {"doc", p.doc}, {"parameters", parameters}};
}

Json describe(const StatementRow& s) {
  constexpr const char* kBlocks[] = {"options", "world", "both"};
  Json::Array categories;
  for (const char* category : categories_of(s.name)) categories.push_back(category);
  return Json::Object{{"name", s.name},
                      {"arguments", s.arguments.usage},
                      {"strings", s.arguments.max_strings},
                      {"word", s.arguments.word},
                      {"numbers", s.arguments.numbers},
                      {"parameters", s.arguments.parameters},
                      {"plugins", categories},
                      {"block", kBlocks[static_cast<int>(s.block)]},
                      {"nesting", s.nesting},
                      {"doc", s.doc}};
}

/// Names of types, and the type that each stands for.
Json describe_types() {
  Json::Array types;
  for (const std::string& name : param_type_names())
    types.push_back(Json::Object{{"name", name}, {"type", param_type_name(*find_param_type(name))}});
  return types;
}

}  // namespace

std::string help_json() {
  Json::Array plugins, rows, effects, aovs;
  for (const PluginInfo* p : list_plugins()) plugins.push_back(describe(*p));
  for (const StatementRow& s : statements()) rows.push_back(describe(s));
  for_effects(EffectSet::all(), [&](Effect e) {
    const EffectInfo& info = effect_info(e);
    effects.push_back(Json::Object{{"name", info.name}, {"doc", info.doc}, {"without", info.off}});
  });
  for (const AovRow& row : all_aovs()) {
    aovs.push_back(Json::Object{
        {"name", row.name}, {"channels", channels_text(row)}, {"pixel", pixel_text(row.pixel)}, {"doc", row.doc}});
  }
  return to_text(Json::Object{
      {"plugins", plugins}, {"statements", rows}, {"types", describe_types()}, {"effects", effects}, {"aovs", aovs}});
}

}  // namespace whit
