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

/// Reads and checks it; null after errors. `files`: what it was read from, also then.
std::shared_ptr<const Model> read_model(const std::string& path, const LoadOptions& options, Problems& problems,
                                        Document& document, std::shared_ptr<Buffers>& files) {
  if (!read_document(path, problems, document)) return nullptr;
  const Item root(document.json, problems);
  if (!check_version(root)) return nullptr;

  auto model = std::make_shared<Model>();
  model->path = problems.shown();
  model->folder = folder_of(path);
  read_data(root, document, model->folder, options, *files);
  read_images(root, options, *files, *model);
  check_model(root, *files);
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
  model->files = files->files;
  model->buffers = files;
  return model;
}

}  // namespace

std::shared_ptr<const Model> load_model(const std::string& path, const std::string& shown, const LoadOptions& options,
                                        SourcePos where, Diagnostics& diagnostics) {
  Diagnostics found;
  Document document;
  auto buffers = std::make_shared<Buffers>();
  std::shared_ptr<const Model> model;
  {
    Problems problems(shown, where, found);
    model = read_model(path, options, problems, document, buffers);
  }
  const std::string own = document.file->error().empty() ? document.file->problem() : std::string();
  const std::string changed = own.empty() ? buffers->problem() : own;
  if (changed.empty()) {
    diagnostics.append(found);
    return model;
  }
  // Whatever was found in it says nothing.
  Problems problems(shown, where, diagnostics);
  problems.file_error({}, changed, "start again when it is complete");
  return nullptr;
}

}  // namespace whit::gltf
