// `whit help`: commands and plugins, from the same tables that run and parse them.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/plugin/registry.h"
#include "tools/whit/commands.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

void print_overview() {
  fmt::print("whit renders pbrt-v3 scene files with an Embree-accelerated Whitted integrator.\n\ncommands\n");
  for (const Command& c : commands()) fmt::print("  whit {:<32} {}\n", c.synopsis, c.summary);
  fmt::print("  (each has --help)\n\nplugins (whit help CATEGORY NAME shows parameters)\n");
  std::set<std::string> categories;
  for (const PluginInfo* p : list_plugins()) categories.insert(p->category);
  for (const std::string& category : categories) {
    std::string names;
    for (const std::string& name : plugin_names(category)) names += (names.empty() ? "" : " ") + name;
    fmt::print("  {:<18} {}\n", category, names);
  }
}

std::string range_text(const Range& r) {
  const bool low = std::isfinite(r.min), high = std::isfinite(r.max);
  if (!low && !high) return {};
  if (low && r.min > 0 && r.min < 1e-300) return high ? fmt::format("above 0, at most {:g}", r.max) : "above 0";
  if (low && high) return fmt::format("{:g} to {:g}", r.min, r.max);
  return low ? fmt::format("at least {:g}", r.min) : fmt::format("at most {:g}", r.max);
}

void print_param(const ParamSpec& p) {
  std::string facts;
  const auto fact = [&](const std::string& f) {
    if (!f.empty()) facts += (facts.empty() ? "" : ", ") + f;
  };
  if (!p.default_text.empty()) fact("default " + p.default_text);
  fact(unit_name(p.unit));
  fact(range_text(p.range));
  if (!p.choices.empty()) {
    std::string all;
    for (const std::string& c : p.choices) all += (all.empty() ? "" : " ") + c;
    fact("one of " + all);
  }
  fmt::print("  \"{} {}\"{}\n      {}\n", p.type, p.name, facts.empty() ? "" : "  (" + facts + ")", p.doc);
}

void print_plugin(const PluginInfo& p) {
  std::string aliases;
  for (const std::string& a : p.aliases) aliases += fmt::format(", also \"{}\"", a);
  fmt::print("{} \"{}\"{}: {}\n", p.category, p.name, aliases, p.doc);
  for (const ParamSpec& spec : p.params) print_param(spec);
}

std::string remedy(const std::string& text) { return text.empty() ? "" : "; " + text; }

}  // namespace

int help_command(const Arguments& args) {
  if (args.empty() || args[0] == "--help" || args[0] == "-h") {
    print_overview();
    return kDone;
  }
  // A category may be two words: "float texture".
  std::string category = args[0];
  size_t used = 1;
  if (list_plugins(category).empty() && args.size() > 1) category += " " + args[1], used = 2;
  const auto plugins = list_plugins(category);
  if (plugins.empty()) {
    std::vector<std::string> known;
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
