// CLI11 with this program's manners: exit code 2, one line, and a did-you-mean for misspelt flags.

#include "tools/whit/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "core/base/diagnostics.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

std::vector<std::string> flag_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// The first argument that looks like a flag and is none.
std::string unknown_flag(const CLI::App& app, const Arguments& args) {
  const std::vector<std::string> known = flag_names(app);
  for (const std::string& a : args) {
    const std::string name = a.substr(0, a.find('='));
    if (name.size() > 2 && name.compare(0, 2, "--") == 0 &&
        std::find(known.begin(), known.end(), name) == known.end()) {
      return name;
    }
  }
  return {};
}

/// A row of the table as CLI11 has it: bare words without a value are its flags, all others its options.
CLI::Option* add(CLI::App& app, const Flag& flag) {
  return std::visit(
      [&](auto* target) {
        if constexpr (std::is_same_v<decltype(target), bool*>) return app.add_flag(flag.names, *target, flag.help);
        else return app.add_option(flag.names, *target, flag.help);
      },
      flag.target);
}

// A range takes NaN for neither too small nor too large.
const CLI::Validator kIsNumber(
    [](std::string& text) {
      double value = 0;
      return CLI::detail::lexical_cast(text, value) && std::isnan(value) ? text + " is not a number" : std::string();
    },
    "");

void apply(CLI::App& app, CLI::Option& option, const Flag& flag) {
  const FlagRules& rules = flag.rules;
  if (rules.least < rules.most) {
    // The type of the limits is the one that messages and help name.
    if (std::holds_alternative<int*>(flag.target) || std::holds_alternative<std::optional<int>*>(flag.target))
      option.check(CLI::Range(static_cast<int>(rules.least), static_cast<int>(rules.most)));
    else option.check(CLI::Range(rules.least, rules.most))->check(kIsNumber);
  }
  if (!rules.choices.empty()) option.check(CLI::IsMember(rules.choices));
  if (rules.count > 0) option.expected(rules.count)->allow_extra_args(false);
  if (rules.repeats) option.allow_extra_args(false);
  if (rules.excludes) option.excludes(app.get_option(rules.excludes));
  if (rules.delimiter) option.delimiter(rules.delimiter);
  option.required(rules.required);
}

/// Where parse_arguments() puts what it is given instead of reading arguments; null but within describe().
CommandDescription* wanted_description = nullptr;

std::vector<std::string> split(std::string_view names) {
  std::vector<std::string> out;
  for (size_t at = 0; at <= names.size();) {
    const size_t end = std::min(names.find(',', at), names.size());
    out.emplace_back(names.substr(at, end - at));
    at = end + 1;
  }
  return out;
}

/// What a value is called where nothing says it is a file or one of a few words.
const char* value_name(const FlagTarget& target) {
  struct {
    const char* operator()(const bool*) const { return ""; }
    const char* operator()(const int*) const { return "INT"; }
    const char* operator()(const uint32_t*) const { return "INT"; }
    const char* operator()(const double*) const { return "NUMBER"; }
    const char* operator()(const std::optional<int>*) const { return "INT"; }
    const char* operator()(const std::optional<double>*) const { return "NUMBER"; }
    const char* operator()(const std::vector<int>*) const { return "INT"; }
    const char* operator()(const std::vector<double>*) const { return "NUMBER"; }
    const char* operator()(const std::string*) const { return "TEXT"; }
    const char* operator()(const std::optional<std::string>*) const { return "TEXT"; }
    const char* operator()(const std::vector<std::string>*) const { return "TEXT"; }
  } name;
  return std::visit(name, target);
}

FlagDescription describe(const Flag& flag) {
  constexpr const char* kScenes = "pbrt gltf glb";
  const FlagRules& rules = flag.rules;
  FlagDescription out;
  out.names = split(flag.names);
  const bool bare = out.names.front()[0] != '-';
  out.value = value_name(flag.target);
  if (rules.files) out.files = rules.files;
  else if (bare && rules.choices.empty() && !rules.offers) out.files = kScenes;
  if (out.files) out.value = *out.files == "/" ? "FOLDER" : "FILE";
  out.words = rules.offers ? rules.offers() : rules.choices;
  if (!out.words.empty()) out.value = "NAME";
  if (bare) out.value = out.names.front(), out.names.clear();
  out.help = flag.help;
  out.count = std::max(1, rules.count);
  out.list = rules.delimiter != 0 || rules.commas;
  out.repeats = rules.repeats || (bare && std::holds_alternative<std::vector<std::string>*>(flag.target));
  return out;
}

}  // namespace

CommandDescription describe(const Command& command) {
  CommandDescription out;
  out.name = command.name;
  wanted_description = &out;
  command.run({});
  wanted_description = nullptr;
  return out;
}

bool parse_arguments(const CommandLine& command, const Arguments& args, int& code) {
  if (wanted_description) {
    wanted_description->about = command.about;
    for (const Flag& flag : command.flags) wanted_description->flags.push_back(describe(flag));
    code = kDone;
    return false;
  }
  CLI::App app(command.about, command.program);
  for (const Flag& flag : command.flags) apply(app, *add(app, flag), flag);
  try {
    std::vector<std::string> reversed(args.rbegin(), args.rend());
    app.parse(reversed);
    return true;
  } catch (const CLI::CallForHelp& help) {
    fmt::print("{}", app.help());
    code = kDone;
  } catch (const CLI::ParseError& e) {
    const std::string flag = unknown_flag(app, args);
    if (!flag.empty()) {
      const std::string near = nearest_name(flag, flag_names(app));
      say(fmt::format("{}: unknown flag {}{}", app.get_name(), flag,
                      near.empty() ? "" : fmt::format("; did you mean {}?", near)));
    } else {
      say(fmt::format("{}: {}", app.get_name(), e.what()));
    }
    say(fmt::format("`{} --help` lists the flags", app.get_name()));
    code = kUsage;
  }
  return false;
}

}  // namespace whit
