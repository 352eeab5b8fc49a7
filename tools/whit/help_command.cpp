// `whit help`: commands, plugins and statements, from the same tables that run and parse them.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/plugin/registry.h"
#include "core/render/aovs.h"
#include "parser/statements.h"
#include "tools/whit/commands.h"
#include "tools/whit/json.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

// ---- For people ----

void print_overview() {
  fmt::print(
      "whit renders pbrt-v3 scene files and glTF models with an Embree-accelerated Whitted integrator.\n\ncommands\n");
  for (const Command& c : commands()) fmt::print("  whit {:<32} {}\n", c.synopsis, c.summary);
  fmt::print("  (each has --help)\n\nplugins (whit help CATEGORY NAME shows parameters)\n");
  std::set<std::string> categories;
  for (const PluginInfo* p : list_plugins()) categories.insert(p->category);
  for (const std::string& category : categories) {
    std::string names;
    for (const std::string& name : plugin_names(category)) names += (names.empty() ? "" : " ") + name;
    fmt::print("  {:<18} {}\n", category, names);
  }
  fmt::print(
      "\nwhit help statement shows the statements of a scene file, whit help effects what --without knows, whit help "
      "aovs "
      "what --aov does; "
      "--json prints all this for machines\n");
}

/// True for the types that go wherever "rgb" does.
bool is_other_colour(ParamType t) {
  return t == ParamType::Xyz || t == ParamType::Blackbody || t == ParamType::Spectrum;
}

/// The range, or "" where every float is allowed.
std::string limits_text(const Range& r) {
  constexpr double most = std::numeric_limits<float>::max();
  return r.min <= -most && r.max >= most ? std::string() : range_text(r);
}

void print_param(const ParamSpec& p) {
  std::string declared, facts;
  for (const ParamType type : p.accepts) {
    if (is_other_colour(type)) continue;
    declared += fmt::format("{}\"{} {}\"", declared.empty() ? "" : " or ", param_type_name(type), p.name);
  }
  const auto fact = [&](const std::string& f) {
    if (!f.empty()) facts += (facts.empty() ? "" : ", ") + f;
  };
  if (!p.default_text.empty()) fact("default " + p.default_text);
  fact(unit_name(p.unit));
  fact(limits_text(p.range));
  if (!p.choices.empty()) fact(fmt::format("one of {}", fmt::join(p.choices, " ")));
  fmt::print("  {}{}\n      {}\n", declared, facts.empty() ? "" : "  (" + facts + ")", p.doc);
}

void print_plugin(const PluginInfo& p) {
  std::string aliases;
  for (const std::string& a : p.aliases) aliases += fmt::format(", also \"{}\"", a);
  fmt::print("{} \"{}\"{}: {}\n", p.category, p.name, aliases, p.doc);
  bool colours = false;
  for (const ParamSpec& spec : p.params) {
    print_param(spec);
    colours |= std::any_of(spec.accepts.begin(), spec.accepts.end(), is_other_colour);
  }
  if (colours) fmt::print("  (\"rgb\" may also be \"xyz\", \"blackbody\" or \"spectrum\")\n");
}

void print_statements() {
  for (const StatementRow& s : statements()) {
    const char* const space = s.arguments.usage.empty() ? "" : " ";
    fmt::print("{}{}{}\n    {}\n", s.name, space, s.arguments.usage, s.doc);
  }
}

void print_effects() {
  for_effects(EffectSet::all(), [](Effect e) {
    const EffectInfo& info = effect_info(e);
    fmt::print("{:<18} {}; without: {}\n", info.name, info.doc, info.off);
  });
}

/// Channels of an AOV, those of a layer together: "N.X .Y .Z".
std::string channels_text(const AovRow& row) {
  std::string text = row.by_light_group ? "lightgroup.NAME" : "";
  for (const std::string& channel : row.channels) {
    const size_t dot = text.empty() ? 0 : channel.find('.');
    text += fmt::format("{}{}", text.empty() ? "" : " ", channel.substr(dot == std::string::npos ? 0 : dot));
  }
  return text;
}

void print_aovs() {
  for (const AovRow& row : all_aovs()) fmt::print("{:<12} {}\n    {}\n", row.name, channels_text(row), row.doc);
}

// ---- For machines ----

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
  return Json::Object{{"name", s.name},
                      {"arguments", s.arguments.usage},
                      {"block", kBlocks[static_cast<int>(s.block)]},
                      {"doc", s.doc}};
}

void print_json() {
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
  fmt::print("{}\n",
             to_text(Json::Object{{"plugins", plugins}, {"statements", rows}, {"effects", effects}, {"aovs", aovs}}));
}

std::string remedy(const std::string& text) { return text.empty() ? "" : "; " + text; }

}  // namespace

int help_command(const Arguments& args) {
  if (args.empty() || args[0] == "--help" || args[0] == "-h") {
    print_overview();
    return kDone;
  }
  const std::pair<const char*, void (*)()> topics[] = {
      {"--json", print_json}, {"statement", print_statements}, {"effects", print_effects}, {"aovs", print_aovs}};
  for (const auto& [topic, print] : topics) {
    if (args[0] != topic) continue;
    print();
    return kDone;
  }
  // A category may be two words: "float texture".
  std::string category = args[0];
  size_t used = 1;
  if (list_plugins(category).empty() && args.size() > 1) category += " " + args[1], used = 2;
  const auto plugins = list_plugins(category);
  if (plugins.empty()) {
    std::vector<std::string> known{"statement", "effects", "aovs"};
    for (const PluginInfo* p : list_plugins()) known.push_back(p->category);
    say(fmt::format("whit help: no category \"{}\"{}", args[0], remedy(did_you_mean(args[0], known))));
    return kUsage;
  }
  if (args.size() == used) {
    for (const PluginInfo* p : plugins) print_plugin(*p);
    return kDone;
  }
  const PluginInfo* p = find_plugin(category, args[used]);
  if (!p) {
    say(fmt::format("whit help: no {} \"{}\"{}", category, args[used],
                    remedy(did_you_mean(args[used], plugin_names(category)))));
    return kUsage;
  }
  print_plugin(*p);
  return kDone;
}

}  // namespace whit
