// The part of a document that says where the numbers are: buffers, buffer views and accessors.
#pragma once

#include <string>

#include "core/gltf/buffers.h"

namespace whit::gltf {

/// Reads and checks them all. What is wrong is reported; `out` then has as many of each, unusable.
void read_data(const Item& root, const Document& document, const std::string& folder, const LoadOptions& options,
               Buffers& out);

}  // namespace whit::gltf
