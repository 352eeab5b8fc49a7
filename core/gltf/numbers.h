// What reading primitives needs of accessors beyond core/gltf/accessor.h.
#pragma once

#include <string>
#include <vector>

#include "core/gltf/model.h"

namespace whit::gltf {

/// read_floats() in double precision, where NaN and infinity are no error.
std::string read_any_numbers(const Model& model, int accessor, std::vector<double>& out);

class Buffers;

/// read_floats() before there is a model.
std::string read_floats(const Buffers& buffers, int accessor, std::vector<float>& out);

/// "", or which element is not finite.
std::string not_finite(int accessor, const std::vector<float>& numbers, int width);

}  // namespace whit::gltf
