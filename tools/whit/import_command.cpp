// `whit import`: a model as a scene file to edit.

#include <fmt/format.h>

#include <filesystem>

#include "core/session/import_model.h"
#include "core/session/models.h"
#include "tools/whit/model_flags.h"
#include "tools/whit/sandbox.h"
#include "tools/whit/terminal.h"

namespace whit {

int import_command(const Arguments& args) {
  ImportRequest request;
  ModelFlags flags;
  bool quiet = false;
  CommandLine command{
      "whit import",
      "Writes a glTF model as a .pbrt scene, with its meshes (PLY) and pictures in a folder beside it.",
      {{"model", &request.model, "The model: .gltf or .glb", {.required = true, .files = "gltf glb"}},
       {"--outfile,-o", &request.scene, "The scene file (default: the model's name with .pbrt)", {.files = "pbrt"}},
       {"--force", &request.overwrite, "Replace files that are there already"},
       {"--quiet", &quiet, "Problems only"}}};
  add_model_flags(command, flags);
  SandboxFlags sandbox;
  add_sandbox_flags(command, sandbox);
  int code = kDone;
  if (!parse_arguments(command, args, code)) return code;
  for (const std::string& problem : {usage_problem(flags), usage_problem(sandbox)}) {
    if (problem.empty()) continue;
    say("whit import: " + problem);
    return kUsage;
  }
  if (request.scene.empty()) request.scene = std::filesystem::path(request.model).replace_extension(".pbrt").string();
  if (std::filesystem::path(request.scene).extension() != ".pbrt") {
    say(fmt::format("whit import: \"{}\" does not end in .pbrt", request.scene));
    return kUsage;
  }
  const std::filesystem::path folder = std::filesystem::path(request.scene).parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder)) {
    say(fmt::format("whit import: there is no folder \"{}\"", folder.string()));
    return kFileError;
  }
  const SandboxRequest files{{folder_to_read(request.model)}, {request.scene}};
  if (const std::string problem = enter_sandbox(sandbox, files); !problem.empty()) {
    say("whit import: " + problem);
    return kFileError;
  }
  request.selection = selection_of(flags), request.allow_outside = flags.allow_outside;
  const ImportResult result = import_model(request);
  print_diagnostics(Sources(), result.said);
  explain_sandbox(sandbox, exit_code(result.said));
  if (result.said.has_errors()) return exit_code(result.said);
  if (quiet) return kDone;
  for (const std::string& note : result.notes) say("whit: " + note);
  say(fmt::format("whit: {} written, with {} files beside it", request.scene, result.written.size() - 1));
  return kDone;
}

}  // namespace whit
