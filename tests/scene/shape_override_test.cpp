// Material parameters on a Shape statement, which win over the material's own.
#include <gtest/gtest.h>

#include "tests/scene/scene_text.h"

namespace whit {
namespace {

using test::Planned;

/// How many of the scene's textures the material of its only shape asks for.
size_t textures_of(const std::string& material, const std::string& shape) {
  const Planned planned(
      "WorldBegin\nTexture \"t\" \"spectrum\" \"bilerp\" Texture \"u\" \"spectrum\" \"uv\"\n"
      "Material \"matte\" " +
      material + "\nShape \"sphere\" " + shape + "\nWorldEnd\n");
  const BoundScene& bound = planned.bound;
  return bound.materials.at(static_cast<size_t>(bound.shape_material.at(0))).textures.size();
}

TEST(ShapeOverride, AValueOfTheShapeWinsOverATextureOfTheMaterial) {
  EXPECT_EQ(textures_of("\"texture Kd\" \"t\"", ""), 1u);
  EXPECT_EQ(textures_of("\"texture Kd\" \"t\"", "\"rgb Kd\" [1 0 0]"), 0u);
}

TEST(ShapeOverride, ATextureWinsOverAValueOfTheSameStatement) {
  EXPECT_EQ(textures_of("\"texture Kd\" \"t\" \"rgb Kd\" [1 0 0]", "\"float sigma\" 1"), 1u);
  EXPECT_EQ(textures_of("\"rgb Kd\" [1 0 0]", "\"rgb Kd\" [1 0 0] \"texture Kd\" \"u\""), 1u);
}

}  // namespace
}  // namespace whit
