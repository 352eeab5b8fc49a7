// Flags as data. Only command_line.cpp knows the library that reads them, which takes long to compile.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tools/whit/commands.h"

namespace whit {

/// Where a flag's value goes. A bool is a flag without a value; a vector takes several, and all that a positional
/// argument gets.
using FlagTarget =
    std::variant<bool*, int*, uint32_t*, double*, std::optional<int>*, std::optional<double>*, std::string*,
                 std::optional<std::string>*, std::vector<std::string>*, std::vector<int>*, std::vector<double>*>;

/// What a flag's value must be.
struct FlagRules {
  double least = 0, most = 0;             ///< A number within these, when they differ.
  std::vector<std::string> choices = {};  ///< One of these, when there are any.
  int count = 0;                          ///< That many values, when it is not 0.
  bool repeats = false;                   ///< One value, as often as wanted.
  char delimiter = 0;                     ///< Between values in one word, when it is not 0.
  const char* excludes = nullptr;         ///< The flag beside which this one makes no sense.
  bool required = false;
  /// Words that completion offers, when there are any: some of all that are accepted.
  std::vector<std::string> (*offers)() = nullptr;
  /// It is a file's name, of one of these endings: "exr png"; "" for any file, "/" for folders. What comes without a
  /// flag is a scene unless it says otherwise.
  const char* files = nullptr;
  bool commas = false;  ///< It is a list of words with commas between, which the command takes apart itself.
};

/// A row of a command's table: "--name", "--name,-n", or a bare name for what comes without a flag.
struct Flag {
  const char* names;
  FlagTarget target;
  const char* help;
  FlagRules rules = {};
};

struct CommandLine {
  const char* program;  ///< As people type it: "whit fmt".
  const char* about;
  std::vector<Flag> flags;
};

/// Reads the arguments into the flags' targets. Returns true when the command should go on; otherwise `code` is what
/// to exit with (0 after --help, 2 after a mistake, which has been printed).
bool parse_arguments(const CommandLine& command, const Arguments& args, int& code);

/// A flag as data that stays when its command has gone.
struct FlagDescription {
  std::vector<std::string> names;  ///< "--outfile", "-o"; none of what comes without a flag.
  std::string value;               ///< What the value is called: "FILE", "FLOAT"; "" of a flag without one.
  std::string help;
  std::vector<std::string> words;      ///< What the value may be, or what is offered for it.
  std::optional<std::string> files;    ///< See FlagRules.
  int count = 1;                       ///< So many values.
  bool repeats = false, list = false;  ///< Several, as often as wanted or with commas between.
};

struct CommandDescription {
  std::string name;  ///< "fmt".
  std::string about;
  std::vector<FlagDescription> flags;
};

/// A command's flags, for completion and the manual: it is run, and stops where it would read its arguments.
CommandDescription describe(const Command& command);

}  // namespace whit
