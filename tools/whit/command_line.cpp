#include "tools/whit/command_line.h"

#include <fmt/format.h>

#include <algorithm>

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

}  // namespace

bool parse_arguments(CLI::App& app, const Arguments& args, int& code) {
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
