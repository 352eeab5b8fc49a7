// From tinygltf's data to ours, part by part. The document has been checked: all references are right.
#pragma once

#include "core/gltf/buffers.h"
#include "core/gltf/model.h"
#include "core/gltf/tiny.h"

namespace whit::gltf {

void convert_scenes(const tinygltf::Model& from, Model& to);  ///< And nodes, skins, animations, cameras and lights.
void convert_meshes(const tinygltf::Model& from, Model& to);
void convert_materials(const tinygltf::Model& from, Model& to);  ///< And textures.

/// Pictures, which tinygltf is not shown. Reports those that lie outside of the folder.
void read_images(const Item& root, const LoadOptions& options, const Buffers& buffers, Model& to);

}  // namespace whit::gltf
