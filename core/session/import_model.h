// A model as a scene file to edit, with its meshes and pictures in files.
#pragma once

#include <string>
#include <vector>

#include "core/gltf/describe.h"

namespace whit {

struct ImportRequest {
  std::string model, scene;  ///< The files: .gltf or .glb, and .pbrt.
  gltf::Selection selection;
  bool allow_outside = false;
  bool overwrite = false;  ///< Else a file that is there and holds something else is an error, and nothing is written.
};

struct ImportResult {
  std::vector<std::string> written;  ///< All files, the scene last.
  std::vector<std::string> notes;
  Diagnostics said;
};

/// Writes the scene that shows a model as rendering its file does, to the bit. Meshes and pictures go to a folder beside
/// the scene that is called like it; pictures are copied as they are. After an error nothing new is left; what `overwrite` has replaced by then stays so.
ImportResult import_model(const ImportRequest& request);

}  // namespace whit
