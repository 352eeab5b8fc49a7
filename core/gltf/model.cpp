#include "core/gltf/model.h"

namespace whit::gltf {

std::string Model::at(std::string_view place) const { return path + ": " + std::string(place); }

}  // namespace whit::gltf
