#include "core/gltf/model.h"

#include <filesystem>

#include "core/gltf/check_data.h"
#include "core/gltf/check_model.h"
#include "core/gltf/model_parts.h"

namespace whit::gltf {

std::string Model::at(std::string_view place) const { return path + ": " + std::string(place); }

namespace {

/// The folder of a file, without links in its path.
std::string folder_of(const std::string& path) {
  std::error_code problem;
  const std::filesystem::path folder =
      std::filesystem::canonical(std::filesystem::absolute(path, problem).parent_path(), problem);
  return folder.string();
}

}  // namespace

std::shared_ptr<const Model> load_model(const std::string& path, const std::string& shown, const LoadOptions& options,
                                        SourcePos where, Diagnostics& diagnostics) {
  Problems problems(shown, where, diagnostics);
  Document document;
  if (!read_document(path, problems, document)) return nullptr;
  const Item root(document.json, problems);
  if (!check_version(root)) return nullptr;

  auto model = std::make_shared<Model>();
  model->path = shown;
  model->folder = folder_of(path);
  auto buffers = std::make_shared<Buffers>();
  read_data(root, document, model->folder, options, *buffers);
  read_images(root, options, *buffers, *model);
  check_model(root, *buffers);
  if (problems.any()) return nullptr;

  std::string problem;
  const auto typed = parse_typed(document.json, problem);
  if (!typed) {
    problems.error({}, problem);
    return nullptr;
  }
  convert_scenes(*typed, *model);
  convert_meshes(*typed, *model);
  convert_materials(*typed, *model);
  model->files = buffers->files;
  model->buffers = std::move(buffers);
  return model;
}

}  // namespace whit::gltf
