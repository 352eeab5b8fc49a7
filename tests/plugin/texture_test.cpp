// Mappings, the textures made of them, and bump mapping.
#include "core/plugin/texture.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <limits>

#include "core/image/texture_store.h"
#include "core/image/write.h"
#include "core/plugin/bump.h"
#include "core/plugin/material.h"
#include "core/plugin/registry.h"
#include "plugins/shared/texture_mapping.h"
#include "tests/base/temp_folder.h"
#include "tests/plugin/shading_points.h"
#include "tests/plugins/make_plugin.h"

namespace whit {
namespace {

using test::make_plugin;
using test::ShadingPoints;

/// A bound and prepared float texture.
test::Made<Texture<float>> make_texture(const char* name, ParameterList parameters, const Mat4d& to_world = Mat4d(),
                                        const RenderSpace& space = {}) {
  auto made = make_plugin<Texture<float>>("float texture", name, std::move(parameters));
  EXPECT_TRUE(made.silent()) << name;
  made->texture_to_world = to_world;
  PrepareContext ctx;
  ctx.space = space;
  EXPECT_TRUE(made.prepare(ctx));
  return made;
}

std::vector<float> values(const Texture<float>& texture, const ShadingBatch& s) {
  std::vector<float> out(s.n);
  texture.evaluate(s, out.data());
  return out;
}

Parameter string_choice(const char* name, const char* value) { return test::text(name, value); }

TEST(Mapping, UvScalesAndShifts) {
  // uv as colours: red = frac(2 u + 0.25), green = frac(v).
  auto uv = make_plugin<Texture<RGB>>("spectrum texture", "uv",
                                      {test::floats("uscale", {2}), test::floats("udelta", {0.25})});
  ASSERT_TRUE(uv.silent());
  uv.prepare();
  ShadingPoints points(1);
  points.set_flat(0, 0.5f, -0.25f);
  const RGBLanes out = points.arena.rgb(1);
  uv->evaluate(points.s, out);
  EXPECT_EQ(out[0], RGB(0.25f, 0.75f, 0));
}

TEST(Mapping, AMatrixTurnsTextureCoordinatesAndTheirFootprints) {
  // KHR_texture_transform's example: a rotation by 90 degrees, here (u, v) -> (v, 1 - u), scaled by 2 and shifted by 0.5
  // along s after that. At (0.3, 0.2) that is (2 * 0.2 + 0.5, 0.7) = (0.9, 0.7).
  auto uv = make_plugin<Texture<RGB>>(
      "spectrum texture", "uv",
      {test::floats("uvmatrix", {0, 1, 0, -1, 0, 1}), test::floats("uscale", {2}), test::floats("udelta", {0.5})});
  ASSERT_TRUE(uv.silent());
  uv.prepare();
  ShadingPoints points(1);
  points.set_flat(0, 0.3f, 0.2f);
  RGBLanes out = points.arena.rgb(1);
  uv->evaluate(points.s, out);
  EXPECT_NEAR(out[0].x, 0.9f, 1e-6f);
  EXPECT_NEAR(out[0].y, 0.7f, 1e-6f);
  // A matrix without turns is the scales and shifts, to the bit.
  points.randomise(3);
  auto plain = make_plugin<Texture<RGB>>("spectrum texture", "uv",
                                         {test::floats("uscale", {3}), test::floats("vscale", {-0.7}),
                                          test::floats("udelta", {0.1}), test::floats("vdelta", {0.3})});
  auto matrix =
      make_plugin<Texture<RGB>>("spectrum texture", "uv", {test::floats("uvmatrix", {3, 0, 0.1, 0, -0.7, 0.3})});
  plain.prepare(), matrix.prepare();
  RGBLanes other = points.arena.rgb(1);
  plain->evaluate(points.s, out), matrix->evaluate(points.s, other);
  EXPECT_NEAR(out[0].x, other[0].x, 1e-6f);
  EXPECT_EQ(out[0].y, other[0].y);
  // Six numbers or none.
  EXPECT_FALSE(make_plugin<Texture<RGB>>("spectrum texture", "uv", {test::floats("uvmatrix", {1, 0, 0, 1})}).good());
}

TEST(Mapping, FootprintsTurnWithTheMatrix) {
  TextureMapping2D map;
  map.su = 0.5f, map.s_of_v = 2, map.t_of_u = -3, map.sv = 0.25f, map.turns = true;
  ShadingPoints points(1);
  points.set_flat(0, 0.1f, 0.2f);
  points.set_footprint(0, 0.01f, 0.02f, -0.03f, 0.04f);
  const MappedPoints m = map.map(points.s);
  EXPECT_FLOAT_EQ(m.dsdx[0], 0.5f * 0.01f + 2 * 0.02f);
  EXPECT_FLOAT_EQ(m.dtdx[0], -3 * 0.01f + 0.25f * 0.02f);
  EXPECT_FLOAT_EQ(m.dsdy[0], 0.5f * -0.03f + 2 * 0.04f);
  EXPECT_FLOAT_EQ(m.dtdy[0], -3 * -0.03f + 0.25f * 0.04f);
}

/// What the bilerp texture with v01 = 0, v10 = v11 = 1 gives is s; with v01 = v11 = 1, t.
std::vector<float> mapped(const char* which, const char* mapping, ShadingPoints& points, const Mat4d& to_world = {},
                          const RenderSpace& space = {}, ParameterList more = {}) {
  const bool s = which[0] == 's';
  more.push_back(test::floats("v01", {s ? 0.0 : 1.0}));
  more.push_back(test::floats("v10", {s ? 1.0 : 0.0}));
  more.push_back(string_choice("mapping", mapping));
  return values(*make_texture("bilerp", std::move(more), to_world, space).plugin, points.s);
}

TEST(Mapping, SphericalIsThetaAndPhi) {
  ShadingPoints points(3);
  points.s.p.set(0, {2, 0, 0}), points.s.p.set(1, {0, -3, 0}), points.s.p.set(2, {0, 0, -1});
  const auto s = mapped("s", "spherical", points), t = mapped("t", "spherical", points);
  EXPECT_NEAR(s[0], 0.5, 1e-6);
  EXPECT_NEAR(s[1], 0.5, 1e-6);
  EXPECT_NEAR(s[2], 1, 1e-6);
  EXPECT_NEAR(t[0], 0, 1e-6);
  EXPECT_NEAR(t[1], 0.75, 1e-6);
}

TEST(Mapping, CylindricalTakesTheNormalisedHeight) {
  ShadingPoints points(2);
  points.s.p.set(0, {3, 0, 4}), points.s.p.set(1, {0, 1, 0});
  const auto s = mapped("s", "cylindrical", points), t = mapped("t", "cylindrical", points);
  EXPECT_NEAR(s[0], 0.5, 1e-6);
  EXPECT_NEAR(s[1], 0.75, 1e-6);
  EXPECT_NEAR(t[0], 0.8, 1e-6);
  EXPECT_NEAR(t[1], 0, 1e-6);
}

TEST(Mapping, PlanarIgnoresTheCtmButNotTheShift) {
  ShadingPoints points(1);
  points.s.p.set(0, {1, 2, 3});
  Mat4d moved;
  moved.setTranslation(Vec3d(100, 0, 0));
  const ParameterList more = {test::parameter(ParamType::Vector3, "v1", std::vector<double>{0, 0, 0.5}),
                              test::floats("udelta", {0.25})};
  EXPECT_NEAR(mapped("s", "planar", points, moved, {}, more)[0], 0.5 * 3 + 0.25, 1e-6);
  EXPECT_NEAR(mapped("t", "planar", points, moved, {}, more)[0], 2, 1e-6);
}

TEST(Mapping, RenderSpaceChangesNothing) {
  // A texture at a sphere's place, a million units away: the same as at the origin, to float.
  ShadingPoints here(50), there(50);
  here.randomise(4), there.randomise(4);
  const RenderSpace space{{1e6, -2e6, 3e6}, 0.25};
  Mat4d to_world;
  to_world.setTranslation(Vec3d(1e6, -2e6, 3e6));
  for (int i = 0; i < 50; ++i) there.s.p.set(i, here.s.p[i] * 0.25f);
  for (const char* mapping : {"spherical", "cylindrical"}) {
    const auto a = mapped("s", mapping, here), b = mapped("s", mapping, there, to_world, space);
    for (int i = 0; i < 50; ++i) EXPECT_NEAR(a[i], b[i], 1e-6) << mapping;
  }
}

TEST(Mapping, DerivativesAreThoseOfTheMapping) {
  // Against central differences of the mapping itself, at a point away from the seam.
  ShadingPoints points(1);
  points.s.p.set(0, {1, 2, 0.5f});
  points.s.dpdx.set(0, {0.01f, 0, 0}), points.s.dpdy.set(0, {0, 0.01f, 0.02f});
  TextureMapping2D m;
  for (const auto kind : {TextureMapping2D::Spherical, TextureMapping2D::Cylindrical}) {
    m.kind = kind;
    const MappedPoints at = m.map(points.s);
    ShadingPoints moved(2);
    moved.s.p.set(0, points.s.p[0] + points.s.dpdy[0] * 0.5f),
        moved.s.p.set(1, points.s.p[0] - points.s.dpdy[0] * 0.5f);
    const MappedPoints ends = m.map(moved.s);
    EXPECT_NEAR(at.dsdy[0], ends.s[0] - ends.s[1], 2e-4);
    EXPECT_NEAR(at.dtdy[0], ends.t[0] - ends.t[1], 2e-4);
  }
  ShadingPoints without(1, /*footprint=*/false);
  EXPECT_EQ(m.map(without.s).dsdx, nullptr);
}

TEST(Checkerboard, PointSampled) {
  ShadingPoints points(4, /*footprint=*/false);
  points.set_flat(0, 0.5f, 0.5f), points.set_flat(1, 1.5f, 0.5f), points.set_flat(2, -0.5f, 0.5f),
      points.set_flat(3, -0.5f, -0.5f);
  const auto v = values(*make_texture("checkerboard", {}).plugin, points.s);
  EXPECT_EQ(v, (std::vector<float>{1, 0, 0, 1}));
}

TEST(Checkerboard, FiltersByItsIntegral) {
  ShadingPoints points(5);
  // Half widths 0.25 around s = 1: half odd in s, all even in t.
  points.set_flat(0, 1, 0.5f), points.set_footprint(0, 0.25f, 0, 0, 0.1f);
  // Around s = 1.1: [0.85, 1.35] has 0.35 of 0.5 odd.
  points.set_flat(1, 1.1f, 0.5f), points.set_footprint(1, 0.25f, 0, 0, 0.1f);
  // Wider than a cell: one half.
  points.set_flat(2, 1.1f, 0.5f), points.set_footprint(2, 1.25f, 0, 0, 0.1f);
  // Within a cell.
  points.set_flat(3, 0.5f, 0.5f), points.set_footprint(3, 0.25f, 0, 0, 0.25f);
  // Across an edge in t only, with no width in s, in an odd column: pbrt divides 0 by 0 here.
  points.set_flat(4, 1.5f, 1), points.set_footprint(4, 0, 0.25f, 0, 0.1f);
  const auto v = values(*make_texture("checkerboard", {}).plugin, points.s);
  EXPECT_NEAR(v[0], 0.5, 1e-6);
  EXPECT_NEAR(v[1], 1 - 0.7, 1e-6);
  EXPECT_NEAR(v[2], 0.5, 1e-6);
  EXPECT_EQ(v[3], 1);
  EXPECT_NEAR(v[4], 0.5, 1e-6);
}

TEST(Checkerboard, TheMeanWhereCoordinatesAreBeyondNumbers) {
  // Found by the mutator: "uv" of 1e38 by a "uscale" of 24 is infinite, and so is the footprint. pbrt-v3 finds no cell that
  // holds it, and takes the mean of both, which a silent black is not.
  const float infinity = std::numeric_limits<float>::infinity();
  ShadingPoints points(2);
  points.set_flat(0, infinity, 0.5f), points.set_footprint(0, infinity, 0, 0, 0.1f);
  points.set_flat(1, infinity, 0.5f), points.set_footprint(1, 3e38f, 0, 0, 0.1f);
  EXPECT_EQ(values(*make_texture("checkerboard", {}).plugin, points.s), (std::vector<float>{0.5f, 0.5f}));
}

TEST(Checkerboard, InThreeDimensionsTheCtmItselfIsApplied) {
  // pbrt-v3's IdentityMapping3D takes texture-to-world for world-to-texture: Scale 2 makes cells of one half.
  ShadingPoints points(2);
  points.s.p.set(0, {0.6f, 0.1f, 0.1f}), points.s.p.set(1, {0.4f, 0.1f, 0.1f});
  Mat4d twice;
  twice.setScale(2.0);
  const auto v = values(*make_texture("checkerboard", {test::integer("dimension", 3)}, twice).plugin, points.s);
  EXPECT_EQ(v, (std::vector<float>{0, 1}));
}

TEST(Textures, FoldWhenConstant) {
  const auto constant = [](const char* name, ParameterList list) {
    return make_plugin<Texture<float>>("float texture", name, std::move(list))->constant();
  };
  EXPECT_EQ(constant("constant", {test::floats("value", {3})}), 3.0f);
  EXPECT_EQ(constant("scale", {test::floats("tex1", {3}), test::floats("tex2", {2})}), 6.0f);
  EXPECT_EQ(constant("mix", {test::floats("tex1", {3}), test::floats("tex2", {5}), test::floats("amount", {0.25})}),
            3.5f);
  EXPECT_EQ(constant("checkerboard", {}), std::nullopt);
  EXPECT_EQ(constant("checkerboard", {test::floats("tex2", {1})}), 1.0f);
  EXPECT_EQ(constant("bilerp", {}), std::nullopt);
  EXPECT_EQ(constant("bilerp", {test::floats("v01", {0}), test::floats("v11", {0})}), 0.0f);
}

TEST(Textures, FilteringIsCalledForOnlyWhereItChangesTheResult) {
  const auto filters = [](ParameterList list) {
    return make_plugin<Texture<float>>("float texture", "checkerboard", std::move(list))
        ->effects()
        .has(Effect::TextureFiltering);
  };
  EXPECT_TRUE(filters({}));
  EXPECT_FALSE(filters({string_choice("aamode", "none")}));
  EXPECT_FALSE(filters({test::integer("dimension", 3)}));
}

TEST(Textures, ImagemapNeedsItsFile) {
  EXPECT_TRUE(make_plugin<Texture<RGB>>("spectrum texture", "imagemap").diagnostics.has_errors());
  const auto missing =
      make_plugin<Texture<RGB>>("spectrum texture", "imagemap", {test::text("filename", "/missing.png")});
  ASSERT_TRUE(missing.diagnostics.has_errors());
  EXPECT_EQ(missing.diagnostics.all()[0].message, "cannot open /missing.png");
}

TEST(Textures, ImagemapIsReadWhenARayMeetsIt) {
  // Two by two texels, top row first: the bottom row is t = 0. A lookup at a texel's centre gives the texel.
  const std::string path = test::temp_folder() + "/whit_imagemap_test.pfm";
  const std::vector<float> rgb = {3, 3, 3, 4, 4, 4, 1, 1, 1, 2, 2, 2};
  OutputImage picture;
  picture.width = picture.height = 2, picture.rgb = rgb;
  ASSERT_TRUE(write_image(path, picture).ok());
  auto map = make_plugin<Texture<float>>("float texture", "imagemap",
                                         {test::text("filename", path), test::floats("scale", {10})});
  ASSERT_TRUE(map.silent());
  TextureStore store;
  PrepareContext ctx;
  ctx.textures = &store;
  ASSERT_TRUE(map.prepare(ctx));
  EXPECT_EQ(store.statistics().decodes, 0);
  ShadingPoints points(4, /*footprint=*/false);
  for (int i = 0; i < 4; ++i) points.set_flat(i, i % 2 == 0 ? 0.25f : 0.75f, i < 2 ? 0.25f : 0.75f);
  const auto v = values(*map.plugin, points.s);
  EXPECT_EQ(store.statistics().decodes, 1);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(v[i], 10 * (i + 1), 1e-3) << i;
  EXPECT_TRUE(map->effects().has(Effect::TextureFiltering));
}

TEST(ImageMap, TakesAPictureThatIsAttached) {
  // The bytes of a file, as a model holds them, in place of a name: the same values.
  const std::string path = test::temp_folder() + "/attached.png";
  const std::vector<float> rgb{0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f, 0.7f, 0.8f, 0.9f, 1, 0, 0.5f};
  OutputImage image;
  image.width = image.height = 2, image.rgb = rgb;
  ASSERT_EQ(write_image(path, image).error, "");
  std::ifstream file(path, std::ios::binary);
  const std::string all(std::istreambuf_iterator<char>(file), {});
  const auto make = [&](std::shared_ptr<const PictureBytes> bytes, ParameterList parameters, Diagnostics& said) {
    const PluginInfo* info = find_plugin("float texture", "imagemap");
    std::shared_ptr<Plugin> plugin(info->make());
    plugin->attach(bytes);
    BindContext ctx;
    ctx.diagnostics = &said;
    EXPECT_TRUE(bind_parameters(*info, *plugin, parameters, ctx));
    plugin->check(said, {});
    return std::dynamic_pointer_cast<Texture<float>>(plugin);
  };
  const auto in_memory = [&](size_t size) {
    auto bytes = std::make_shared<PictureBytes>();
    bytes->name = "model.glb: /images/0";
    bytes->bytes = {reinterpret_cast<const uint8_t*>(all.data()), size};
    return bytes;
  };
  TextureStore store;
  PrepareContext ctx;
  ctx.textures = &store;
  Diagnostics said;
  ctx.diagnostics = &said;
  auto attached =
      prepared(after_reading(make(in_memory(all.size()), {string_choice("channel", "green")}, said), said, {}), ctx);
  EXPECT_FALSE(make_plugin<Texture<float>>("float texture", "imagemap").good());
  ASSERT_TRUE(attached);
  EXPECT_TRUE(said.all().empty());
  ShadingPoints points(1, false);
  points.set_flat(0, 0.25f, 0.75f);
  // Green of the upper left pixel: ((0.2 + 0.055) / 1.055)^2.4, for png is sRGB.
  EXPECT_NEAR(values(*attached, points.s)[0], 0.0331048f, 1e-6f);
  // Not a picture: an error that says whose.
  EXPECT_FALSE(after_reading(make(in_memory(10), {}, said), said, {}));
  ASSERT_EQ(said.all().size(), 1u);
  EXPECT_NE(said.all()[0].message.find("model.glb: /images/0"), std::string::npos);
}

TEST(Angle, IsThatOfTheDirection) {
  const auto degrees = [](double x, double y, double offset) {
    return *make_plugin<Texture<float>>(
                "float texture", "angle",
                {test::floats("x", {x}), test::floats("y", {y}), test::floats("offset", {offset})})
                ->constant();
  };
  EXPECT_NEAR(degrees(1, 0.5, 0), 0, 1e-5f);              // (1, 0)
  EXPECT_NEAR(degrees(0.5, 1, 0), 90, 1e-4f);             // (0, 1)
  EXPECT_NEAR(degrees(0, 0, 10), -125, 1e-4f);            // (-1, -1): -135 degrees
  EXPECT_NEAR(degrees(0.75, 0.933012702, 0), 60, 1e-4f);  // (1/2, sqrt(3)/2)
}

TEST(Threshold, IsOneFromTheEdgeOn) {
  // bilerp of 0 and 1 along u is u itself.
  const auto ramp = [](double edge, double u) {
    auto texture = make_plugin<Texture<float>>("float texture", "threshold",
                                               {test::floats("value", {u}), test::floats("edge", {edge})});
    EXPECT_TRUE(texture.silent());
    return *texture->constant();
  };
  EXPECT_EQ(ramp(0.5, 0.5), 1);
  EXPECT_EQ(ramp(0.5, 0.49), 0);
  EXPECT_EQ(ramp(0.25, 0.3), 1);
  EXPECT_EQ(*make_plugin<Texture<float>>("float texture", "threshold")->constant(), 1);
}

TEST(VertexColor, IsTheMeshsOrOne) {
  const std::pair<const char*, float> channels[] = {
      {"alpha", 0.3f}, {"red", 0.1f}, {"green", 0.5f}, {"blue", 0.9f}, {"luminance", luminance(RGB(0.1f, 0.5f, 0.9f))}};
  auto colours = make_plugin<Texture<RGB>>("spectrum texture", "vertexcolor");
  ASSERT_TRUE(colours.silent());
  EXPECT_TRUE(colours->attributes_read().colors);
  ShadingPoints points(1);
  const RGBLanes out = points.arena.rgb(1);
  colours->evaluate(points.s, out);
  EXPECT_EQ(out[0], RGB(1.0f));
  for (const auto& [channel, expected] : channels)
    EXPECT_EQ(values(*make_texture("vertexcolor", {string_choice("channel", channel)}).plugin, points.s)[0], 1);
  points.s.color = points.arena.rgb(1), points.s.color_alpha = points.arena.floats(1);
  points.s.color.set(0, {0.1f, 0.5f, 0.9f}), points.s.color_alpha[0] = 0.3f;
  colours->evaluate(points.s, out);
  EXPECT_EQ(out[0], RGB(0.1f, 0.5f, 0.9f));
  for (const auto& [channel, expected] : channels)
    EXPECT_EQ(values(*make_texture("vertexcolor", {string_choice("channel", channel)}).plugin, points.s)[0], expected);
  EXPECT_EQ(values(*make_texture("vertexcolor", {}).plugin, points.s)[0], 0.3f);
}

TEST(EveryTexture, BatchOfNEqualsNBatchesOfOne) {
  for (const PluginInfo* info : list_plugins("float texture")) {
    if (info->name == "imagemap") continue;  // needs a file; tests/image covers its lookups
    for (const char* mapping : {"uv", "spherical", "cylindrical", "planar"}) {
      ParameterList list;
      if (info->find_param("mapping")) list.push_back(string_choice("mapping", mapping));
      const auto texture = make_texture(info->name.c_str(), list);
      ShadingPoints points(61);
      points.randomise(1);
      const auto together = values(*texture.plugin, points.s);
      std::vector<float> alone;
      for (int i = 0; i < points.s.n; ++i) alone.push_back(values(*texture.plugin, points.s.range(i, 1))[0]);
      EXPECT_EQ(std::memcmp(together.data(), alone.data(), together.size() * sizeof(float)), 0) << info->name;
    }
  }
}

/// A displacement d = slope . p in scene units.
class Slope : public Texture<float> {
 public:
  Slope(Vec3f slope, float scale) : slope_(slope * (1 / scale)) {}
  void evaluate(const ShadingBatch& s, float* const& out) const override {
    for (int i = 0; i < s.n; ++i) out[i] = dot(slope_, s.p[i]);
  }

 private:
  Vec3f slope_;
};

TEST(Bump, TiltsTheNormalByTheSlope) {
  // z = 0.5 x: the normal is (-0.5, 0, 1) normalised, whatever the scale of render space, with and without footprints.
  for (const float scale : {1.0f, 0.125f, 64.0f}) {
    for (const bool footprint : {true, false}) {
      ShadingPoints points(1, footprint);
      points.set_footprint(0, 0.01f, 0.01f, 0, 0);
      apply_bump(Tex<float>(std::make_shared<Slope>(Vec3f(0.5f, 0, 0), scale)), scale, points.s);
      const Vec3f expected = normalize(Vec3f(-0.5f, 0, 1));
      EXPECT_NEAR(length(points.s.ns[0] - expected), 0, 1e-3) << scale;
      EXPECT_NEAR(points.s.dpdu.z[0], 0.5, 1e-3);
      EXPECT_NEAR(points.s.dpdv.z[0], 0, 1e-3);
    }
  }
}

TEST(Bump, RaisesACurvedSurfaceByItsDisplacement) {
  // A sphere of radius 1 with n = p, dn/du = dp/du, raised by d = 0.25: its tangents grow by a quarter.
  ShadingPoints points(1);
  points.s.p.set(0, {0, 0, 1}), points.s.dndu.set(0, {1, 0, 0}), points.s.dndv.set(0, {0, 1, 0});
  class Flat : public Texture<float> {
   public:
    void evaluate(const ShadingBatch& s, float* const& out) const override {
      for (int i = 0; i < s.n; ++i) out[i] = 0.25f;
    }
  };
  apply_bump(Tex<float>(std::make_shared<Flat>()), 1, points.s);
  EXPECT_NEAR(points.s.dpdu.x[0], 1.25, 1e-6);
  EXPECT_EQ(points.s.ns[0], Vec3f(0, 0, 1));
}

/// A colour that is the same everywhere, but does not say so.
struct Everywhere : Texture<RGB> {
  explicit Everywhere(RGB c) : colour(c) {}
  void evaluate(const ShadingBatch& s, const RGBLanes& out) const override {
    for (int i = 0; i < s.n; ++i) out.set(i, colour);
  }
  RGB colour;
};

/// The points under a normal map of one colour.
void map_normals(RGB colour, float scale, ShadingPoints& points) {
  apply_normal_map(Tex<RGB>(std::make_shared<Everywhere>(colour)), scale, points.s);
}

TEST(NormalMap, IsAVectorAroundTangentBitangentAndNormal) {
  // 2 (0.8, 0.3, 0.9) - 1 = (0.6, -0.4, 0.8), along a tangent of any length and a bitangent that is on the other side.
  for (const float side : {1.0f, -1.0f}) {
    ShadingPoints points(1);
    points.s.dpdu.set(0, {0, 3, 0}), points.s.dpdv.set(0, {-0.1f * side, 0, 0});
    map_normals({0.8f, 0.3f, 0.9f}, 1, points);
    EXPECT_NEAR(length(points.s.ns[0] - normalize(Vec3f(0.4f * side, 0.6f, 0.8f))), 0, 1e-6);
    EXPECT_NEAR(dot(points.s.ns[0], points.s.dpdu[0]), 0, 1e-6);
    EXPECT_NEAR(dot(points.s.ns[0], points.s.dpdv[0]), 0, 1e-6);
  }
}

TEST(NormalMap, ScaleIsThatOfTheFirstTwoComponents) {
  ShadingPoints points(1);
  map_normals({1, 0.5f, 1}, 0.5f, points);
  EXPECT_NEAR(length(points.s.ns[0] - normalize(Vec3f(0.5f, 0, 1))), 0, 1e-6);
}

TEST(NormalMap, FlatColourChangesNothing) {
  ShadingPoints points(64), before(64);
  points.randomise(3), before.randomise(3);
  map_normals(Material::kFlatNormal, 1, points);
  for (int i = 0; i < points.s.n; ++i) EXPECT_NEAR(length(points.s.ns[i] - before.s.ns[i]), 0, 2e-6);
}

TEST(NormalMap, StaysAboveTheSurface) {
  // (1, 0, -0.6) would be seen from below; it is lifted until its cosine is 0.001 of the geometric normal.
  ShadingPoints points(1);
  map_normals({1, 0.5f, 0.2f}, 1, points);
  EXPECT_NEAR(length(points.s.ns[0] - Vec3f(1, 0, 1e-3f * std::sqrt(1 + 0.36f))), 0, 1e-3);
  EXPECT_GT(points.s.ns.z[0], 0);
  points.set_flat(0, 0, 0);
  points.s.ng.set(0, {0, 0, -1}), points.s.ns.set(0, {0, 0, -1});
  map_normals({1, 0.5f, 0.2f}, 1, points);
  EXPECT_LT(points.s.ns.z[0], 0);
}

TEST(NormalMap, WithoutTangentsOrNumbersTheNormalStays) {
  ShadingPoints points(2);
  points.s.dpdu.set(0, {0, 0, 0}), points.s.dpdv.set(0, {0, 0, 0});
  map_normals({1, 0.5f, 1}, 1, points);
  EXPECT_EQ(points.s.ns[0], Vec3f(0, 0, 1));
  points.set_flat(1, 0, 0);
  map_normals(RGB(std::numeric_limits<float>::quiet_NaN()), 1, points);
  EXPECT_EQ(points.s.ns[1], Vec3f(0, 0, 1));
}

TEST(Bump, StaysOnTheSideOfTheGeometricNormal) {
  ShadingPoints points(1);
  points.s.ng.set(0, {0, 0, -1}), points.s.ns.set(0, {0, 0, -1});
  apply_bump(Tex<float>(std::make_shared<Slope>(Vec3f(0.5f, 0, 0), 1.0f)), 1, points.s);
  // The displacement goes along ns = -z, so that z = -0.5 x, seen from below.
  EXPECT_NEAR(length(points.s.ns[0] - normalize(Vec3f(-0.5f, 0, -1))), 0, 1e-3);
}

}  // namespace
}  // namespace whit
