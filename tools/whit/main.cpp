// The command `whit`: dispatch, and nothing else. Start at render_command.cpp.

#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <new>

#include "core/base/diagnostics.h"
#include "tools/whit/commands.h"
#include "tools/whit/terminal.h"
#include "tools/whit/version.h"

namespace whit {

const std::vector<Command>& commands() {
  static const std::vector<Command> table = {
      {"render", render_command, "[render] SCENE... [flags]",
       "render scenes and glTF models (the word may be left out)"},
      {"check", check_command, "check SCENE...", "report every problem of a scene without rendering"},
      {"fmt", fmt_command, "fmt SCENE [--in-place]", "write a scene file in normal form"},
      {"explain", explain_command, "explain SCENE [--json]", "show the effect plan: what is simulated, and why"},
      {"cost", cost_command, "cost SCENE [--time 60s] [--html F]", "show what accuracy costs in time"},
      {"import", import_command, "import MODEL [-o SCENE.pbrt]", "write a glTF model as a scene to edit"},
      {"diff", diff_command, "diff A B [--noise] [--html F]", "say whether two pictures or folders of them differ"},
      {"bench", bench_command, "bench [SCENES...] [--json]", "measure rendering speed"},
      {"help", help_command, "help [CATEGORY [PLUGIN] | --json]", "list plugins and their parameters"},
  };
  return table;
}

namespace {

/// The command that a first word which is no file was probably meant to be, or "".
std::string misspelt_command(const Arguments& args) {
  if (args.empty() || args[0].empty() || args[0][0] == '-' || std::filesystem::exists(args[0])) return {};
  std::vector<std::string> names;
  for (const Command& c : commands()) names.push_back(c.name);
  return nearest_name(args[0], names);
}

int dispatch(const Arguments& args) {
  if (!args.empty()) {
    for (const Command& c : commands()) {
      if (args[0] == c.name) return c.run({args.begin() + 1, args.end()});
    }
    if (args[0] == "--help" || args[0] == "-h") return help_command({});
    if (args[0] == "--version") {
      fmt::print("whit {}\n", version());
      return kDone;
    }
  }
  if (std::string meant = misspelt_command(args); !meant.empty()) {
    say(fmt::format("whit: there is no command and no file \"{}\"; did you mean `whit {}`?", args[0], meant));
    return kUsage;
  }
  return render_command(args);
}

}  // namespace
}  // namespace whit

int main(int argc, char** argv) {
  try {
    return whit::dispatch({argv + 1, argv + argc});
  } catch (const std::bad_alloc&) {
    whit::say("whit: out of memory");
    return whit::kLimit;
  } catch (const std::exception& e) {
    whit::say(fmt::format("whit: {}", e.what()));
    return whit::kFileError;
  }
}
