#include "core/session/files.h"

#include <algorithm>
#include <filesystem>

#include "core/gltf/model_files.h"
#include "core/session/output.h"

namespace whit {

std::vector<std::string> texts_of(const ParsedFile& file) {
  std::vector<std::string> files;
  for (uint32_t i = 0; i < file.sources->size(); ++i) {
    const std::string& name = file.sources->name(i);
    std::error_code failed;
    if (!std::filesystem::is_regular_file(name, failed)) continue;
    if (std::find(files.begin(), files.end(), name) == files.end()) files.push_back(name);
  }
  return files;
}

std::vector<std::string> assets_of(const ParsedFile& file) {
  std::vector<std::string> files;
  const auto add = [&](const std::vector<std::string>& more) { files.insert(files.end(), more.begin(), more.end()); };
  for (const std::string& model : file.models) {
    files.push_back(model);
    add(files_of_model(model));
  }
  for (const SceneDescription& world : file.worlds) {
    add(files_read(world));
    for (const UnreadFile& unread : world.unread_files) files.push_back(unread.path);
  }
  // There may be a hundred thousand.
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

}  // namespace whit
