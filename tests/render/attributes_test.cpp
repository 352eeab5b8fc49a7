// What vertices have beside: a second set of texture coordinates, colours, the side of bitangents.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/render/render.h"
#include "core/render/surface.h"
#include "tests/base/temp_folder.h"
#include "tests/scene/scene_text.h"

namespace whit {
namespace {

/// A file with the square from (0,0,0) to (size,size,0). `of_vertex` gives the rest of the line of a vertex at (x, y) of
/// the unit square, for `properties`.
template <class OfVertex>
std::string square(const std::string& name, const std::vector<std::string>& properties, const OfVertex& of_vertex,
                   double size = 1) {
  const std::string path = fmt::format("{}/{}.ply", test::temp_folder(), name);
  std::ofstream file(path);
  file << "ply\nformat ascii 1.0\nelement vertex 4\n";
  for (const char* p : {"x", "y", "z"}) file << "property float " << p << "\n";
  for (const std::string& p : properties) file << "property float " << p << "\n";
  file << "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
  for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
    file << fmt::format("{} {} 0 {}\n", size * x, size * y, of_vertex(x, y));
  file << "3 0 1 2\n3 0 2 3\n";
  return "Shape \"plymesh\" \"string filename\" \"" + path + "\" ";
}

/// (u, v) = (x, y), (u1, v1) = (0.25 + y / 2, 1 - x), colour (x, y, 0.5), alpha (x + y) / 2.
std::string everything() {
  return square("everything", {"u", "v", "u1", "v1", "red", "green", "blue", "alpha"}, [](int x, int y) {
    return fmt::format("{} {} {} {} {} {} 0.5 {}", x, y, 0.25 + 0.5 * y, 1 - x, x, y, 0.5 * (x + y));
  });
}

/// A ray straight down at (x, y), its neighbours a bit to the right and up, and the surface it meets.
struct Hit {
  Arena arena;
  ShadingBatch s;
  static constexpr double kStep = 0.01;

  Hit(const Scene& scene, double x, double y) {
    const Mat4d m = scene.space.from_world();
    const auto set = [&](Vec3Lanes& lanes, const Vec3d& v) { lanes = arena.vec3(1), lanes.set(0, Vec3f(v)); };
    SurfaceHits h;
    h.n = 1;
    Vec3Lanes right, up;
    set(h.o, transform_point(m, Vec3d(x, y, 9))), set(h.d, {0, 0, -1});
    set(right, transform_point(m, Vec3d(x + kStep, y, 9))), set(up, transform_point(m, Vec3d(x, y + kStep, 9)));
    h.t = arena.floats(1), h.u = arena.floats(1), h.v = arena.floats(1);
    h.shape = arena.alloc<int32_t>(1), h.instance = arena.alloc<int32_t>(1), h.prim = arena.alloc<uint32_t>(1);
    h.differentials = {right, h.d, up, h.d};
    scene.accel->intersect({1, h.o, h.d, nullptr, nullptr}, {h.t, h.shape, h.prim, h.instance, h.u, h.v}, false);
    if (h.shape[0] < 0) throw std::runtime_error("a miss");
    s = compute_surfaces(scene, h, arena);
  }
};

std::string looked_at(const std::string& world) {
  return "Film \"image\" \"integer xresolution\" 24 \"integer yresolution\" 24\nSampler \"halton\" \"integer "
         "pixelsamples\" "
         "4\nLookAt 0.5 0.5 3  0.5 0.5 0  0 1 0\nCamera \"perspective\" \"float fov\" 30\nWorldBegin\nLightSource "
         "\"distant\" \"point from\" [0.3 0.2 1] \"point to\" [0 0 0]\n" +
         world + "\nWorldEnd\n";
}

const std::string kSecond =
    "Texture \"t\" \"spectrum\" \"uv\" \"integer uvset\" 1\nMaterial \"matte\" \"texture Kd\" \"t\"\n";
const std::string kColoured = "Texture \"t\" \"spectrum\" \"vertexcolor\"\nMaterial \"matte\" \"texture Kd\" \"t\"\n";

TEST(MeshAttributes, AreInterpolatedWithTheirFootprints) {
  const test::BuiltScene built(looked_at(kSecond + everything()));
  const auto& scene = *built.scene;
  EXPECT_EQ(scene.attributes, (MeshAttributes{true, false}));
  for (const auto& [x, y] : {std::pair{0.7, 0.2}, {0.2, 0.7}}) {  // one in each triangle
    const Hit hit(scene, x, y);
    EXPECT_NEAR(hit.s.u1[0], 0.25 + 0.5 * y, 1e-6);
    EXPECT_NEAR(hit.s.v1[0], 1 - x, 1e-6);
    // u1 grows by half of y, v1 falls with x; (u, v) are (x, y) themselves.
    EXPECT_NEAR(hit.s.du1du[0], 0, 1e-5);
    EXPECT_NEAR(hit.s.dv1du[0], -1, 1e-5);
    EXPECT_NEAR(hit.s.du1dv[0], 0.5, 1e-5);
    EXPECT_NEAR(hit.s.dv1dv[0], 0, 1e-5);
    EXPECT_NEAR(hit.s.du1dx[0], 0, 1e-6);
    EXPECT_NEAR(hit.s.dv1dx[0], -Hit::kStep, 1e-5);
    EXPECT_NEAR(hit.s.du1dy[0], 0.5 * Hit::kStep, 1e-5);
    EXPECT_NEAR(hit.s.dv1dy[0], 0, 1e-6);
    EXPECT_FALSE(hit.s.color);
  }
  const test::BuiltScene coloured(looked_at(kColoured + everything()));
  const Hit hit(*coloured.scene, 0.7, 0.2);
  EXPECT_NEAR(hit.s.color.r[0], 0.7, 1e-6);
  EXPECT_NEAR(hit.s.color.g[0], 0.2, 1e-6);
  EXPECT_NEAR(hit.s.color.b[0], 0.5, 1e-6);  // 0.5 of each corner: the weights add up to 1 but for rounding
  EXPECT_NEAR(hit.s.color_alpha[0], 0.45, 1e-6);
  EXPECT_EQ(hit.s.u1, nullptr);
}

TEST(MeshAttributes, CostNothingWhereNobodyAsksOrNoMeshHasThem) {
  const std::string first = "Texture \"t\" \"spectrum\" \"uv\"\nMaterial \"matte\" \"texture Kd\" \"t\"\n";
  const std::string plain = square("plain", {"u", "v"}, [](int x, int y) { return fmt::format("{} {}", x, y); });
  for (const std::string& world : {first + everything(), kSecond + plain, kColoured + plain,
                                   // asked for by a texture that nobody wears
                                   kSecond + "Material \"matte\"\n" + everything()}) {
    const test::BuiltScene built(looked_at(world));
    EXPECT_EQ(built.scene->attributes, MeshAttributes{}) << world;
    const Hit hit(*built.scene, 0.7, 0.2);
    EXPECT_FALSE(hit.s.u1 || hit.s.du1du || hit.s.du1dx || hit.s.color || hit.s.color_alpha);
    for (const auto& mesh : built.scene->meshes) EXPECT_TRUE(mesh->uvs1.empty() && mesh->colors.empty());
  }
}

TEST(MeshAttributes, OfShapesThatHaveNoneAreTheFirstSetAndWhite) {
  const std::string both =
      "Texture \"t\" \"spectrum\" \"uv\" \"integer uvset\" 1\nTexture \"c\" \"spectrum\" "
      "\"vertexcolor\"\nMaterial \"matte\" \"texture Kd\" \"t\"\nAttributeBegin Translate 5 0 0 Material "
      "\"matte\" \"texture Kd\" \"c\"\n" +
      everything() + "AttributeEnd\n";
  for (const std::string& shape :
       {square("plain", {"u", "v"}, [](int x, int y) { return fmt::format("{} {}", x, y); }),
        std::string("Translate 0.5 0.5 0 Shape \"sphere\" \"float radius\" 0.5"),
        std::string("Shape \"curve\" \"point P\" [0.7 0 0 0.7 0.3 0 0.7 0.6 0 0.7 1 0] \"float width\" 0.5")}) {
    const test::BuiltScene built(looked_at(both + shape));
    const Hit hit(*built.scene, 0.7, 0.2);
    EXPECT_EQ(hit.s.u1[0], hit.s.u[0]);
    EXPECT_EQ(hit.s.v1[0], hit.s.v[0]);
    EXPECT_EQ(hit.s.du1dx[0], hit.s.dudx[0]);
    EXPECT_EQ(hit.s.dv1dy[0], hit.s.dvdy[0]);
    EXPECT_EQ(hit.s.color[0], RGB(1.0f));
    EXPECT_EQ(hit.s.color_alpha[0], 1.0f);
  }
}

std::vector<float> picture(const std::string& world) {
  const test::BuiltScene built(looked_at(world), {}, test::Planned::Warnings::Allowed);
  return render(*built.scene, {}).picture.rgb;
}

void expect_alike(const std::vector<float>& a, const std::vector<float>& b, double tolerance, const std::string& what) {
  double difference = 0, sum = 0;
  for (size_t i = 0; i < a.size(); ++i) difference += std::abs(a[i] - b[i]), sum += a[i];
  EXPECT_GT(sum, 10) << what;
  EXPECT_LE(difference, tolerance * sum) << what;
}

TEST(MeshAttributes, ASecondSetIsAsGoodAsAFirst) {
  // The same coordinates as the first set of one mesh and as the second of another, whose first is of no use. Evaluated for
  // surfaces and for rays, placed, moving, and as one huge mesh with corners in double.
  const auto uv = [](int x, int y) { return fmt::format("{} {}", 0.1 + 0.7 * x, 0.2 + 0.9 * y - 0.3 * x); };
  const auto first = [&](double size) { return square("first", {"u", "v"}, uv, size); };
  const auto second = [&](double size) {
    return square(
        "second", {"u", "v", "u1", "v1"}, [&](int x, int y) { return fmt::format("{} {} ", 9 - y, 2 * x) + uv(x, y); },
        size);
  };
  const std::string checks =
      "Texture \"t\" \"spectrum\" \"{}\" \"float uscale\" 5 \"float vscale\" 4 \"integer uvset\" "
      "{} {}\nMaterial \"matte\" \"texture Kd\" \"t\"\n";
  const std::string mask = "Texture \"a\" \"float\" \"checkerboard\" \"float uscale\" 5 \"integer uvset\" {}\n";
  struct Case {
    const char *name, *before, *after;
    double size;
  };
  for (const Case& c : {Case{"plain", "", "", 1},
                        {"mirrored", "Translate 1 0 0 Scale -1 1 1 ", "", 1},
                        {"placed", "ObjectBegin \"o\"\n", "\nObjectEnd\nRotate 20 0 0 1 ObjectInstance \"o\"", 1},
                        {"moving", "ActiveTransform EndTime Translate 0.2 0 0 ActiveTransform All\n", "", 1},
                        {"huge", "Translate -5e5 -5e5 -1 Shape \"sphere\" \"float radius\" 0.1\n", "", 1e6}}) {
    for (const char* kind : {"uv", "checkerboard"}) {
      const std::string more = *kind == 'u' ? "" : "\"string aamode\" \"closedform\"";
      const auto world = [&](int set) {
        return fmt::format(fmt::runtime(checks), kind, set, more) + fmt::format(fmt::runtime(mask), set) + c.before +
               (set == 0 ? first(c.size) : second(c.size)) + (*kind == 'u' ? "" : "\"texture alpha\" \"a\" ") + c.after;
      };
      // Unfiltered the same numbers, but for roundings of the point where corners are in double; the footprints are computed
      // otherwise.
      const double tolerance = *kind != 'u' ? 1e-3 : c.size > 1 ? 1e-5 : 0;
      expect_alike(picture(world(0)), picture(world(1)), tolerance, std::string(c.name) + ' ' + kind);
    }
  }
}

TEST(MeshAttributes, BumpMapsFollowTheSecondSet) {
  const std::string bump =
      "Texture \"w\" \"float\" \"bilerp\" \"integer uvset\" {} \"float v00\" 0 \"float v01\" 0.1 \"float "
      "v10\" 0.3 \"float v11\" 0.9\nMaterial \"matte\" \"texture bumpmap\" \"w\"\n";
  const std::string mesh =
      square("same", {"u", "v", "u1", "v1"}, [](int x, int y) { return fmt::format("{0} {1} {0} {1}", x, y); });
  const auto one = picture(fmt::format(fmt::runtime(bump), 0) + mesh),
             two = picture(fmt::format(fmt::runtime(bump), 1) + mesh);
  expect_alike(one, two, 1e-4, "bump");
  const auto flat = picture("Material \"matte\"\n" + mesh);
  double change = 0;
  for (size_t i = 0; i < flat.size(); ++i) change += std::abs(flat[i] - two[i]);
  EXPECT_GT(change, 1);
}

TEST(MeshAttributes, ColoursCutAndColour) {
  // Alpha (x + y) / 2 against an edge of 0.5 leaves the half above the diagonal; and the second set, 1 where 0.25 + y / 2 is
  // 0.5 or more, the upper half. Pixels on the rim of the square and of the cut have shares.
  const std::string white = "Material \"matte\" \"rgb Kd\" [1 1 1]\n";
  const auto sum_of = [](const std::vector<float>& rgb) {
    double sum = 0;
    for (const float v : rgb) sum += v;
    return sum;
  };
  const double whole = sum_of(picture(white + everything()));
  const std::string by_alpha = "Texture \"v\" \"float\" \"vertexcolor\"\n",
                    by_uv =
                        "Texture \"v\" \"float\" \"bilerp\" \"integer uvset\" 1 \"float v00\" 0 \"float v01\" 0 "
                        "\"float v10\" 1 \"float v11\" 1\n";
  for (const std::string& value : {by_alpha, by_uv}) {
    const std::string mask = "Texture \"m\" \"float\" \"threshold\" \"texture value\" \"v\"\n";
    const double cut = sum_of(picture(value + mask + white + everything() + "\"texture alpha\" \"m\""));
    EXPECT_NEAR(cut / whole, 0.5, 0.03) << value;
  }
  // Red grows with x from 0 to 1, to the left of the picture, and green with y.
  const auto coloured = picture(kColoured + everything());
  const auto at = [&](int x, int y) {
    return RGB(coloured[3 * (24 * y + x)], coloured[3 * (24 * y + x) + 1], coloured[3 * (24 * y + x) + 2]);
  };
  const RGB low = at(16, 12), high = at(7, 12);
  EXPECT_GT(high.x, 3 * low.x);
  EXPECT_NEAR(high.y, low.y, 0.02f * low.y);
  EXPECT_NEAR(high.z, low.z, 0.02f * low.z);
}

TEST(MeshAttributes, BitangentsAreOnTheSideOfTheirSign) {
  // Normal z, tangent x: cross(n, t) = y. With a sign of -1 it is -y. Without signs it is as in pbrt, which has both turned
  // around: -x and -y. A mirroring of y takes the bitangent along with the surface.
  const auto mesh = [](const char* sign) {
    const bool has = *sign != '\0';
    std::vector<std::string> properties{"nx", "ny", "nz", "tx", "ty", "tz"};
    if (has) properties.push_back("tw");
    return square("tangents", properties, [&](int, int) { return std::string("0 0 1 2 0 0 ") + sign; });
  };
  struct Case {
    const char *placement, *sign;
    float y;
  };
  for (const Case& c : {Case{"", "1", 1},
                        {"", "-1", -1},
                        {"", "", -1},
                        {"ReverseOrientation ", "1", 1},
                        {"Translate 0 1 0 Scale 1 -1 1 ", "1", -1},
                        {"Translate 0 1 0 Scale 1 -1 1 ", "-1", 1}}) {
    const test::BuiltScene built(looked_at(c.placement + mesh(c.sign)));
    const Hit hit(*built.scene, 0.4, 0.3);
    const Vec3f t = hit.s.dpdu[0].normalized(), b = hit.s.dpdv[0].normalized();
    EXPECT_NEAR((t - Vec3f(*c.sign == '\0' ? -1 : 1, 0, 0)).length(), 0, 1e-6) << c.placement << c.sign;
    EXPECT_NEAR((b - Vec3f(0, c.y, 0)).length(), 0, 1e-6) << c.placement << c.sign;
    const test::BuiltScene placed(
        looked_at("ObjectBegin \"o\"\n" + mesh(c.sign) + "\nObjectEnd\n" + c.placement + "ObjectInstance \"o\""));
    if (*c.placement == 'R') continue;  // is the shape's business
    const Hit instance(*placed.scene, 0.4, 0.3);
    // pbrt's own bitangent is made before the placement and mirrored with it.
    EXPECT_NEAR(instance.s.dpdv[0].normalized().y, c.y, 1e-6) << c.placement << c.sign;
  }
}

TEST(MeshAttributes, NormalMapsGoWhereTextureCoordinatesAndTangentsGo) {
  // p = (u, v, 0): dpdu is x and dpdv is y, with given normals or without, where a normal map asks; elsewhere given normals
  // turn both around, as in pbrt. Where v goes down, dpdv does. A tangent along -x has its bitangent cross(z, -x) = -y.
  struct Case {
    std::vector<std::string> properties;
    const char* of_vertex;
    double u, v;
  };
  const std::vector<std::string> uv{"u", "v"}, normals{"u", "v", "nx", "ny", "nz"},
      tangents{"u", "v", "nx", "ny", "nz", "tx", "ty", "tz"};
  for (const Case& c : {Case{uv, "{0} {1}", 1, 1},
                        {normals, "{0} {1} 0 0 1", 1, 1},
                        {normals, "{0} -{1} 0 0 1", 1, -1},
                        {tangents, "{0} {1} 0 0 1 -1 0 0", -1, -1}}) {
    const auto partials = [&](const char* material) {
      const std::string mesh = square("normal_map", c.properties,
                                      [&](int x, int y) { return fmt::format(fmt::runtime(c.of_vertex), x, y); });
      const test::BuiltScene built(looked_at(std::string(material) + mesh));
      const Hit hit(*built.scene, 0.4, 0.3);
      return std::pair(hit.s.dpdu[0].normalized(), hit.s.dpdv[0].normalized());
    };
    const auto [u, v] = partials("Material \"metallicroughness\" \"rgb normalmap\" [0.6 0.5 1]\n");
    EXPECT_NEAR((u - Vec3f(static_cast<float>(c.u), 0, 0)).length(), 0, 1e-6) << c.of_vertex;
    EXPECT_NEAR((v - Vec3f(0, static_cast<float>(c.v), 0)).length(), 0, 1e-6) << c.of_vertex;
    if (c.properties.size() == 2) continue;
    const auto [as_pbrt, other] = partials("Material \"metallicroughness\"\n");
    EXPECT_NEAR(as_pbrt.x, -c.u, 1e-6) << c.of_vertex;
  }
}

}  // namespace
}  // namespace whit
