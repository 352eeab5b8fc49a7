// A .gltf or .glb file as JSON and, of the latter, the buffer inside of it.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "core/base/mapped_file.h"
#include "core/gltf/check.h"

namespace whit::gltf {

struct Document {
  Json json;
  std::shared_ptr<const MappedFile> file;
  std::span<const uint8_t> chunk;  ///< The buffer inside of a .glb file.
  bool has_chunk = false;
};

/// Reads the file; its first bytes say which of the two it is. False when there was an error.
bool read_document(const std::string& path, Problems& problems, Document& out);

}  // namespace whit::gltf
