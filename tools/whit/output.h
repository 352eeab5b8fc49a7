// Where pictures go: names, the linear file, the display file beside it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/color/display.h"
#include "core/image/write.h"
#include "core/render/render.h"
#include "core/scene/bound_scene.h"

namespace whit {

/// What a render writes and how.
struct OutputPlan {
  std::string main_file;     ///< Linear (.exr, .pfm) or display-encoded (.png, ...), as the scene or --outfile says.
  std::string display_file;  ///< The PNG beside a linear file; "" when there is none.
  bool full_float = false;
  std::unique_ptr<const DisplayTransform> display;
};

struct OutputRequest {
  std::string outfile;             ///< --outfile; "" takes the film's.
  std::string scene_path;          ///< For the name when the film has none.
  std::string display;             ///< --display FILE; "" derives it from the main file, "none" writes none.
  std::string view, ocio;          ///< --view, --ocio; "" takes the film's or the default.
  std::optional<double> exposure;  ///< --exposure; none takes the film's.
  bool full_float = false;
};

/// What is wrong with a plan: at the Film statement if that asked for it, else without a place.
struct OutputProblem {
  Diagnostic diagnostic;
  int exit_code = 0;
};

/// Decides the names, checks that the files can be written and that the view exists.
std::optional<OutputProblem> plan_output(const OutputRequest& request, const Bound<Film>& film, OutputPlan& plan);

/// Writes the files. Returns "" or the error; `notes` gets what should be said.
std::string write_output(const OutputPlan& plan, const Picture& picture, const std::vector<OutputMetadata>& metadata,
                         std::vector<std::string>& notes);

}  // namespace whit
