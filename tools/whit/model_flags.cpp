#include "tools/whit/model_flags.h"

#include <fmt/format.h>

#include <cmath>

#include "core/session/models.h"

namespace whit {

void add_model_flags(CommandLine& command, ModelFlags& flags, bool with_time) {
  command.flags.push_back({"--camera", &flags.camera, "Of a glTF model: the camera, by name or number"});
  command.flags.push_back({"--scene", &flags.scene, "The scene in the model's file, by name or number"});
  if (with_time)
    command.flags.push_back(
        {"--time", &flags.time, "Seconds into the model's animations; without it as the file has the nodes"});
  command.flags.push_back({"--variant", &flags.variant, "The variant of the model's materials, by name or number"});
  command.flags.push_back({"--allow-outside", &flags.allow_outside, "Models may name files outside of their folder"});
}

std::string usage_problem(const ModelFlags& flags) {
  return flags.time && !std::isfinite(*flags.time) ? "--time: no number of seconds" : "";
}

std::string usage_problem(const ModelFlags& flags, const std::string& path) {
  if (std::string problem = usage_problem(flags); !problem.empty()) return problem;
  const std::pair<const char*, bool> given[] = {{"--camera", !flags.camera.empty()},
                                                {"--scene", !flags.scene.empty()},
                                                {"--time", flags.time.has_value()},
                                                {"--variant", !flags.variant.empty()}};
  for (const auto& [flag, is_given] : given) {
    if (is_given && !is_model_file(path))
      return fmt::format("{} is of glTF models, and \"{}\" is none; a scene says it by its own statements", flag, path);
  }
  return {};
}

gltf::Selection selection_of(const ModelFlags& flags) {
  gltf::Selection out;
  out.scene = flags.scene, out.camera = flags.camera, out.variant = flags.variant, out.time = flags.time;
  return out;
}

ReadOptions read_options(const ModelFlags& flags) {
  ReadOptions out;
  out.model = selection_of(flags), out.allow_outside = flags.allow_outside;
  return out;
}

}  // namespace whit
