// `whit fmt`: a scene file in normal form, on stdout or in place.

#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <iterator>
#include <sstream>
#include <vector>

#include "parser/format.h"
#include "tools/whit/command_line.h"
#include "tools/whit/replace_file.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

/// What was written for a scene that did not come about is of no use.
int give_up(const std::vector<std::string>& written, int code) {
  std::error_code ignored;
  for (const std::string& path : written) std::filesystem::remove(path, ignored);
  return code;
}

}  // namespace

int fmt_command(const Arguments& args) {
  std::string path;
  bool in_place = false;
  FormatOptions options;
  const CommandLine command{"whit fmt",
                            "Writes a scene file in normal form.",
                            {{"scene", &path, "Scene file; standard input without"},
                             {"--in-place,-i", &in_place, "Replace the file instead of printing"},
                             {"--expand", &options.expand_includes, "Put included files in place of their Include"},
                             {"--toply", &options.to_ply, "Write large inline meshes to PLY files"}}};
  int code = kDone;
  if (!parse_arguments(command, args, code)) return code;
  const bool standard_input = path.empty() || path == "-";
  if (in_place && standard_input) {
    say("whit fmt: --in-place needs a file");
    return kUsage;
  }
  Sources sources;
  std::ostringstream text;
  Diagnostics d;
  std::vector<std::string> written;
  options.written = &written;
  // Beside the scene, from whose folder the names in it start.
  if (!standard_input) options.ply_folder = std::filesystem::path(path).parent_path().string();
  if (standard_input) {
    d = format_text(sources, "<stdin>", std::string{std::istreambuf_iterator<char>(std::cin), {}}, "", text, options);
  } else {
    d = format_file(sources, path, text, options);
  }
  print_diagnostics(sources, d);
  if (d.has_errors()) return give_up(written, exit_code(d));
  std::string problem;
  if (in_place) {
    problem = replace_file(path, text.str());
    if (!problem.empty()) problem = fmt::format("cannot replace {}: {}", path, problem);
  } else if (!(std::cout << text.str() << std::flush)) {
    problem = "cannot write to standard output";
  }
  if (problem.empty()) return kDone;
  say("whit fmt: " + problem);
  return give_up(written, kFileError);
}

}  // namespace whit
