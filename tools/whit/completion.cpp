#include "tools/whit/completion.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "tools/whit/command_line.h"

namespace whit {
namespace {

using Descriptions = std::vector<CommandDescription>;

Descriptions describe_commands() {
  Descriptions all;
  for (const Command& command : commands()) all.push_back(describe(command));
  return all;
}

std::string command_names() {
  std::vector<std::string> names;
  for (const Command& c : commands()) names.emplace_back(c.name);
  return fmt::format("{}", fmt::join(names, " "));
}

std::string replaced(std::string_view text, std::string_view what, std::string_view by) {
  std::string out;
  size_t from = 0;
  for (size_t at; (at = text.find(what, from)) != std::string_view::npos; from = at + what.size())
    out.append(text.substr(from, at - from)).append(by);
  return out.append(text.substr(from));
}

/// The first sentence or clause of a help text, which has to fit beside a flag.
std::string brief(std::string text) {
  text = text.substr(0, text.find('\n'));
  return text.substr(0, std::min(text.find("; "), text.find(". ")));
}

// ---- bash ----

constexpr std::string_view kBash = R"sh(# Completion of whit for bash, made by `whit help --completion bash`.

# Offers those of the words in $1 that begin as the current one does.
_whit_words() {
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$cur")
}

# The same behind the last comma of a list.
_whit_list() {
  local before=
  [[ $cur == *,* ]] && before=${cur%,*},
  mapfile -t COMPREPLY < <(compgen -P "$before" -W "$1" -- "${cur##*,}")
  compopt -o nospace 2>/dev/null
}

# Offers folders, and files with one of the endings given; all files when none is.
_whit_files() {
  local ending
  compopt -o filenames 2>/dev/null
  if [[ $# -eq 0 ]]; then
    mapfile -t COMPREPLY < <(compgen -f -- "$cur")
    return
  fi
  mapfile -t COMPREPLY < <(compgen -d -- "$cur")
  for ending; do
    mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -X "!*.$ending" -- "$cur")
  done
}

_whit() {
  local cur=${COMP_WORDS[COMP_CWORD]} flag=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]} flags=
  COMPREPLY=()
  # Of --flag=value bash makes three words.
  if [[ $cur == = ]]; then
    cur=
  elif [[ $flag == = && $COMP_CWORD -gt 2 ]]; then
    flag=${COMP_WORDS[COMP_CWORD - 2]}
  fi
)sh";

/// What bash does for a value, or "" where it has nothing to offer.
std::string bash_action(const FlagDescription& flag) {
  if (!flag.words.empty())
    return fmt::format("_whit_{} '{}'", flag.list ? "list" : "words", fmt::join(flag.words, " "));
  if (!flag.files) return "";
  // No file ends in "/", so folders remain.
  return *flag.files == "/" ? "_whit_files /" : fmt::format("_whit_files {}", *flag.files);
}

std::string bash_values(const Descriptions& all) {
  std::string text = "  case \"$command $flag\" in\n";
  for (const CommandDescription& command : all) {
    for (const FlagDescription& flag : command.flags) {
      if (flag.names.empty() || flag.value.empty()) continue;
      std::vector<std::string> patterns;
      for (const std::string& name : flag.names) patterns.push_back(fmt::format("'{} {}'", command.name, name));
      const std::string action = bash_action(flag);
      text.append(
          fmt::format("    {}) {}{}return ;;\n", fmt::join(patterns, " | "), action, action.empty() ? "" : "; "));
    }
  }
  return text.append("  esac\n");
}

/// The flags of each command, and what its arguments without a flag are.
std::string bash_arguments(const Descriptions& all) {
  std::string text = "  case $command in\n";
  for (const CommandDescription& command : all) {
    std::vector<std::string> names{"--help"};
    std::string action;
    for (const FlagDescription& flag : command.flags) {
      names.insert(names.end(), flag.names.begin(), flag.names.end());
      if (flag.names.empty() && action.empty()) action = bash_action(flag);
    }
    text.append(fmt::format("    {})\n      flags='{}'\n      [[ $cur == -* ]] || {}\n      ;;\n", command.name,
                            fmt::join(names, " "), action.empty() ? ":" : action));
  }
  return text.append("  esac\n");
}

std::string bash_script() {
  const Descriptions all = describe_commands();
  std::string text(kBash);
  const std::string names = command_names();
  text.append(
      fmt::format("  case $command in\n    {}) [[ $COMP_CWORD -gt 1 ]] || command=render ;;\n"
                  "    *) command=render ;;\n  esac\n",
                  replaced(names, " ", " | ")));
  text.append(bash_values(all)).append(bash_arguments(all));
  text.append("  if [[ $cur == -* ]]; then\n    _whit_words \"$flags\"\n  elif [[ $COMP_CWORD -eq 1 ]]; then\n");
  text.append(
      fmt::format("    mapfile -t -O ${{#COMPREPLY[@]}} COMPREPLY < <(compgen -W '{} version' -- \"$cur\")\n"
                  "  fi\n}}\ncomplete -F _whit whit\n",
                  names));
  return text;
}

// ---- zsh ----

std::string zsh_quoted(const std::string& text) { return fmt::format("'{}'", replaced(text, "'", "'\\''")); }

/// What zsh does for a value: message and action.
std::string zsh_action(const FlagDescription& flag) {
  const std::string words = fmt::format("{}", fmt::join(flag.words, " "));
  if (flag.list && !flag.words.empty()) return fmt::format(":{}:_values -s , {} {}", flag.value, flag.value, words);
  if (!flag.words.empty()) return fmt::format(":{}:({})", flag.value, words);
  if (!flag.files) return fmt::format(":{}: ", flag.value);
  if (*flag.files == "/") return fmt::format(":{}:_files -/", flag.value);
  if (flag.files->empty()) return fmt::format(":{}:_files", flag.value);
  return fmt::format(":{}:_files -g \"*.({})\"", flag.value, replaced(*flag.files, " ", "|"));
}

std::string zsh_specs(const FlagDescription& flag) {
  if (flag.names.empty())
    return fmt::format(" \\\n    {}", zsh_quoted(fmt::format("{}{}", flag.repeats ? "*" : "", zsh_action(flag))));
  const std::string help = replaced(replaced(brief(flag.help), "[", "\\["), "]", "\\]");
  std::string text;
  for (const std::string& name : flag.names) {
    const char* const joined = flag.value.empty() ? "" : name.starts_with("--") ? "=" : "+";
    std::string action;
    for (int i = 0; i < flag.count && !flag.value.empty(); ++i) action.append(zsh_action(flag));
    const std::string others = flag.repeats ? "*" : fmt::format("({})", fmt::join(flag.names, " "));
    text.append(
        fmt::format(" \\\n    {}", zsh_quoted(fmt::format("{}{}{}[{}]{}", others, name, joined, help, action))));
  }
  return text;
}

std::string zsh_script() {
  std::string text = "#compdef whit\n# Completion of whit for zsh, made by `whit help --completion zsh`.\n\n";
  for (const CommandDescription& command : describe_commands()) {
    text.append(
        fmt::format("_whit_{}() {{\n  _arguments '(- *)--help[Print what it does, and its flags]'", command.name));
    for (const FlagDescription& flag : command.flags) text.append(zsh_specs(flag));
    text.append("\n}\n\n");
  }
  text.append("_whit() {\n  local -a commands=(\n");
  for (const Command& c : commands())
    text.append(fmt::format("    {}\n", zsh_quoted(fmt::format("{}:{}", c.name, c.summary))));
  text.append(fmt::format(R"sh(    'version:print the version'
  )
  if (( CURRENT == 2 )) && [[ $words[2] != -* ]]; then
    _describe -t commands command commands
    _files -g "*.(pbrt|gltf|glb)"
    return
  fi
  case $words[2] in
    {})
      local command=$words[2]
      shift words
      (( CURRENT-- ))
      _whit_$command
      ;;
    *) _whit_render ;;
  esac
}}

# The first time it is loaded by its name, to complete; or else by a source command.
if [[ $funcstack[1] == _whit ]]; then
  _whit "$@"
else
  compdef _whit whit
fi
)sh",
                          replaced(command_names(), " ", " | ")));
  return text;
}

// ---- fish ----

std::string fish_quoted(std::string text) {
  return fmt::format("'{}'", replaced(replaced(std::move(text), "\\", "\\\\"), "'", "\\'"));
}

/// What fish does for a value.
std::string fish_action(const FlagDescription& flag) {
  const std::string words = fmt::format("{}", fmt::join(flag.words, " "));
  if (flag.list && !flag.words.empty())
    return fmt::format(" -x -a {}", fish_quoted(fmt::format("(__whit_list {})", words)));
  if (!flag.words.empty()) return fmt::format(" -x -a {}", fish_quoted(words));
  if (!flag.files) return " -x";
  return *flag.files == "/" ? " -x -a '(__fish_complete_directories)'" : " -r -F";
}

std::string fish_script() {
  std::string text = fmt::format(R"sh(# Completion of whit for fish, made by `whit help --completion fish`.

# Whether the command is $argv[1]; without a word that is one, it is render.
function __whit_is
    set -l words (commandline -opc)
    if not contains -- "$words[2]" {0}
        set words[2] render
    end
    test "$words[2]" = $argv[1]
end

# Words for the place behind the last comma of a list.
function __whit_list
    set -l before (commandline -ct | string replace -r '^--[^=]*=' '' | string match -r '^.*,')
    set -q before[1]; or set before ''
    printf '%s\n' $before$argv
end

function __whit_at_first_word
    test (count (commandline -opc)) -eq 1
end

)sh",
                                 command_names());
  for (const Command& c : commands())
    text.append(fmt::format("complete -c whit -n __whit_at_first_word -a {} -d {}\n", c.name, fish_quoted(c.summary)));
  text.append("complete -c whit -n __whit_at_first_word -a version -d 'print the version'\n");
  for (const CommandDescription& command : describe_commands()) {
    const std::string start = fmt::format("complete -c whit -n '__whit_is {}'", command.name);
    text.append(fmt::format("\n{} -l help -d 'Print what it does, and its flags'\n", start));
    for (const FlagDescription& flag : command.flags) {
      std::string names;
      for (const std::string& name : flag.names)
        names.append(name.starts_with("--") ? " -l " : " -s ").append(name.substr(name.find_first_not_of('-')));
      // Files are what fish offers anyway where no flag stands.
      if (flag.names.empty() && flag.words.empty()) continue;
      const std::string action =
          flag.names.empty()   ? fmt::format(" -f -a {}", fish_quoted(fmt::format("{}", fmt::join(flag.words, " "))))
          : flag.value.empty() ? ""
                               : fish_action(flag);
      text.append(fmt::format("{}{} -d {}{}\n", start, names, fish_quoted(brief(flag.help)), action));
    }
  }
  return text;
}

struct Shell {
  const char* name;
  std::string (*script)();
};
constexpr Shell kShells[] = {{"bash", bash_script}, {"zsh", zsh_script}, {"fish", fish_script}};

}  // namespace

std::vector<std::string> shells() {
  std::vector<std::string> names;
  for (const Shell& shell : kShells) names.emplace_back(shell.name);
  return names;
}

std::string completion_script(const std::string& shell) {
  for (const Shell& s : kShells)
    if (s.name == shell) return s.script();
  return {};
}

}  // namespace whit
