// The checks of check_model(), part by part.
#pragma once

#include <string>
#include <vector>

#include "core/gltf/check_model.h"

namespace whit::gltf {

/// How many there are of everything that an index may name.
struct Counts {
  Things accessors{"accessors"}, views{"bufferViews"}, nodes{"nodes"}, meshes{"meshes"}, skins{"skins"},
      cameras{"cameras"}, lights{"lights"}, materials{"materials"}, textures{"textures"}, images{"images"},
      samplers{"samplers"}, scenes{"scenes"}, variants{"variants"};
};

/// What checks know.
struct CheckContext {
  const Item& root;
  const Buffers& buffers;
  Counts counts;
  bool unaligned = false;            ///< Attributes that do not begin at multiples of four have been reported.
  bool quantized = false;            ///< KHR_mesh_quantization is used.
  std::vector<size_t> mesh_targets;  ///< How many morph targets the primitives of each mesh have.
  std::vector<int> node_mesh;        ///< The mesh of each node, or -1.
};

void check_extensions(const Item& root);
/// In this order.
void check_meshes(CheckContext& c);
void check_nodes(CheckContext& c);  ///< And scenes and skins.
void check_animations(const CheckContext& c);
void check_cameras(const CheckContext& c);  ///< And lights.
void check_materials(const CheckContext& c);
void check_textures(const CheckContext& c);

/// Numbers that an accessor may have.
struct Wanted {
  int rows = 1, columns = 1;
  struct Kind {
    Component component;
    bool normalized;
  };
  std::vector<Kind> kinds;
  std::vector<Kind> quantized_kinds;  ///< With KHR_mesh_quantization.
  const char* words = "";             ///< For messages: "a VEC3 of FLOAT".
};
const Wanted& floats_of(int rows, int columns = 1);
/// What a name of an attribute stands for, or null where anything may.
const Wanted* wanted_of(const std::string& attribute, bool morph_target);
const Wanted& wanted_of_indices();
/// Numbers that are written as floats or as normalised integers.
const Wanted& fractions_of(int rows);

/// The accessor that an item's member names, or -1 where it is not there or not as wanted, which is reported.
int check_accessor(const CheckContext& c, const Item& item, const char* key, const Wanted& wanted,
                   Item::Need need = Item::Need::Optional);
/// The same of a member itself.
int check_accessor(const CheckContext& c, const Item& member, const Wanted& wanted);

}  // namespace whit::gltf
