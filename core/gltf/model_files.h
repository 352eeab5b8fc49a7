// The files that a model names, without reading them.
#pragma once

#include <string>
#include <vector>

namespace whit {

/// Which files of the disk a model is made of beside its own: what its buffers and pictures name. Nothing where it is no
/// model (yet).
std::vector<std::string> files_of_model(const std::string& path);

}  // namespace whit
