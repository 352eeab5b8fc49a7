#include "tools/whit/check_files.h"

#include <algorithm>
#include <iostream>
#include <vector>

#include "core/session/files.h"
#include "core/session/output.h"
#include "tools/whit/json.h"
#include "tools/whit/load.h"
#include "tools/whit/terminal.h"

namespace whit {
namespace {

void add_once(std::vector<std::string>& files, const std::string& file) {
  if (!file.empty() && std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
}

std::vector<std::string> files_to_read(const std::string& scene, const ParsedFile& file) {
  std::vector<std::string> files;
  if (scene != "-") files.push_back(scene);
  for (const std::string& text : texts_of(file)) add_once(files, text);
  std::vector<std::string> more = assets_of(file);
  std::erase_if(more,
                [&](const std::string& name) { return std::find(files.begin(), files.end(), name) != files.end(); });
  files.insert(files.end(), more.begin(), more.end());
  return files;
}

std::vector<std::string> files_to_write(const std::string& scene, const ParsedFile& file) {
  std::vector<std::string> files;
  for (const SceneDescription& world : file.worlds) {
    const PlannedWorld planned = plan_world(world, *file.sources);
    if (!planned.bound.film.plugin) continue;
    OutputRequest request;
    request.scene_path = scene;
    const OutputPlan output = plan_output(request, planned.bound.film);
    add_once(files, output.main_file);
    add_once(files, output.display_file);
  }
  return files;
}

}  // namespace

int list_files(const std::string& scene, const ReadOptions& options, bool json) {
  const ParsedFile file = read_scene(scene, options);
  print_diagnostics(*file.sources, file.said, true);
  const std::vector<std::string> read = files_to_read(scene, file), write = files_to_write(scene, file);
  if (json) {
    std::cout << to_text(Json(Json::Object{{"read", read}, {"write", write}})) << '\n';
  } else {
    for (const std::string& name : read) std::cout << "read " << printable(name) << '\n';
    for (const std::string& name : write) std::cout << "write " << printable(name) << '\n';
  }
  return exit_code(file.said);
}

}  // namespace whit
