#include "core/session/output.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <future>

#include "core/plugin/memory_limit.h"

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

bool is_read(const OutputRequest& request, const std::string& path) {
  const std::filesystem::path name = std::filesystem::path(path).filename();
  return std::any_of(request.read.begin(), request.read.end(), [&](const std::string& read) {
    std::error_code failed;
    return std::filesystem::path(read).filename() == name && std::filesystem::equivalent(read, path, failed);
  });
}

/// A name that nobody has given, or one beside it where the scene reads a file of that name.
std::string unread_name(const OutputRequest& request, const std::filesystem::path& name) {
  if (!is_read(request, name.string())) return name.string();
  std::filesystem::path other = name;
  other.replace_filename(name.stem().string() + "-whit" + name.extension().string());
  return other.string();
}

void choose_names(const OutputRequest& request, const Film& film, OutputPlan& plan) {
  if (request.unwritten) return;
  plan.main_file = !request.outfile.empty() ? request.outfile : film.file_name();
  if (plan.main_file.empty()) {
    const std::filesystem::path scene(request.scene_path);
    const bool has_name = !scene.stem().empty() && request.scene_path != "-";
    plan.main_file = unread_name(request, (has_name ? scene.stem().string() : "whit") + ".exr");
  }
  if (is_linear_format(plan.main_file) && request.display != "none") {
    plan.display_file = !request.display.empty()
                            ? request.display
                            : unread_name(request, std::filesystem::path(plan.main_file).replace_extension(".png"));
  }
}

/// Which AOVs the main file is to hold, and whether it can.
void choose_aovs(const OutputRequest& request, const Film& film, OutputPlan& plan) {
  const bool by_film = request.aovs.empty();
  const StringList& asked = film.aovs();
  plan.aovs = by_film ? std::vector<std::string>(asked.values.begin(), asked.values.end()) : request.aovs;
  if (plan.aovs == std::vector<std::string>{"none"}) plan.aovs.clear();
  std::string problem = unknown_aov(plan.aovs);
  if (problem.empty() && !plan.aovs.empty() && !request.unwritten && !holds_layers(plan.main_file))
    problem = fmt::format("\"{}\" cannot hold AOVs: only .exr files can; --aov none leaves them out", plan.main_file);
  if (problem.empty()) return;
  if (by_film) plan.said.error(asked.where, problem);
  else plan.said.add({Severity::Error, ErrorClass::Usage, {}, "--aov: " + problem, ""});
}

/// Those of the plan, and not its guides.
void add_aovs(const OutputPlan& plan, const AovPicture& aovs, OutputImage& image) {
  if (plan.aovs.empty()) return;
  std::vector<std::string> unwritten;
  for (const std::string& name : plan.guides) {
    const std::vector<std::string>& channels = find_aov(name)->channels;
    unwritten.insert(unwritten.end(), channels.begin(), channels.end());
  }
  for (const AovPicture::Channel& c : aovs.channels) {
    if (std::count(unwritten.begin(), unwritten.end(), c.name) == 0)
      image.layers.push_back({c.name, c.values, c.full_float});
  }
  image.metadata.insert(image.metadata.end(), aovs.header.begin(), aovs.header.end());
  image.matrices = aovs.matrices;
}

/// The first file that cannot be written is reported.
void check_files(const OutputRequest& request, const Bound<Film>& film, OutputPlan& plan) {
  for (const std::string& path : {plan.main_file, plan.display_file}) {
    if (path.empty()) continue;
    std::string problem =
        is_read(request, path) ? fmt::format("\"{}\" is a file that the scene reads", path) : check_writable(path);
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
  if (holds_layers(path)) add_aovs(plan, result.aovs, image);
  WriteOptions options;
  options.full_float = plan.full_float;
  WriteResult written = write_image(path, image, options);
  Diagnostics said;
  if (!written.warning.empty()) said.warning({}, std::move(written.warning));
  if (written.out_of_memory) said.add(limit_error({}, std::move(written.error)));
  else if (!written.ok()) said.file_error({}, std::move(written.error));
  return said;
}

}  // namespace

std::vector<std::string> files_read(const SceneDescription& world) {
  std::vector<std::string> files;
  const auto add = [&](const Entity& entity) {
    for (const Parameter& p : entity.params) {
      constexpr std::array kFiles{"filename", "mapname", "lensfile", "bsdffile"};
      const bool names_file = p.type == ParamType::Spectrum || std::count(kFiles.begin(), kFiles.end(), p.name) > 0;
      if (!names_file) continue;
      for (const std::string& file : p.strings())
        files.push_back((std::filesystem::path(world.folder) / file).string());
    }
  };
  add(world.camera);
  for (const auto& t : world.textures) add(t);
  for (const auto& m : world.materials) add(m);
  for (const auto& l : world.lights) add(l);
  for (const auto& l : world.area_lights) add(l);
  for (const auto& s : world.shapes) add(s);
  return files;
}

std::vector<std::string> OutputPlan::rendered_aovs() const {
  std::vector<std::string> names = aovs;
  names.insert(names.end(), guides.begin(), guides.end());
  return names;
}

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
  if (plan.main_file.empty()) return out;
  // Compressing is most of it, and there is more than one core.
  std::future<Diagnostics> display;
  if (!plan.display_file.empty()) {
    display = std::async(std::launch::async | std::launch::deferred,
                         [&] { return write_file(plan.display_file, plan, result, metadata); });
  }
  out.said = write_file(plan.main_file, plan, result, metadata);
  if (display.valid()) out.said.append(display.get());
  out.elapsed = watch.elapsed();
  return out;
}

}  // namespace whit
