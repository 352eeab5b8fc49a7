#include "tools/whit/help_text.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string_view>

#include "tools/whit/commands.h"
#include "tools/whit/plugin_statements.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

constexpr int kColumns = 120;  ///< Where there is no terminal, and of wider ones, on which long lines are hard to read.

int columns() { return std::clamp(columns_of(STDOUT_FILENO, kColumns), 40, kColumns); }

/// What one looks for, in bold on a terminal.
std::string strong(std::string_view text) {
  return use_colour() && isatty(STDOUT_FILENO) != 0 ? fmt::format("\033[1m{}\033[0m", text) : std::string(text);
}

/// Prints words, in lines that fit, from a column that the first line has reached already; the others begin at `indent`.
void print_words(std::string_view text, size_t column, size_t indent) {
  const auto width = static_cast<size_t>(columns());
  bool first = true;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find(' ', at), text.size());
    const std::string_view word = text.substr(at, end - at);
    if (!first && column + 1 + word.size() > width) {
      fmt::print("\n{:{}}", "", indent);
      column = indent;
    } else if (!first) {
      fmt::print(" ");
      ++column;
    }
    fmt::print("{}", word);
    column += word.size();
    first = false;
    at = end + 1;
  }
  fmt::print("\n");
}

void print_indented(std::string_view text, size_t indent) {
  fmt::print("{:{}}", "", indent);
  print_words(text, indent, indent);
}

/// True for the types that go wherever "rgb" does.
bool is_other_colour(ParamType t) {
  return t == ParamType::Xyz || t == ParamType::Blackbody || t == ParamType::Spectrum;
}

/// "default 1, scene length, at least 0".
std::string facts_of(const ParamSpec& p) {
  std::string facts;
  const auto add = [&](const std::string& fact) {
    if (!fact.empty()) facts.append(facts.empty() ? "" : ", ").append(fact);
  };
  if (!p.default_text.empty()) add("default " + p.default_text);
  add(unit_name(p.unit));
  add(limits_text(p.range));
  if (!p.choices.empty()) add(fmt::format("one of \"{}\"", fmt::join(p.choices, "\" \"")));
  return facts;
}

void print_param(const ParamSpec& p) {
  std::string declared, shown;
  for (const ParamType type : p.accepts) {
    if (is_other_colour(type)) continue;
    const char* const between = declared.empty() ? "" : " or ";
    declared.append(fmt::format("{}\"{} {}\"", between, param_type_name(type), p.name));
    shown.append(fmt::format("{}\"{} {}\"", between, param_type_name(type), strong(p.name)));
  }
  const std::string facts = facts_of(p);
  fmt::print("  {}{}", shown, facts.empty() ? "" : "  ");
  print_words(facts.empty() ? "" : fmt::format("({})", facts), 4 + declared.size(), 6);
  print_indented(p.doc, 6);
}

}  // namespace

void print_overview() {
  fmt::print(
      "whit renders pbrt-v3 scene files and glTF models with an Embree-accelerated Whitted integrator.\n\ncommands\n");
  size_t longest = 0;
  for (const Command& c : commands()) longest = std::max(longest, std::string_view(c.synopsis).size());
  for (const Command& c : commands()) {
    fmt::print("  whit {:<{}}  ", c.synopsis, longest);
    print_words(c.summary, longest + 9, longest + 9);
  }
  fmt::print("  (each has --help)\n\nplugins\n");
  std::set<std::string> categories;
  for (const PluginInfo* p : list_plugins()) categories.insert(p->category);
  for (const std::string& category : categories) {
    fmt::print("  {:<18} ", category);
    print_words(fmt::format("{}", fmt::join(plugin_names(category), " ")), 21, 21);
  }
  fmt::print("\n");
  print_words(
      "whit help NAME explains any of these, and each statement, effect and AOV: whit help imagemap, whit help shape "
      "sphere, whit help LookAt. whit help statements lists what a scene file is made of, whit help effects what "
      "--without knows, whit help aovs what --aov does; --json prints all this for machines.",
      0, 0);
}

std::string limits_text(const Range& r) {
  constexpr double most = std::numeric_limits<float>::max();
  return r.min <= -most && r.max >= most ? std::string() : range_text(r);
}

void print_help(const PluginInfo& p) {
  std::string aliases;
  for (const std::string& a : p.aliases) aliases.append(fmt::format(", also \"{}\"", a));
  fmt::print("{} \"{}\"{}: ", p.category, strong(p.name), aliases);
  print_words(p.doc, p.category.size() + p.name.size() + aliases.size() + 5, 4);
  bool colours = false;
  for (const ParamSpec& spec : p.params) {
    print_param(spec);
    colours |= std::any_of(spec.accepts.begin(), spec.accepts.end(), is_other_colour);
  }
  if (colours) fmt::print("  (\"rgb\" may also be \"xyz\", \"blackbody\" or \"spectrum\")\n");
}

void print_help(const StatementRow& s) {
  const char* const space = s.arguments.usage.empty() ? "" : " ";
  fmt::print("{}{}{}\n", strong(s.name), space, s.arguments.usage);
  print_indented(s.doc, 4);
  for (const char* category : categories_of(s.name)) {
    fmt::print("    {}: ", category);
    print_words(fmt::format("{}", fmt::join(plugin_names(category), " ")), std::string_view(category).size() + 6, 6);
  }
}

void print_help(Effect e) {
  const EffectInfo& info = effect_info(e);
  fmt::print("{}{:{}} ", strong(info.name), "", 18 - std::min<size_t>(18, std::string_view(info.name).size()));
  print_words(fmt::format("{}; without: {}", info.doc, info.off), 19, 19);
}

void print_help_of_finding(std::string_view name, std::string_view what) {
  fmt::print("{}\n", strong(name));
  print_indented(what, 4);
}

std::string channels_text(const AovRow& row) {
  std::string text = row.by_light_group ? "lightgroup.NAME" : "";
  for (const std::string& channel : row.channels) {
    const size_t dot = text.empty() ? 0 : channel.find('.');
    text.append(text.empty() ? "" : " ").append(channel.substr(dot == std::string::npos ? 0 : dot));
  }
  return text;
}

void print_help(const AovRow& row) {
  fmt::print("{}{:{}} {}\n", strong(row.name), "", 12 - std::min<size_t>(12, std::string_view(row.name).size()),
             channels_text(row));
  print_indented(row.doc, 4);
}

}  // namespace whit
