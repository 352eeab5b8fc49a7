// The command `whit`: dispatch, and nothing else. Start at render_command.cpp.

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <system_error>

#include "core/base/diagnostics.h"
#include "tools/whit/commands.h"
#include "tools/whit/instruction_sets.h"
#include "tools/whit/terminal.h"
#include "tools/whit/version.h"

namespace whit {

const std::vector<Command>& commands() {
  static const std::vector<Command> table = {
      {"render", render_command, "[render] SCENE... [flags]",
       "render scenes and glTF models (the word may be left out)"},
      {"check", check_command, "check SCENE... [--fix] [--json]", "report every problem of a scene without rendering"},
      {"fmt", fmt_command, "fmt SCENE... [--in-place | --check]", "write scene files in normal form"},
      {"watch", watch_command, "watch SCENE [--open] [--terminal]", "show a scene in the browser while it is written"},
      {"lsp", lsp_command, "lsp", "serve an editor: the language server for scene files, on standard input and output"},
      {"explain", explain_command, "explain SCENE [--json]", "show the effect plan: what is simulated, and why"},
      {"cost", cost_command, "cost SCENE [--time 60s] [--html F]", "show what accuracy costs in time"},
      {"import", import_command, "import MODEL [-o SCENE.pbrt]", "write a glTF model as a scene to edit"},
      {"merge", merge_command, "merge PARTS... [-o PICTURE]",
       "join parts of a picture that were rendered by themselves"},
      {"diff", diff_command, "diff A B [--noise] [--html F]", "say whether two pictures or folders of them differ"},
      {"bench", bench_command, "bench [SCENES...] [--json]", "measure rendering speed"},
      {"help", help_command, "help [[KIND] NAME | --json]", "explain a command, plugin, statement, effect or AOV"},
  };
  return table;
}

namespace {

/// The name of a command that is there, or was probably meant; "" when nothing is near.
std::string nearest_command(const std::string& word) {
  std::vector<std::string> names{"version"};
  for (const Command& c : commands()) names.push_back(c.name);
  return nearest_name(word, names);
}

/// A first word that is neither a command nor a file can have been meant as either: says so, and returns the exit code;
/// kDone where it can only be a file, by its path or its ending.
int misspelt_command(const std::string& word) {
  std::error_code ignored;
  if (word.empty() || word[0] == '-' || word.find('/') != std::string::npos) return kDone;
  if (std::filesystem::exists(word, ignored)) return kDone;
  const std::string meant = nearest_command(word);
  if (!meant.empty()) {
    say(fmt::format("whit: there is no command \"{}\", and no file of that name to render; did you mean `whit {}`?",
                    word, meant));
    return kUsage;
  }
  if (word.find('.') != std::string::npos) return kDone;
  say(fmt::format(
      "whit: cannot open \"{}\": no such file, and there is no command of that name (`whit help` lists them)", word));
  return kFileError;
}

int print_version() {
  fmt::print("whit {}, {}\n", version(), compiled_for());
  return kDone;
}

int dispatch(const Arguments& args) {
  if (args.empty()) return render_command(args);
  for (const Command& c : commands()) {
    if (args[0] == c.name) return c.run({args.begin() + 1, args.end()});
  }
  if (args[0] == "--help" || args[0] == "-h") return help_command({});
  std::error_code ignored;
  if (args[0] == "--version" || args[0] == "-V") return print_version();
  if (args[0] == "version" && !std::filesystem::exists(args[0], ignored)) return print_version();
  const int code = misspelt_command(args[0]);
  return code == kDone ? render_command(args) : code;
}

/// What was printed may still be on its way: a full disk shows only now.
int finish(int code) {
  const bool printed = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (printed && std::cout.flush()) return code;
  if (code == kFileError) return code;  // It has been said.
  say("whit: cannot write to standard output");
  return std::max<int>(code, kFileError);
}

}  // namespace
}  // namespace whit

int main(int argc, char** argv) {
  // A file that grows beyond its limit is an error of writing, with a message, and no reason to die.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return whit::finish(whit::dispatch({argv + 1, argv + argc}));
  } catch (const std::bad_alloc&) {
    whit::say("whit: out of memory");
    return whit::kLimit;
  } catch (const std::exception& e) {
    whit::say(fmt::format("whit: {}", e.what()));
    return whit::kFileError;
  }
}
