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

}  // namespace whit
