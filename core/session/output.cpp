#include "core/session/output.h"

#include <fmt/format.h>

#include <filesystem>
#include <future>

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

void choose_names(const OutputRequest& request, const Film& film, OutputPlan& plan) {
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
}

/// Which AOVs the main file is to hold, and whether it can.
void choose_aovs(const OutputRequest& request, const Film& film, OutputPlan& plan) {
  const bool by_film = request.aovs.empty();
  const StringList& asked = film.aovs();
  plan.aovs = by_film ? std::vector<std::string>(asked.values.begin(), asked.values.end()) : request.aovs;
  if (plan.aovs == std::vector<std::string>{"none"}) plan.aovs.clear();
  std::string problem = unknown_aov(plan.aovs);
  if (problem.empty() && !plan.aovs.empty() && !holds_layers(plan.main_file))
    problem = fmt::format("\"{}\" cannot hold AOVs: only .exr files can; --aov none leaves them out", plan.main_file);
  if (problem.empty()) return;
  if (by_film) plan.said.error(asked.where, problem);
  else plan.said.add({Severity::Error, ErrorClass::Usage, {}, "--aov: " + problem, ""});
}

void add_aovs(const AovPicture& aovs, OutputImage& image) {
  for (const AovPicture::Channel& c : aovs.channels) image.layers.push_back({c.name, c.values, c.full_float});
  image.metadata.insert(image.metadata.end(), aovs.header.begin(), aovs.header.end());
  image.matrices = aovs.matrices;
}

/// The first file that cannot be written is reported.
void check_files(const OutputRequest& request, const Bound<Film>& film, OutputPlan& plan) {
  for (const std::string& path : {plan.main_file, plan.display_file}) {
    if (path.empty()) continue;
    std::string problem = check_writable(path);
    if (problem.empty()) continue;
    const bool by_film = request.outfile.empty() && !film.plugin->file_name().empty() && path == plan.main_file;
    plan.said.file_error(by_film ? film.where : SourcePos{}, std::move(problem));
    return;
  }
}

void make_display(const OutputRequest& request, const Bound<Film>& bound, OutputPlan& plan) {
  const Film& film = *bound.plugin;
  DisplaySpec spec;
  spec.config_path = request.ocio;
  spec.view = !request.view.empty() ? request.view : film.view();
  spec.exposure = static_cast<float>(request.exposure.value_or(film.exposure()));
  DisplayResult display = make_display_transform(spec);
  plan.display = std::move(display.transform);
  if (display.error.empty()) return;
  const bool by_film = request.view.empty() && !film.view().empty();
  const ErrorClass error_class = display.bad_config ? ErrorClass::File
                                 : by_film          ? ErrorClass::Scene
                                                    : ErrorClass::Usage;
  plan.said.add(
      {Severity::Error, error_class, by_film ? bound.where : SourcePos{}, std::move(display.error), std::string()});
}

/// Writes one file; what there is to say of it.
Diagnostics write_file(const std::string& path, const OutputPlan& plan, const RenderResult& result,
                       const std::vector<OutputMetadata>& metadata) {
  const Picture& picture = result.picture;
  std::vector<float> encoded;
  if (!is_linear_format(path)) {
    encoded = picture.rgb;
    plan.display->apply(encoded.data(), encoded.size() / 3);
  }
  OutputImage image = to_output(picture, encoded.empty() ? picture.rgb : encoded);
  image.metadata = metadata;
  if (holds_layers(path)) add_aovs(result.aovs, image);
  WriteOptions options;
  options.full_float = plan.full_float;
  WriteResult written = write_image(path, image, options);
  Diagnostics said;
  if (!written.warning.empty()) said.warning({}, std::move(written.warning));
  if (!written.ok()) said.file_error({}, std::move(written.error));
  return said;
}

}  // namespace

OutputPlan plan_output(const OutputRequest& request, const Bound<Film>& film) {
  OutputPlan plan;
  plan.full_float = request.full_float;
  choose_names(request, *film.plugin, plan);
  choose_aovs(request, *film.plugin, plan);
  if (!plan.said.has_errors()) check_files(request, film, plan);
  if (!plan.said.has_errors()) make_display(request, film, plan);
  return plan;
}

WrittenOutput write_output(const OutputPlan& plan, const RenderResult& result,
                           const std::vector<OutputMetadata>& metadata) {
  const Stopwatch watch;
  WrittenOutput out;
  // Compressing is most of it, and there is more than one core.
  std::future<Diagnostics> display;
  if (!plan.display_file.empty()) {
    display = std::async(std::launch::async, [&] { return write_file(plan.display_file, plan, result, metadata); });
  }
  out.said = write_file(plan.main_file, plan, result, metadata);
  if (display.valid()) out.said.append(display.get());
  out.elapsed = watch.elapsed();
  return out;
}

}  // namespace whit
