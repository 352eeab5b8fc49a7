// The numbers of accessors: decoded from mapped buffers when asked for.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/gltf/model.h"

namespace whit::gltf {

/// How many elements an accessor has, and how many numbers each (16 for MAT4).
size_t element_count(const Model& model, int accessor);
int components_of(const Model& model, int accessor);

/// All numbers of an accessor, element by element, matrices column by column without padding: normalised integers as the
/// specification's section 3.11 (and KHR_mesh_quantization) has them, sparse values in their places, compressed buffer views decompressed. Numbers
/// that are not finite are an error. Returns "", or what is wrong, with the JSON path but without the file. Thread-safe.
std::string read_floats(const Model& model, int accessor, std::vector<float>& out);

/// The same of integers that are not normalised.
std::string read_integers(const Model& model, int accessor, std::vector<uint32_t>& out);

}  // namespace whit::gltf
