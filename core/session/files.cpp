#include "core/session/files.h"

#include <fmt/format.h>

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

std::string place_in_scene(const Sources& sources, SourcePos where, const std::string& path) {
  const SourcePlace p = sources.place(where);
  const std::string at = fmt::format("{}:{}:{}", sources.name(where.file), p.line, p.column);
  const std::string folder = std::filesystem::path(path).parent_path().string() + "/";
  return folder.size() > 1 && at.starts_with(folder) ? at.substr(folder.size()) : at;
}

}  // namespace whit
