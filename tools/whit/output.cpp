#include "tools/whit/output.h"

#include <fmt/format.h>

#include <filesystem>

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

}  // namespace

std::string plan_output(const OutputRequest& request, const Film& film, OutputPlan& plan) {
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
    if (std::string problem = check_writable(path); !problem.empty()) return problem;
  }
  DisplaySpec spec;
  spec.config_path = request.ocio;
  spec.view = !request.view.empty() ? request.view : film.view();
  spec.exposure = static_cast<float>(request.exposure_given ? request.exposure : film.exposure());
  DisplayResult display = make_display_transform(spec);
  plan.display = std::move(display.transform);
  return display.error;
}

std::string write_output(const OutputPlan& plan, const Picture& picture, const std::vector<OutputMetadata>& metadata,
                         std::vector<std::string>& notes) {
  WriteOptions options;
  options.full_float = plan.full_float;
  std::vector<float> encoded;
  const auto display_pixels = [&] {
    encoded = picture.rgb;
    plan.display->apply(encoded.data(), encoded.size() / 3);
    return std::span<const float>(encoded);
  };
  const bool linear = is_linear_format(plan.main_file);
  OutputImage main = to_output(picture, linear ? std::span<const float>(picture.rgb) : display_pixels());
  main.metadata = metadata;
  if (std::string error = write_one(plan.main_file, main, options, notes); !error.empty()) return error;
  if (plan.display_file.empty()) return {};
  OutputImage shown = to_output(picture, display_pixels());
  shown.metadata = metadata;
  return write_one(plan.display_file, shown, options, notes);
}

}  // namespace whit
