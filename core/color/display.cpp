#include "core/color/display.h"

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "core/color/builtin_config.h"
#include "core/color/srgb.h"

namespace whit {

namespace ocio = OCIO_NAMESPACE;

struct DisplayTransform::Impl {
  ocio::ConstCPUProcessorRcPtr processor;  // null: the exact sRGB curve
  float gain = 1;
  std::string description;
  std::vector<std::string> views;
};

namespace {

constexpr const char* kExposure = "exposure";

// Bounds what goes into OpenColorIO: products of three such values are still finite in a float. (Its ACES view squares
// them, and turns 1e30 black.)
constexpr float kBrightest = 1e12f;

struct ChosenView {
  std::string display, view;
};

// The e of "exposure=e" or "exposure e", nothing for another view.
std::optional<std::string> exposure_argument(const std::string& view) {
  const std::string name = kExposure;
  if (view.rfind(name, 0) != 0 || view.size() < name.size() + 1 || view[name.size()] != '=') return std::nullopt;
  return view.substr(name.size() + 1);
}

std::string parse_exposure(const std::string& text, float& e) {
  char* end = nullptr;
  e = std::strtof(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(e >= 0 && e < 1))
    return fmt::format("view \"exposure={}\" needs a number from 0 up to, not including, 1, as in \"exposure=0.6\"",
                       text);
  return "";
}

std::string join(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& n : names) all += (all.empty() ? "\"" : ", \"") + n + "\"";
  return all;
}

std::vector<std::string> config_views(const ocio::Config& config) {
  const std::string main_display = config.getDefaultDisplay();
  std::vector<std::string> names;
  for (int d = 0; d < config.getNumDisplays(); ++d) {
    const std::string display = config.getDisplay(d);
    for (int v = 0; v < config.getNumViews(display.c_str()); ++v) {
      const std::string view = config.getView(display.c_str(), v);
      names.push_back(display == main_display ? view : display + "/" + view);
    }
  }
  return names;
}

bool has_view(const ocio::Config& config, const std::string& display, const std::string& view) {
  for (int v = 0; v < config.getNumViews(display.c_str()); ++v)
    if (view == config.getView(display.c_str(), v)) return true;
  return false;
}

// Names may contain slashes themselves, so every place to split is tried.
std::optional<ChosenView> find_view(const ocio::Config& config, const std::string& wanted) {
  const std::string display = config.getDefaultDisplay();
  if (wanted.empty()) return ChosenView{display, config.getDefaultView(display.c_str())};
  if (has_view(config, display, wanted)) return ChosenView{display, wanted};
  for (size_t slash = wanted.find('/'); slash != std::string::npos; slash = wanted.find('/', slash + 1))
    if (has_view(config, wanted.substr(0, slash), wanted.substr(slash + 1)))
      return ChosenView{wanted.substr(0, slash), wanted.substr(slash + 1)};
  return std::nullopt;
}

std::string unknown_view(const std::string& view, const std::vector<std::string>& known, const std::string& where) {
  return fmt::format("unknown view \"{}\"; {} has {}", view, where, known.empty() ? "none" : join(known));
}

ocio::ConstCPUProcessorRcPtr make_processor(const ocio::ConstConfigRcPtr& config, const std::string& input,
                                            const ChosenView& chosen) {
  ocio::DisplayViewTransformRcPtr t = ocio::DisplayViewTransform::Create();
  t->setSrc(input.c_str());
  t->setDisplay(chosen.display.c_str());
  t->setView(chosen.view.c_str());
  return config->getProcessor(t)->getDefaultCPUProcessor();
}

// Libraries do not print. Who sets OpenColorIO's own variable wants to see its messages.
void silence_opencolorio() {
  static const bool once = [] {
    if (!std::getenv("OCIO_LOGGING_LEVEL")) ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_NONE);
    return true;
  }();
  (void)once;
}

std::string stops_text(float stops) { return stops == 0 ? "" : fmt::format(", {:+g} stops", stops); }

}  // namespace

DisplayTransform::DisplayTransform(std::unique_ptr<const Impl> impl) : impl_(std::move(impl)) {}
DisplayTransform::~DisplayTransform() = default;
std::string DisplayTransform::describe() const { return impl_->description; }
std::vector<std::string> DisplayTransform::view_names() const { return impl_->views; }

void DisplayTransform::apply(float* rgb, size_t n_pixels) const {
  const size_t n = 3 * n_pixels;
  const float gain = impl_->gain;
  if (!impl_->processor) {
#pragma omp simd
    for (size_t i = 0; i < n; ++i) rgb[i] = srgb_encode(rgb[i] * gain);
    return;
  }
  for (size_t i = 0; i < n; ++i) {
    const float v = rgb[i] * gain;
    rgb[i] = std::isnan(v) ? 0 : std::clamp(v, -kBrightest, kBrightest);
  }
  constexpr size_t kMost = size_t{1} << 24;  // pixels of one call: OpenColorIO counts in long, but works by lines
  for (size_t first = 0; first < n_pixels; first += kMost) {
    const size_t count = std::min(kMost, n_pixels - first);
    ocio::PackedImageDesc pixels(rgb + 3 * first, static_cast<long>(count), 1, 3);
    impl_->processor->apply(pixels);
  }
  for (size_t i = 0; i < n; ++i) rgb[i] = rgb[i] > 0 ? std::min(rgb[i], 1.0f) : 0.0f;  // NaN too
}

namespace {

// The transform of the built-in config: a processor (null for the exact curve), and its name for the log.
std::string builtin_view(const DisplaySpec& spec, ocio::ConstCPUProcessorRcPtr& processor, std::string& name,
                         std::vector<std::string>& views) {
  views = {"sRGB", "ACES SDR", "exposure=e"};
  name = spec.view.empty() ? "sRGB" : spec.view;
  if (name.rfind("sRGB/", 0) == 0) name.erase(0, 5);
  float e = 0;
  const std::optional<std::string> argument = exposure_argument(name);
  if (argument)
    if (std::string error = parse_exposure(*argument, e); !error.empty()) return error;
  if (!argument && name != "sRGB" && name != "ACES SDR") return unknown_view(spec.view, views, "the built-in config");
  // OpenColorIO's table is exact only on halfs, its own sRGB function 2.5e-4 off below the break: the default must
  // be what pbrt-v3 writes.
  const bool linear_709 = spec.input_space == ocio::ROLE_SCENE_LINEAR || spec.input_space.empty();
  if (name == "sRGB" && linear_709) return "";
  const std::string input = linear_709 ? std::string(ocio::ROLE_SCENE_LINEAR) : spec.input_space;
  processor = make_processor(make_builtin_config(e), input, {"sRGB", argument ? kExposure : name});
  return "";
}

std::string config_view(const std::string& path, const DisplaySpec& spec, ocio::ConstCPUProcessorRcPtr& processor,
                        std::string& name, std::vector<std::string>& views) {
  const ocio::ConstConfigRcPtr config = ocio::Config::CreateFromFile(path.c_str());
  const std::string file = std::filesystem::path(path).filename().string();
  views = config_views(*config);
  const std::optional<ChosenView> chosen = find_view(*config, spec.view);
  if (!chosen) return unknown_view(spec.view, views, fmt::format("\"{}\"", path));
  if (chosen->view.empty()) return fmt::format("OpenColorIO config \"{}\" has no views", path);
  processor = make_processor(config, spec.input_space, *chosen);
  name = fmt::format("{} ({} display, {})", chosen->view, chosen->display, file);
  return "";
}

}  // namespace

DisplayResult make_display_transform(const DisplaySpec& spec) {
  silence_opencolorio();
  DisplayResult result;
  std::string path = spec.config_path;
  const char* environment = std::getenv("OCIO");
  if (path.empty() && environment) path = environment;
  if (!std::isfinite(spec.exposure) || std::abs(spec.exposure) > 100) {
    result.error = fmt::format("exposure of {} stops is out of range (-100 to 100)", spec.exposure);
    return result;
  }
  auto impl = std::make_unique<DisplayTransform::Impl>();
  impl->gain = std::exp2(spec.exposure);
  try {
    std::string name;
    result.error = path.empty() ? builtin_view(spec, impl->processor, name, impl->views)
                                : config_view(path, spec, impl->processor, name, impl->views);
    impl->description = name + (path.empty() ? " (built-in)" : "") + stops_text(spec.exposure);
  } catch (const std::exception& e) {
    result.bad_config = true;
    result.error = path.empty() ? fmt::format("OpenColorIO: {}", e.what())
                                : fmt::format("OpenColorIO config \"{}\": {}", path, e.what());
  }
  if (result.error.empty()) result.transform.reset(new DisplayTransform(std::move(impl)));
  return result;
}

}  // namespace whit
