// The flags that choose what of a model is shown.
#pragma once

#include <optional>
#include <string>

#include "core/session/session.h"
#include "tools/whit/command_line.h"

namespace whit {

struct ModelFlags {
  std::string scene, camera, variant;
  std::optional<double> time;
  bool allow_outside = false;
};

/// Without --time where a command has a flag of that name.
void add_model_flags(CommandLine& command, ModelFlags& flags, bool with_time = true);
/// "" or what is wrong with them whatever the file.
std::string usage_problem(const ModelFlags& flags);
/// The same for a file: flags of models may be given for models alone.
std::string usage_problem(const ModelFlags& flags, const std::string& path);
gltf::Selection selection_of(const ModelFlags& flags);
ReadOptions read_options(const ModelFlags& flags);

}  // namespace whit
