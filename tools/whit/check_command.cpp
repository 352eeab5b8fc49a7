// `whit check`: every problem a scene's text has, without reading its meshes and textures or rendering.

#include "tools/whit/command_line.h"
#include "tools/whit/load.h"
#include "tools/whit/terminal.h"

namespace whit {

int check_command(const Arguments& args) {
  std::vector<std::string> scenes;
  const CommandLine command{"whit check",
                            "Reports every problem of a scene without rendering. Exit code 1 when there is any.",
                            {{"scenes", &scenes, "Scene files; standard input without any"}}};
  int code = kDone;
  if (!parse_arguments(command, args, code)) return code;
  if (scenes.empty()) scenes.push_back("-");
  for (const std::string& path : scenes) {
    Sources sources;
    const ParseOptions everything{.read_unplaced = true};
    const Diagnostics all = all_problems(load_file(sources, path, everything), sources);
    print_diagnostics(sources, unexcused(all));
    if (!all.all().empty()) code = kNo;
  }
  return code;
}

}  // namespace whit
