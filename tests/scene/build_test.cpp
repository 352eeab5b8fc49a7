// What building a scene says, and in what order, whatever thread was first.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/scene/scene_text.h"

namespace whit {
namespace {

/// What building `world` reports, as the user sees it.
std::string said_of(const std::string& world) {
  test::Planned planned("WorldBegin\nLightSource \"point\"\n" + world + "\nWorldEnd\n");
  const BuiltWorld built = build_world(std::move(planned.world));
  EXPECT_TRUE(built.scene);
  std::string text;
  for (const Diagnostic& d : built.said.all()) text += planned.sources.render_diagnostic(d, false);
  return text;
}

TEST(Build, MaxdepthMayBeZeroOrLess) {
  // pbrt's path integrator counts from 0, converters write -1 for no limit: both are one round for pbrt's whitted.
  for (const char* depth : {"0", "-1"}) {
    const test::Planned planned("Integrator \"whitted\" \"integer maxdepth\" " + std::string(depth) +
                                "\nWorldBegin WorldEnd\n");
    ASSERT_TRUE(planned.bound.integrator.plugin);
    EXPECT_EQ(planned.bound.integrator.plugin->max_depth(), 1);
  }
}

TEST(Build, DegenerateTrianglesOfAllShapesAreSaidOnce) {
  // One triangle with area, and one with two corners alike.
  const std::string mesh =
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 1 1] \"point P\" [-1 -1 0  1 -1 0  1 1 0] Translate 0 0 1\n";
  EXPECT_EQ(said_of("Shape \"sphere\""), "");
  EXPECT_NE(said_of(mesh).find("test.pbrt:3:1: warning: 1 degenerate triangle (no area, or repeated)\n"),
            std::string::npos)
      << said_of(mesh);
  const std::string said = said_of("Shape \"sphere\"\n" + mesh + mesh + "ObjectBegin \"o\"\n" + mesh +
                                   "ObjectEnd ObjectInstance \"o\" ObjectInstance \"o\"");
  EXPECT_EQ(
      said.find("test.pbrt:4:1: warning: 3 degenerate triangles (no area, or repeated) in 3 shapes, the first here\n"),
      0u)
      << said;
  EXPECT_EQ(said.find("warning", 30), std::string::npos) << said;
}

TEST(Build, ShapesKeepTheOrderOfTheFile) {
  // The i-th mesh has i + 1 triangles, and as many without area.
  constexpr size_t kCount = 200;
  std::string text = "WorldBegin\n";
  for (size_t i = 0; i < kCount; ++i) {
    text += "Translate 0 0 1 Shape \"trianglemesh\" \"point P\" [";
    for (size_t k = 0; k <= i + 2; ++k) text += fmt::format("{} {} 0 ", k, k * k);  // a parabola: no three on a line
    text += "] \"integer indices\" [";
    for (size_t k = 0; k <= i; ++k) text += fmt::format("0 {} {} 0 0 1 ", k + 1, k + 2);
    text += "]\n";
  }
  test::Planned planned(text + "WorldEnd\n");
  const BuiltWorld built = build_world(std::move(planned.world));
  const Diagnostics& said = built.said;
  const Scene* const scene = built.scene.get();
  ASSERT_TRUE(scene);
  ASSERT_EQ(scene->shapes.size(), kCount);
  for (size_t i = 0; i < kCount; ++i) {
    EXPECT_EQ(scene->shapes[i].mesh->triangle_count(), i + 1);
    EXPECT_EQ(scene->shapes[i].mesh, scene->meshes[i].get());
  }
  ASSERT_EQ(said.all().size(), 1u);
  EXPECT_EQ(said.all()[0].message,
            fmt::format("{} degenerate triangles (no area, or repeated) in {} shapes, the first here",
                        kCount * (kCount + 1) / 2, kCount));
  EXPECT_EQ(planned.sources.place(said.all()[0].where).line, 2u);
}

}  // namespace
}  // namespace whit
