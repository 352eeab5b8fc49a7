#include "core/gltf/check_model.h"

#include "core/gltf/check_parts.h"

namespace whit::gltf {

void check_model(const Item& root, const Buffers&) { check_extensions(root); }

}  // namespace whit::gltf
