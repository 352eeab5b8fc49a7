// The checks of check_model(), part by part.
#pragma once

#include "core/gltf/check_model.h"

namespace whit::gltf {

/// How many there are of everything that an index may name.
struct Counts {
  Things accessors, views, nodes, meshes, skins, cameras, lights, materials, textures, images, samplers, scenes,
      variants;
};

/// What checks know.
struct CheckContext {
  const Item& root;
  const Buffers& buffers;
  Counts counts;
};

void check_extensions(const Item& root);
void check_meshes(const CheckContext& c);
void check_materials(const CheckContext& c);  ///< And textures and samplers.
void check_scenes(const CheckContext& c);     ///< And nodes, skins, cameras and lights.
void check_animations(const CheckContext& c);

/// Which numbers an accessor may have: its type, and which componentTypes, each also or only normalised.
struct Wanted {
  int rows = 1, columns = 1;
  struct Kind {
    Component component;
    bool normalized;
  };
  std::vector<Kind> kinds;
  const char* words = "";  ///< For messages: "VEC3 of FLOAT".
};
/// Whether the accessor that an item's member names is so; reports it.
bool check_accessor(const Item& item, const std::string& key, int accessor, const Wanted& wanted,
                    const Buffers& buffers);

}  // namespace whit::gltf
