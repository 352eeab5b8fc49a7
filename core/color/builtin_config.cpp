#include "core/color/builtin_config.h"

#include <Imath/half.h>

#include <algorithm>
#include <cmath>

#include "core/color/srgb.h"

namespace whit {
namespace {

namespace ocio = OCIO_NAMESPACE;

// Half has 65536 values, and a table with an entry for each is exact on them; between two neighbours
// it interpolates, which is good to 1e-7 for curves as smooth as these.
constexpr unsigned long kHalfValues = 65536;

template <class Curve>
ocio::TransformRcPtr half_domain_table(const Curve& curve) {
  ocio::Lut1DTransformRcPtr lut = ocio::Lut1DTransform::Create(kHalfValues, true);
  lut->setInterpolation(ocio::INTERP_LINEAR);
  lut->setFileOutputBitDepth(ocio::BIT_DEPTH_F32);
  for (unsigned long i = 0; i < kHalfValues; ++i) {
    Imath::half h;
    h.setBits(static_cast<uint16_t>(i));
    float v = h;
    if (h.isNan()) v = 0;
    if (h.isInfinity()) v = h.isNegative() ? -65504.0f : 65504.0f;
    const float encoded = curve(v);
    lut->setValue(i, encoded, encoded, encoded);
  }
  return lut;
}

// 1 - exp(-L / (1 - e)) is display light; the display wants it sRGB-encoded.
ocio::TransformRcPtr exposure_curve(float e) {
  return half_domain_table([e](float v) {
    const double light = -std::expm1(-static_cast<double>(std::max(v, 0.0f)) / (1.0 - e));
    return srgb_encode(static_cast<float>(light));
  });
}

ocio::TransformRcPtr builtin(const char* style, ocio::TransformDirection direction = ocio::TRANSFORM_DIR_FORWARD) {
  ocio::BuiltinTransformRcPtr t = ocio::BuiltinTransform::Create();
  t->setStyle(style);
  t->setDirection(direction);
  return t;
}

// Linear Rec.709 to the reference space, ACES2065-1.
ocio::TransformRcPtr rec709_to_reference() {
  ocio::GroupTransformRcPtr group = ocio::GroupTransform::Create();
  group->appendTransform(builtin("UTILITY - ACES-AP1_to_LINEAR-REC709_BFD", ocio::TRANSFORM_DIR_INVERSE));
  group->appendTransform(builtin("ACEScg_to_ACES2065-1"));
  return group;
}

// Reference space to linear Rec.709, then a curve: views that are a curve on Rec.709 values.
ocio::TransformRcPtr reference_to_curve(const ocio::TransformRcPtr& curve) {
  ocio::GroupTransformRcPtr group = ocio::GroupTransform::Create();
  group->appendTransform(builtin("ACEScg_to_ACES2065-1", ocio::TRANSFORM_DIR_INVERSE));
  group->appendTransform(builtin("UTILITY - ACES-AP1_to_LINEAR-REC709_BFD"));
  group->appendTransform(curve);
  return group;
}

ocio::TransformRcPtr reference_to_aces_sdr() {
  ocio::GroupTransformRcPtr group = ocio::GroupTransform::Create();
  group->appendTransform(builtin("ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0"));
  group->appendTransform(builtin("DISPLAY - CIE-XYZ-D65_to_sRGB"));
  return group;
}

void add_space(const ocio::ConfigRcPtr& config, const char* name, const ocio::TransformRcPtr& transform,
               ocio::ColorSpaceDirection direction) {
  ocio::ColorSpaceRcPtr space = ocio::ColorSpace::Create();
  space->setName(name);
  if (transform) space->setTransform(transform, direction);
  config->addColorSpace(space);
}

}  // namespace

ocio::ConstConfigRcPtr make_builtin_config(float exposure) {
  const ocio::ConfigRcPtr config = ocio::Config::Create()->createEditableCopy();
  config->setVersion(2, 1);
  const auto from_reference = ocio::COLORSPACE_DIR_FROM_REFERENCE;
  add_space(config, "ACES2065-1", nullptr, from_reference);
  add_space(config, "Linear Rec.709", rec709_to_reference(), ocio::COLORSPACE_DIR_TO_REFERENCE);
  add_space(config, "sRGB", reference_to_curve(half_domain_table(srgb_encode)), from_reference);
  add_space(config, "sRGB - ACES SDR", reference_to_aces_sdr(), from_reference);
  add_space(config, "sRGB - exposure", reference_to_curve(exposure_curve(exposure)), from_reference);
  config->setRole(ocio::ROLE_SCENE_LINEAR, "Linear Rec.709");
  config->setRole(ocio::ROLE_DEFAULT, "Linear Rec.709");
  config->addDisplayView("sRGB", "sRGB", "sRGB", "");
  config->addDisplayView("sRGB", "ACES SDR", "sRGB - ACES SDR", "");
  config->addDisplayView("sRGB", "exposure", "sRGB - exposure", "");
  config->setActiveDisplays("sRGB");
  config->setActiveViews("sRGB, ACES SDR, exposure");
  config->validate();
  return config;
}

}  // namespace whit
