// `whit fmt`: a scene file in normal form, on stdout or in place.

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>

#include "parser/format.h"
#include "tools/whit/command_line.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

/// Replaces a file by new text through a temporary name, so that a failure leaves the old one.
int replace_file(const std::string& path, const std::string& text) {
  const std::string temporary = path + ".whit-fmt";
  {
    std::ofstream out(temporary, std::ios::binary);
    out << text;
    if (!out.flush()) {
      say(fmt::format("whit fmt: cannot write {}", temporary));
      std::filesystem::remove(temporary);
      return kFileError;
    }
  }
  std::error_code error;
  std::filesystem::rename(temporary, path, error);
  if (!error) return kDone;
  say(fmt::format("whit fmt: cannot replace {}: {}", path, error.message()));
  return kFileError;
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
  if (in_place && path.empty()) {
    say("whit fmt: --in-place needs a file");
    return kUsage;
  }
  Sources sources;
  std::ostringstream text;
  Diagnostics d;
  if (path.empty() || path == "-") {
    d = format_text(sources, "<stdin>", std::string{std::istreambuf_iterator<char>(std::cin), {}}, "", text, options);
  } else {
    d = format_file(sources, path, text, options);
  }
  print_diagnostics(sources, d);
  if (d.has_errors()) return exit_code(d);
  if (in_place) return replace_file(path, text.str());
  std::cout << text.str() << std::flush;
  return std::cout ? kDone : kFileError;
}

}  // namespace whit
