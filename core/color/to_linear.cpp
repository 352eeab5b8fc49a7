#include "core/color/to_linear.h"

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "core/base/plain_text.h"
#include "core/color/srgb.h"

namespace whit {
namespace {

namespace ocio = OCIO_NAMESPACE;

// ITU-R BT.709, decoded; of negative values, here as for sRGB, the mirror image.
double rec709_decode(double v) { return v < 0.081 ? v / 4.5 : std::pow((v + 0.099) / 1.099, 1 / 0.45); }

template <class Curve>
ToLinear of_curve(const Curve& curve) {
  const auto plane = [curve](std::span<float> values) {
    tbb::parallel_for(tbb::blocked_range<size_t>(0, values.size(), 16384), [&](const tbb::blocked_range<size_t>& r) {
      for (size_t i = r.begin(); i < r.end(); ++i) {
        const double v = std::abs(double{values[i]});
        values[i] = static_cast<float>(std::copysign(curve(v), double{values[i]}));
      }
    });
  };
  const auto all = [plane](std::span<float> r, std::span<float> g, std::span<float> b) {
    plane(r), plane(g), plane(b);
  };
  return all;
}

// The power of "gamma=2.2", or of OpenImageIO's "Gamma2.2"; none where it is no number.
std::optional<double> gamma_of(const std::string& space) {
  if (lower_case(space).rfind("gamma", 0) != 0) return std::nullopt;
  const std::string number = space.substr(space.size() > 5 && space[5] == '=' ? 6 : 5);
  char* end = nullptr;
  const double gamma = std::strtod(number.c_str(), &end);
  if (number.empty() || *end != '\0' || !(gamma > 0.1 && gamma < 10)) return std::nullopt;
  return gamma;
}

ToLinear of_processor(const ocio::ConstCPUProcessorRcPtr& processor) {
  return [processor](std::span<float> r, std::span<float> g, std::span<float> b) {
    ocio::PlanarImageDesc image(r.data(), g.data(), b.data(), nullptr, static_cast<long>(r.size()), 1);
    processor->apply(image);
  };
}

std::string known_spaces(const ocio::ConstConfigRcPtr& config) {
  std::string known = "linear, sRGB, Rec709, gamma=2.2";
  for (int i = 0; config && i < config->getNumColorSpaces(); ++i)
    known.append(", ").append(config->getColorSpaceNameByIndex(i));
  return config ? known : known + ", and those of the config that $OCIO names, which is not set";
}

}  // namespace

ToLinearResult make_to_linear(const std::string& space) {
  const std::string name = lower_case(space);
  if (name == "linear") return {of_curve([](double v) { return v; }), ""};
  if (name == "srgb") return {of_curve(srgb_decode), ""};
  if (name == "rec709") return {of_curve(rec709_decode), ""};
  if (const std::optional<double> gamma = gamma_of(space))
    return {of_curve([g = *gamma](double v) { return std::pow(v, g); }), ""};
  try {
    const char* path = std::getenv("OCIO");
    const ocio::ConstConfigRcPtr config = path ? ocio::Config::CreateFromFile(path) : nullptr;
    if (config && config->getColorSpace(space.c_str()))
      return {of_processor(config->getProcessor(space.c_str(), ocio::ROLE_SCENE_LINEAR)->getDefaultCPUProcessor()), ""};
    return {{}, fmt::format("unknown colour space \"{}\"; there are {}", space, known_spaces(config))};
  } catch (const std::exception& e) {
    return {{}, fmt::format("colour space \"{}\": OpenColorIO: {}", space, e.what())};
  }
}

}  // namespace whit
