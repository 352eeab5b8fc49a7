// The cameras and lights of a model as statements.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "core/gltf/describe.h"
#include "core/gltf/pose.h"

namespace whit::gltf {

/// The options of a scene: film, sampler, integrator, and the camera that is wanted, the first that stands in the scene,
/// or one from the front, above and the right that shows all of it. False after an error.
bool describe_view(const Model& model, const Selection& selection, const ShownNodes& shown, std::string& text,
                   std::vector<std::string>& notes, Diagnostics& diagnostics);

/// The light of a node, or "".
std::string light_statements(const Model& model, int node, const Mat4d& to_root, std::set<std::string>& notes);

}  // namespace whit::gltf
