// Where pictures go: names, the linear file, the display file beside it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/diagnostics.h"
#include "core/base/stopwatch.h"
#include "core/color/display.h"
#include "core/image/write.h"
#include "core/render/render.h"
#include "core/scene/bound_scene.h"

namespace whit {

/// What is asked for.
struct OutputRequest {
  std::string outfile;             ///< --outfile; "" takes the film's.
  std::string scene_path;          ///< For the name when the film has none.
  std::string display;             ///< --display FILE; "" derives it from the main file, "none" writes none.
  std::string view, ocio;          ///< --view, --ocio; "" takes the film's or the default.
  std::optional<double> exposure;  ///< --exposure; none takes the film's.
  bool unwritten = false;          ///< --outfile none: what is rendered goes elsewhere.
  bool full_float = false;
  std::vector<std::string> aovs;  ///< --aov; none takes the film's, "none" alone writes none.
  std::vector<std::string> read;  ///< Files that the scene reads, files_read(): no picture may take the place of one.
};

/// The files that the statements of a world name: pictures, meshes, models, spectra, lenses; live or not.
std::vector<std::string> files_read(const SceneDescription& world);

/// What a render writes and how. Where `said` has an error nothing should be rendered: it is at the Film statement if
/// that asked for what cannot be had, else it has no place.
struct OutputPlan {
  std::string
      main_file;  ///< Linear (.exr, .pfm) or display-encoded (.png, ...), as the scene or --outfile says; or "".
  std::string display_file;  ///< The PNG beside a linear file; "" when there is none.
  bool full_float = false;
  std::unique_ptr<const DisplayTransform> display;
  std::vector<std::string> aovs;    ///< What the main file holds beside the colours: names that there are.
  std::vector<std::string> guides;  ///< AOVs that are rendered and not written, for a denoiser.
  Diagnostics said;

  std::vector<std::string> rendered_aovs() const;  ///< Those and these.
};

/// Decides the names, checks that the files can be written and that the view exists.
OutputPlan plan_output(const OutputRequest& request, const Bound<Film>& film);

/// What came of writing. Nothing of it has a place in the scene.
struct WrittenOutput {
  Diagnostics said;
  Elapsed elapsed;
};
WrittenOutput write_output(const OutputPlan& plan, const RenderResult& result,
                           const std::vector<OutputMetadata>& metadata);

}  // namespace whit
