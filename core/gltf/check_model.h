// The parts of a document beside buffers: scenes, meshes, materials and what they refer to.
#pragma once

#include "core/gltf/buffers.h"

namespace whit::gltf {

/// Whether the file is glTF 2; if not there is no use in looking further.
bool check_version(const Item& root);

/// Checks everything of the document that is not read by read_data() and read_images().
void check_model(const Item& root, const Buffers& buffers);

}  // namespace whit::gltf
