// `whit fmt`: scene files in normal form, on stdout or in place, or whether they are.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <utility>
#include <vector>

#include "core/image/replace_file.h"
#include "parser/editor_config.h"
#include "parser/format.h"
#include "tools/whit/command_line.h"
#include "tools/whit/load.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

struct FmtFlags {
  std::vector<std::string> paths;
  bool in_place = false, check = false;
  FormatOptions options;
};

/// What was written for a scene that did not come about is of no use.
void remove_all(const std::vector<std::string>& written) {
  std::error_code ignored;
  for (const std::string& path : written) std::filesystem::remove(path, ignored);
}

struct Formatted {
  int code = kDone;
  std::string before, text;
  std::vector<std::string> written;  ///< PLY files.
};

/// A file, or standard input where the path is "-", in normal form; or the code to exit with, after saying why.
Formatted format_one(const std::string& path, FormatOptions options) {
  Formatted out;
  options.written = &out.written;
  Sources sources;
  sources.copy_files();  // Messages quote the text that there was before it is replaced.
  std::ostringstream text;
  Diagnostics d;
  EditorConfig config;
  if (path == "-") {
    out.before = read_standard_input(d).value_or("");
    if (!d.has_errors()) d = format_text(sources, "<stdin>", out.before, "", text, options);
  } else {
    config = read_editor_config(path);
    options.indent = config.indent;
    // Beside the scene, from whose folder the names in it start.
    options.ply_folder = std::filesystem::path(path).parent_path().string();
    d = format_file(sources, path, text, options);
    // What is no scene may be of any size.
    if (sources.size() > 0 && !d.has_errors()) out.before = sources.text(0);
  }
  print_diagnostics(sources, d);
  if (d.has_errors()) {
    remove_all(out.written);
    out.code = exit_code(d);
    return out;
  }
  out.text = config.line_ends(text.str());
  return out;
}

/// Writes what came of a file where it is wanted. "" or why it could not be.
std::string put(const FmtFlags& flags, const std::string& path, const Formatted& formatted) {
  if (!flags.in_place) return std::cout << formatted.text << std::flush ? "" : "cannot write to standard output";
  const std::string problem = replace_file(path, formatted.text);
  return problem.empty() ? "" : fmt::format("cannot replace {}: {}", path, problem);
}

std::string flag_problem(const FmtFlags& flags) {
  const bool standard_input = std::find(flags.paths.begin(), flags.paths.end(), "-") != flags.paths.end();
  if (flags.in_place && standard_input) return "--in-place needs a file";
  if (flags.in_place && flags.check) return "--check changes nothing, --in-place does";
  if (flags.check && flags.options.to_ply) return "--check writes nothing, --toply does";
  if (flags.paths.size() > 1 && !flags.in_place && !flags.check)
    return "several files at once need --in-place or --check";
  return {};
}

}  // namespace

int fmt_command(const Arguments& args) {
  FmtFlags flags;
  const CommandLine command{
      "whit fmt",
      "Writes scene files in normal form, indented as .editorconfig files ask for.",
      {{"scenes", &flags.paths, "Scene files; standard input without any"},
       {"--in-place,-i", &flags.in_place, "Replace the files instead of printing"},
       {"--check", &flags.check,
        "Change nothing: name the files that are not in normal form; exit code 1 if there are any"},
       {"--expand", &flags.options.expand_includes, "Put included files in place of their Include"},
       {"--toply", &flags.options.to_ply, "Write large inline meshes to PLY files"}}};
  int code = kDone;
  if (!parse_arguments(command, args, code)) return code;
  if (flags.paths.empty()) flags.paths.push_back("-");
  for (std::string& path : flags.paths)
    if (path.empty()) path.assign(1, '-');
  if (const std::string problem = flag_problem(flags); !problem.empty()) {
    say("whit fmt: " + problem);
    return kUsage;
  }
  // A file with mistakes stays as it is, and the others are formatted all the same.
  for (const std::string& path : flags.paths) {
    const Formatted formatted = format_one(path, flags.options);
    if (formatted.code != kDone) {
      code = std::max(code, formatted.code);
    } else if (flags.check) {
      if (formatted.text == formatted.before) continue;
      fmt::print("{} is not in normal form\n", path == "-" ? "<stdin>" : path);
      code = std::max(code, kNo);
    } else if (const std::string problem = put(flags, path, formatted); !problem.empty()) {
      say("whit fmt: " + problem);
      remove_all(formatted.written);
      code = std::max(code, kFileError);
    }
  }
  return code;
}

}  // namespace whit
