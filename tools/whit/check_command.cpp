// `whit check`: every problem that a render would meet on its way to the first ray, and in the pictures it would read.

#include "core/session/output.h"
#include "tools/whit/command_line.h"
#include "tools/whit/load.h"
#include "tools/whit/model_flags.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

/// What only building a scene finds: files that cannot be read, geometry that is not what it should be.
Diagnostics problems_of_building(PlannedWorld planned, const std::string& path) {
  Diagnostics found;
  if (planned.bound.film.plugin) {
    OutputRequest request;
    request.scene_path = path;
    found.append(plan_output(request, planned.bound.film).said);
  }
  BuildOptions options;
  options.keep_going = options.only_check = true;
  const BuiltWorld built = build_world(std::move(planned), options);
  found.append(built.said);
  built.textures->read_all();
  found.append(built.textures->errors());
  return found;
}

}  // namespace

int check_command(const Arguments& args) {
  std::vector<std::string> scenes;
  ModelFlags model;
  CommandLine command{"whit check",
                      "Reports every problem of a scene without rendering; what a render warns of and goes past as "
                      "pbrt-v3 does is an error here. Exit code 1 when there is any.",
                      {{"scenes", &scenes, "Scene files or glTF models; standard input without any"}}};
  add_model_flags(command, model);
  int code = kDone;
  if (!parse_arguments(command, args, code)) return code;
  if (scenes.empty()) scenes.push_back("-");
  for (const std::string& path : scenes) {
    if (const std::string problem = usage_problem(model, path); !problem.empty()) {
      say("whit check: " + problem);
      return kUsage;
    }
  }
  ReadOptions options = read_options(model);
  options.read_unplaced = true;
  for (const std::string& path : scenes) {
    const ParsedFile file = read_scene(path, options);
    const Diagnostics all =
        all_problems(file, [&](PlannedWorld planned) { return problems_of_building(std::move(planned), path); });
    print_diagnostics(*file.sources, unexcused(all));
    if (!all.all().empty()) code = kNo;
  }
  return code;
}

}  // namespace whit
