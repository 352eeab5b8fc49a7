// Which scene, node, variant and camera of a model are meant.
#pragma once

#include <string>
#include <vector>

#include "core/gltf/describe.h"

namespace whit::gltf {

/// The index of a variant by name or number; -1 when there is none.
int variant_index(const Model& model, const std::string& wanted);
int camera_index(const Model& model, const std::string& wanted);

/// The nodes at which drawing begins. False, and an error with what there is, when a name is of nothing.
bool select_roots(const Model& model, const Selection& selection, std::vector<int>& roots, SourcePos where,
                  Diagnostics& diagnostics);

/// The nodes and all below them, parents first, in the order of the file.
std::vector<int> nodes_below(const Model& model, const std::vector<int>& roots);

}  // namespace whit::gltf
