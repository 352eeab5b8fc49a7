#include "core/color/to_linear.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <string>

namespace whit {
namespace {

float decoded(const std::string& space, float value) {
  const ToLinearResult result = make_to_linear(space);
  EXPECT_EQ(result.error, "");
  std::array<float, 1> r{value}, g{value}, b{value};
  if (result.transform) result.transform(r, g, b);
  EXPECT_EQ(r[0], g[0]);
  EXPECT_EQ(r[0], b[0]);
  return r[0];
}

TEST(ToLinear, Curves) {
  EXPECT_EQ(decoded("linear", 0.3f), 0.3f);
  // IEC 61966-2-1: 0.03 / 12.92, ((0.5 + 0.055) / 1.055)^2.4.
  EXPECT_NEAR(decoded("sRGB", 0.03f), 0.00232198f, 1e-8);
  EXPECT_NEAR(decoded("srgb", 0.5f), 0.21404114f, 1e-7);
  // ITU-R BT.709: 0.05 / 4.5, ((0.5 + 0.099) / 1.099)^(1 / 0.45).
  EXPECT_NEAR(decoded("Rec709", 0.05f), 0.01111111f, 1e-8);
  EXPECT_NEAR(decoded("REC709", 0.5f), 0.2595894f, 1e-6);
  EXPECT_NEAR(decoded("gamma=2", 0.5f), 0.25f, 1e-7);
  EXPECT_NEAR(decoded("Gamma2.2", 0.5f), 0.21763764f, 1e-7);  // As OpenImageIO spells it.
  // What is below 0 is the mirror image.
  EXPECT_EQ(decoded("sRGB", -0.5f), -decoded("sRGB", 0.5f));
}

TEST(ToLinear, UnknownSpacesNameThoseThereAre) {
  ::unsetenv("OCIO");
  for (const char* space : {"nonsense", "", "gamma=", "gamma=0", "gamma=x"}) {
    const std::string error = make_to_linear(space).error;
    EXPECT_NE(error.find("there are linear, sRGB, Rec709, gamma=2.2, and those of the config that $OCIO names"),
              std::string::npos)
        << error;
  }
}

TEST(ToLinear, SpacesOfAConfig) {
  // A space whose numbers are half of the light's.
  const std::string path = testing::TempDir() + "to_linear.ocio";
  std::ofstream(path) << "ocio_profile_version: 2\nroles:\n  scene_linear: light\n  default: light\n"
                         "displays:\n  d:\n    - !<View> {name: v, colorspace: light}\n"
                         "colorspaces:\n  - !<ColorSpace>\n    name: light\n"
                         "  - !<ColorSpace>\n    name: Halved\n    to_scene_reference: !<MatrixTransform> {matrix: "
                         "[2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]}\n";
  ::setenv("OCIO", path.c_str(), 1);
  EXPECT_NEAR(decoded("Halved", 0.25f), 0.5f, 1e-6);
  EXPECT_NE(make_to_linear("Doubled").error.find("light, Halved"), std::string::npos);
  ::setenv("OCIO", "/nowhere.ocio", 1);
  EXPECT_NE(make_to_linear("Halved").error.find("OpenColorIO"), std::string::npos);
  ::unsetenv("OCIO");
}

}  // namespace
}  // namespace whit
