#include "tools/whit/output.h"

#include <fmt/format.h>

#include <filesystem>
#include <future>

#include "tools/whit/commands.h"

namespace whit {
namespace {

OutputImage to_output(const Picture& picture, std::span<const float> rgb) {
  OutputImage image;
  image.width = picture.width(), image.height = picture.height();
  image.x = picture.window.min.x, image.y = picture.window.min.y;
  image.full_width = picture.resolution.x, image.full_height = picture.resolution.y;
  image.rgb = rgb;
  return image;
}

std::string write_one(const std::string& path, const OutputImage& image, const WriteOptions& options,
                      std::vector<std::string>& notes) {
  const WriteResult result = write_image(path, image, options);
  if (!result.warning.empty()) notes.push_back(result.warning);
  return result.error;
}

OutputProblem problem_of(SourcePos where, ErrorClass error_class, std::string message, int code) {
  return {{Severity::Error, error_class, where, std::move(message), ""}, code};
}

}  // namespace

std::optional<OutputProblem> plan_output(const OutputRequest& request, const Bound<Film>& bound, OutputPlan& plan) {
  const Film& film = *bound.plugin;
  plan.full_float = request.full_float;
  plan.main_file = !request.outfile.empty() ? request.outfile : film.file_name();
  if (plan.main_file.empty()) {
    const std::filesystem::path scene(request.scene_path);
    plan.main_file = (scene.stem().empty() || request.scene_path == "-" ? "whit" : scene.stem().string()) + ".exr";
  }
  if (is_linear_format(plan.main_file) && request.display != "none") {
    plan.display_file = !request.display.empty()
                            ? request.display
                            : std::filesystem::path(plan.main_file).replace_extension(".png").string();
  }
  for (const std::string& path : {plan.main_file, plan.display_file}) {
    if (path.empty()) continue;
    if (std::string problem = check_writable(path); !problem.empty()) {
      const bool by_film = request.outfile.empty() && !film.file_name().empty() && path == plan.main_file;
      return problem_of(by_film ? bound.where : SourcePos{}, ErrorClass::File, std::move(problem), kFileError);
    }
  }
  DisplaySpec spec;
  spec.config_path = request.ocio;
  spec.view = !request.view.empty() ? request.view : film.view();
  spec.exposure = static_cast<float>(request.exposure.value_or(film.exposure()));
  DisplayResult display = make_display_transform(spec);
  plan.display = std::move(display.transform);
  if (display.error.empty()) return {};
  const bool by_film = request.view.empty() && !film.view().empty();
  return problem_of(by_film ? bound.where : SourcePos{}, ErrorClass::Scene, std::move(display.error),
                    display.bad_config ? kFileError
                    : by_film          ? kSceneError
                                       : kUsage);
}

std::string write_output(const OutputPlan& plan, const Picture& picture, const std::vector<OutputMetadata>& metadata,
                         std::vector<std::string>& notes) {
  WriteOptions options;
  options.full_float = plan.full_float;
  const auto write = [&](const std::string& path, std::vector<std::string>& said) {
    std::vector<float> encoded;
    if (!is_linear_format(path)) {
      encoded = picture.rgb;
      plan.display->apply(encoded.data(), encoded.size() / 3);
    }
    OutputImage image = to_output(picture, encoded.empty() ? picture.rgb : encoded);
    image.metadata = metadata;
    return write_one(path, image, options, said);
  };
  if (plan.display_file.empty()) return write(plan.main_file, notes);
  // Compressing is most of it, and there is more than one core.
  std::vector<std::string> display_notes;
  auto display = std::async(std::launch::async, [&] { return write(plan.display_file, display_notes); });
  const std::string error = write(plan.main_file, notes), display_error = display.get();
  notes.insert(notes.end(), display_notes.begin(), display_notes.end());
  return error.empty() ? display_error : error;
}

}  // namespace whit
