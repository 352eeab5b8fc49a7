// Surface interaction: derivatives and normals of triangles and spheres that can be written down, and the offset of rays.
#include "core/render/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/render/render.h"
#include "tests/scene/scene_text.h"

namespace whit {
namespace {

/// One ray through a built scene, in world space, and the surface it meets.
struct Hit {
  Arena arena;
  ShadingBatch s;
  Mat4d to_world;
  double scale;

  Hit(const Scene& scene, const Vec3d& from, const Vec3d& to)
      : to_world(scene.space.to_world()), scale(scene.space.scale) {
    const Mat4d m = scene.space.from_world();
    SurfaceHits h;
    h.n = 1;
    h.o = arena.vec3(1), h.d = arena.vec3(1);
    h.t = arena.floats(1), h.u = arena.floats(1), h.v = arena.floats(1);
    h.shape = arena.alloc<int32_t>(1), h.instance = arena.alloc<int32_t>(1), h.prim = arena.alloc<uint32_t>(1);
    h.o.set(0, Vec3f(transform_point(m, from)));
    h.d.set(0, Vec3f((to - from).normalized()));
    h.differentials = {h.o, h.d, h.o, h.d};
    scene.accel->intersect({1, h.o, h.d, nullptr, nullptr}, {h.t, h.shape, h.prim, h.instance, h.u, h.v}, false);
    if (h.shape[0] < 0) throw std::runtime_error("a miss");
    s = compute_surfaces(scene, h, arena);
  }
  Vec3d p() const { return transform_point(to_world, Vec3d(s.p[0])); }
  Vec3d dpdu() const { return Vec3d(s.dpdu[0]) / scale; }
  Vec3d dpdv() const { return Vec3d(s.dpdv[0]) / scale; }
  Vec3d p_error() const { return Vec3d(s.p_error[0]) / scale; }
};

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance, const char* what) {
  EXPECT_LE((a - b).length(), tolerance) << what << ": (" << a.x << ", " << a.y << ", " << a.z << ") for (" << b.x
                                         << ", " << b.y << ", " << b.z << ")";
}

std::string scene(const std::string& shape) {
  return "LookAt 0 0 10  0 0 0  0 1 0\nCamera \"perspective\"\nWorldBegin\n" + shape + "\nWorldEnd\n";
}

TEST(Surface, TriangleDerivativesComeFromItsTextureCoordinates) {
  // p(u, v) = (2 u, 3 v, 0): with uv (0,0), (1,0), (0,1) at (0,0,0), (2,0,0), (0,3,0), dp/du = (2,0,0), dp/dv = (0,3,0).
  const std::string mesh = "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 0  2 0 0  0 3 0] ";
  const test::BuiltScene built(scene(mesh + "\"float uv\" [0 0  1 0  0 1]"));
  const Hit hit(*built.scene, {0.5, 0.75, 9}, {0.5, 0.75, 0});
  expect_near(hit.p(), {0.5, 0.75, 0}, 1e-6, "p");
  expect_near(hit.dpdu(), {2, 0, 0}, 1e-5, "dpdu");
  expect_near(hit.dpdv(), {0, 3, 0}, 1e-5, "dpdv");
  expect_near(Vec3d(hit.s.ng[0]), {0, 0, 1}, 1e-6, "ng");
  expect_near(Vec3d(hit.s.wo[0]), {0, 0, 1}, 1e-6, "wo");
  EXPECT_NEAR(hit.s.u[0], 0.25, 1e-6);
  EXPECT_NEAR(hit.s.v[0], 0.25, 1e-6);
  // pbrt's default coordinates (0,0), (1,0), (1,1): p = (2 (u - v), 3 v, 0).
  const test::BuiltScene plain(scene(mesh));
  const Hit other(*plain.scene, {0.5, 0.75, 9}, {0.5, 0.75, 0});
  expect_near(other.dpdu(), {2, 0, 0}, 1e-5, "dpdu");
  expect_near(other.dpdv(), {-2, 3, 0}, 1e-5, "dpdv");
}

TEST(Surface, TheNormalIsThatOfTheCornersOrderAndFlips) {
  const std::string mesh = "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [-1 -1 0  1 -1 0  0 1 0]";
  const std::pair<const char*, double> cases[] = {{"", 1},
                                                  {"ReverseOrientation ", -1},
                                                  {"Scale -1 1 1 ", 1},
                                                  {"Scale 1 1 -1 ", -1},
                                                  {"Scale -1 1 1 ReverseOrientation ", -1}};
  for (const auto& [placement, z] : cases) {
    const test::BuiltScene built(scene(placement + mesh));
    const Hit hit(*built.scene, {0, 0, 9}, {0, 0, 0});
    expect_near(Vec3d(hit.s.ng[0]), {0, 0, z}, 1e-6, placement);
    expect_near(Vec3d(hit.s.ns[0]), {0, 0, z}, 1e-6, placement);
  }
}

TEST(Surface, GivenNormalsAreMirroredAndFlipByReverseOrientationAlone) {
  // pbrt-v3 transforms them with the points and takes no notice of handedness; the geometric normal follows to their side,
  // whatever the corners' order.
  for (const char* order : {"0 1 2", "2 1 0"}) {
    const std::string mesh = "Shape \"trianglemesh\" \"integer indices\" [" + std::string(order) +
                             "] \"point P\" [-1 -1 0  1 -1 0  0 1 0] \"normal N\" [0 0 1  0 0 1  0 0 1]";
    const std::pair<const char*, double> cases[] = {{"", 1},
                                                    {"ReverseOrientation ", -1},
                                                    {"Scale -1 1 1 ", 1},
                                                    {"Scale 1 1 -1 ", -1},
                                                    {"Scale -1 1 1 ReverseOrientation ", -1}};
    for (const auto& [placement, z] : cases) {
      const test::BuiltScene built(scene(placement + mesh));
      const Hit hit(*built.scene, {0, 0, 9}, {0, 0, 0});
      expect_near(Vec3d(hit.s.ng[0]), {0, 0, z}, 1e-6, placement);
      expect_near(Vec3d(hit.s.ns[0]), {0, 0, z}, 1e-6, placement);
    }
  }
}

TEST(Surface, AnalyticNormalsFlipBeforeTheyAreTransformed) {
  // pbrt-v3: a sphere's points outwards, a curve's along the ray (dpdu x dpdv, dpdv being across both). Mirrored ones
  // point the other way, and moving ones, which it makes without their transform, flip by ReverseOrientation alone.
  const std::string moving = "ActiveTransform EndTime Translate 0 0 1e-3 ActiveTransform All ";
  const std::string curve = "Shape \"curve\" \"float width\" 2 \"point P\" [-2 0 0  -1 0 0  1 0 0  2 0 0]";
  for (const auto& [shape, front] : {std::pair<std::string, double>("Shape \"sphere\"", 1), {curve, -1}}) {
    const std::pair<std::string, double> cases[] = {{"", 1},
                                                    {"ReverseOrientation ", -1},
                                                    {"Scale -1 1 1 ", -1},
                                                    {"Scale 1 1 -1 ReverseOrientation ", 1},
                                                    {moving, 1},
                                                    {"Scale -1 1 1 " + moving, 1},
                                                    {"ReverseOrientation Scale -1 1 1 " + moving, -1}};
    for (const auto& [placement, z] : cases) {
      const test::BuiltScene built(scene(placement + shape));
      const Hit hit(*built.scene, {0, 0, 9}, {0, 0, 0});
      expect_near(Vec3d(hit.s.ng[0]), {0, 0, z * front}, 1e-5, (placement + shape).c_str());
    }
  }
}

TEST(Surface, SphereDerivatives) {
  // pbrt's sphere: p = r (sin t cos f, sin t sin f, cos t), f = 2 pi u, t = pi - pi v (v from bottom to top). So
  // dp/du = 2 pi (-y, x, 0) and dp/dv = pi (z cos f, z sin f, -r sin t) * -1 * -1: with dt/dv = -pi,
  // dp/dv = -pi r (cos t cos f, cos t sin f, -sin t) = pi (-z cos f, -z sin f, r sin t).
  const double r = 2, theta = 1.1, phi = 0.7;
  const Vec3d p = Vec3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)) * r;
  const test::BuiltScene built(scene("Shape \"sphere\" \"float radius\" 2"));
  const Hit hit(*built.scene, p * 3.0, {0, 0, 0});
  expect_near(hit.p(), p, 1e-5, "p");
  EXPECT_NEAR(hit.s.u[0], phi / (2 * M_PI), 1e-6);
  EXPECT_NEAR(hit.s.v[0], 1 - theta / M_PI, 1e-6);
  expect_near(hit.dpdu(), Vec3d(-p.y, p.x, 0) * (2 * M_PI), 1e-4, "dpdu");
  expect_near(hit.dpdv(), Vec3d(-p.z * std::cos(phi), -p.z * std::sin(phi), r * std::sin(theta)) * M_PI, 1e-4, "dpdv");
  expect_near(Vec3d(hit.s.ng[0]), p / r, 1e-6, "ng");
}

TEST(Surface, TangentsOfInterpolatedNormalsAreOneWorldUnitLong) {
  // As in pbrt-v3, which bump maps are measured against. Whatever else is in the scene chooses the scale of render space;
  // an instance stretches its tangents.
  const std::string mesh =
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 0  2 0 0  0 3 0] \"normal N\" [0 0 1  0 0 1 "
      " "
      "0 0 1] \"float uv\" [0 0  1 0  0 1] ";
  const std::string far = " AttributeBegin Translate 0 0 -5000 Shape \"sphere\" AttributeEnd";
  const std::string object = "ObjectBegin \"o\" " + mesh + " ObjectEnd Scale 3 3 3 ObjectInstance \"o\"";
  for (const auto& [text, length] : {std::pair(mesh, 1.0), std::pair(mesh + far, 1.0), std::pair(object, 3.0)}) {
    const test::BuiltScene built(scene(text));
    const Hit hit(*built.scene, {0.5, 0.75, 9}, {0.5, 0.75, 0});
    EXPECT_NEAR(hit.dpdu().length(), length, 1e-6) << text;
    EXPECT_NEAR(hit.dpdv().length(), length, 1e-6) << text;
  }
}

TEST(Surface, NormalsTurnAsTheSurfaceBends) {
  // The unit normal of a sphere of radius r is p / r, so its derivatives are those of p over r: however the sphere is
  // placed, and -p / r where it is turned inside out. On the squeezed one, p = S q with S = diag(1, 1, 1/2) and q on the unit
  // sphere, n = S^-1 q / |S^-1 q|; at q = (1, 0, 0) dn = (S^-1 dq) across n, with dq = S^-1 dp: (0, dy, 4 dz).
  const std::string ball = "Shape \"sphere\" ", object = "ObjectBegin \"o\" Scale .1 .1 .1 " + ball + "ObjectEnd ";
  struct Case {
    std::string text;
    double r;
  };
  for (const Case& c : {Case{ball, 1},
                        {"Scale 4 4 4 " + ball, 4},
                        {"Rotate 50 1 2 3 Scale 0.2 0.2 0.2 " + ball, 0.2},
                        {ball + "AttributeBegin Translate 0 0 -9000 " + ball + "AttributeEnd", 1},
                        {object + "Rotate 70 3 2 1 Scale 7 7 7 ObjectInstance \"o\"", 0.7},
                        {"ReverseOrientation " + ball, -1},
                        {"Scale -2 2 2 " + ball, -2}}) {
    const test::BuiltScene built(scene(c.text));
    const Hit hit(*built.scene, Vec3d(2, 3, 4) * std::abs(c.r), {0, 0, 0});
    expect_near(Vec3d(hit.s.dndu[0]), hit.dpdu() / c.r, 1e-5, c.text.c_str());
    expect_near(Vec3d(hit.s.dndv[0]), hit.dpdv() / c.r, 1e-5, c.text.c_str());
  }
  const test::BuiltScene built(scene("Scale 1 1 0.5 Shape \"sphere\""));
  const Hit hit(*built.scene, {3, 0, 0}, {0, 0, 0});
  expect_near(Vec3d(hit.s.dndu[0]), {0, hit.dpdu().y, 4 * hit.dpdu().z}, 1e-5, "squeezed");
  expect_near(Vec3d(hit.s.dndv[0]), {0, hit.dpdv().y, 4 * hit.dpdv().z}, 1e-5, "squeezed");
}

TEST(Surface, InterpolatedNormalsTurnLikeUnitVectors) {
  // Normals (-1, 0, 1) and (1, 0, 1) at x = -1 and 1 add up to (x, 0, 1): the angle atan x to the z axis turns by
  // 1 / (1 + x^2), along (1, 0, -x) / sqrt(1 + x^2). With u = (x + 1) / 2 dn/du is twice that. Lengths do not matter, nor
  // does scale; placed twice as large, x is half of the world's.
  const std::string mesh =
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0] "
      "\"float uv\" [0 0  1 0  1 1  0 1] \"normal N\" [-3 0 3  3 0 3  3 0 3  -3 0 3] ";
  const std::string object = "ObjectBegin \"o\" Translate 0 0 0 " + mesh + "ObjectEnd ";
  for (const std::string& text : {mesh, "Scale 2 2 2 " + mesh, object + "Scale 2 2 2 ObjectInstance \"o\"",
                                  mesh + "Translate 0 0 -9000 Shape \"sphere\""}) {
    const double x = text.find("Scale") == std::string::npos ? 0.5 : 0.25, turn = 2 / (1 + x * x);
    const test::BuiltScene built(scene(text));
    const Hit hit(*built.scene, {0.5, 0.2, 9}, {0.5, 0.2, 0});
    expect_near(Vec3d(hit.s.dndu[0]), Vec3d(1, 0, -x) * (turn / std::sqrt(1 + x * x)), 1e-5, text.c_str());
    expect_near(Vec3d(hit.s.dndv[0]), {0, 0, 0}, 1e-5, text.c_str());
  }
}

TEST(Surface, InstancesCarryPointsAndNormals) {
  // The plane x + y = 1 of the object, normal (1,1,0); under Scale 2 1 1 its normal is (1,2,0) (inverse transpose), and the
  // point (0.5, 0.5, 0) comes to (1, 0.5, 0), moved by (3, 0, 0).
  const test::BuiltScene built(
      scene("ObjectBegin \"o\" Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [1 0 -1  0 1 -1  0.5 0.5 "
            "2] ObjectEnd\n"
            "Translate 3 0 0 Scale 2 1 1 ObjectInstance \"o\""));
  const Hit hit(*built.scene, {9, 0.5, 0}, {4, 0.5, 0});
  expect_near(hit.p(), {4, 0.5, 0}, 1e-5, "p");
  const Vec3d n = Vec3d(hit.s.ng[0]);
  EXPECT_NEAR(std::abs(n.dot(Vec3d(1, 2, 0).normalized())), 1, 1e-6);
}

TEST(Surface, PointsAreWithinTheirErrorOfTheSurface) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const test::BuiltScene built(scene("Translate 100 -50 7 Scale 1 2 3 Shape \"sphere\""));
  for (int i = 0; i < 200; ++i) {
    const Vec3d d = Vec3d(normal(random), normal(random), normal(random)).normalized();
    const Hit hit(*built.scene, Vec3d(100, -50, 7) + d * 30.0, {100, -50, 7});
    const Vec3d p = hit.p() - Vec3d(100, -50, 7);
    const Vec3d object(p.x, p.y / 2, p.z / 3);
    // To first order |f(p)| <= grad f . error, f = |object|^2 - 1, grad f = 2 (x, y / 2, z / 3).
    const Vec3d e = hit.p_error();
    const double bound = 2 * (std::abs(object.x) * e.x + std::abs(object.y) * e.y / 2 + std::abs(object.z) * e.z / 3);
    EXPECT_LE(std::abs(object.length2() - 1), bound);
    EXPECT_LT(bound, 1e-3);
  }
}

TEST(OffsetOrigin, MovesToTheSideOfTheDirectionBeyondTheError) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> signed_unit(-1, 1);
  const auto vector = [&] { return Vec3f(signed_unit(random), signed_unit(random), signed_unit(random)); };
  for (int i = 0; i < 1000; ++i) {
    const Vec3f n = vector().normalized(), w = vector();
    const Vec3f p = vector() * std::pow(10.0f, 6 * signed_unit(random));
    const Vec3f error = Vec3f(std::abs(p.x), std::abs(p.y), std::abs(p.z)) * 1e-6f;
    if (std::abs(n.dot(w)) < 1e-3f) continue;
    const Vec3d moved = Vec3d(offset_origin(p, error, n, w)) - Vec3d(p);
    const double along = moved.dot(Vec3d(n)) * (n.dot(w) > 0 ? 1 : -1);
    // Any point within the error of p lies at most n . error from p's plane.
    const double needed = std::abs(n.x) * error.x + std::abs(n.y) * error.y + std::abs(n.z) * error.z;
    EXPECT_GE(along, needed * (1 - 1e-6));
    EXPECT_LE(along, 2 * needed + 1e-30);
  }
}

/// A ball on a floor, a mirror and an area light, all moved by `far`, camera included.
std::string small_scene(const std::string& far) {
  return "Film \"image\" \"integer xresolution\" 64 \"integer yresolution\" 48\nSampler \"halton\" \"integer "
         "pixelsamples\" 4\n"
         "LookAt 0 2 6  0 0.5 0  0 1 0\n" +
         far + "Camera \"perspective\" \"float fov\" 40\nWorldBegin\n" + far + R"(
  LightSource "point" "point from" [2 4 3] "rgb I" [20 20 20]
  AttributeBegin AreaLightSource "diffuse" "rgb L" [5 5 5] Translate -2 3 0 Rotate 180 1 0 0 Shape "disk" AttributeEnd
  Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-5 0 -5  -5 0 5  5 0 5  5 0 -5]
  Translate -0.8 0.5 0  Material "plastic" Shape "sphere" "float radius" 0.5
  Translate 1.6 0 0  Material "mirror" Shape "sphere" "float radius" 0.5
WorldEnd
)";
}

TEST(Surface, AFarAwaySceneGivesTheSamePicture) {
  // The world moves by (1e6, -2e6, 1e6), and the camera with it: what it sees is the same to 2e6 * 2^-53, 2e-10 of a unit.
  // Floats in world space would be 0.125 apart there.
  const auto picture = [](const test::BuiltScene& built) { return render(*built.scene, {}).picture.rgb; };
  const auto near = picture(test::BuiltScene(small_scene("")));
  const std::string to = "Translate 1e6 -2e6 1e6\n";
  std::string text = small_scene(to);
  const size_t camera = text.find(to);
  text.replace(camera, to.size(), "Translate -1e6 2e6 -1e6\n");
  const auto far = picture(test::BuiltScene(text));
  ASSERT_EQ(near.size(), far.size());
  double mean = 0, error = 0;
  for (float v : near) mean += v;
  mean /= static_cast<double>(near.size());
  EXPECT_GT(mean, 0.05);
  for (size_t i = 0; i < near.size(); ++i) {
    const double d = static_cast<double>(far[i]) - near[i];
    error += d * d / (static_cast<double>(near[i]) * near[i] + 0.01 * mean * mean);
  }
  EXPECT_LE(error / static_cast<double>(near.size()), 1e-6);
}

TEST(Surface, FootprintsFollowAStretchedCamera) {
  // A camera space twice as wide and high shows half of each: the picture of a screen window of half the size, and as
  // sharply filtered.
  const auto picture = [](const std::string& camera) {
    const test::BuiltScene built(
        "Film \"image\" \"integer xresolution\" 32 \"integer yresolution\" 32\n"
        "Sampler \"halton\" \"integer pixelsamples\" 16\n" +
        camera + R"(
WorldBegin
  LightSource "distant" "point from" [0 1 0] "point to" [0 0 0]
  Texture "checks" "spectrum" "checkerboard" "float uscale" 100 "float vscale" 100
  Material "matte" "texture Kd" "checks"
  Translate 0 -1 0
  Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-50 0 0  50 0 0  50 0 100  -50 0 100] "float uv" [0 0 1 0 1 1 0 1]
WorldEnd
)");
    return render(*built.scene, {}).picture.rgb;
  };
  const auto window = picture("Camera \"perspective\" \"float screenwindow\" [-.5 .5 -.5 .5]");
  const auto stretched = picture("Scale 2 2 1 Camera \"perspective\"");
  ASSERT_EQ(window.size(), stretched.size());
  double difference = 0, sum = 0;
  for (size_t i = 0; i < window.size(); ++i) {
    difference += std::abs(stretched[i] - window[i]);
    sum += window[i];
  }
  // What is left is of second order in the angle of a pixel, 0.05.
  EXPECT_LT(difference / sum, 2e-3);
}

TEST(Surface, AnObjectFarAwayChangesNothing) {
  // It changes the scale of render space, by a power of two. What depends on lengths stays: a bump map on a mesh with
  // normals, and how wide a checkerboard is filtered that is seen in a ball.
  const std::string text = R"(
Film "image" "integer xresolution" 32 "integer yresolution" 32
Sampler "halton" "integer pixelsamples" 4
LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" 50
WorldBegin
  LightSource "point" "point from" [2 4 5] "rgb I" [30 30 30]
  Texture "waves" "float" "wrinkled"
  Texture "bumps" "float" "scale" "texture tex1" "waves" "float tex2" 0.2
  Material "matte" "texture bumpmap" "bumps"
  Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-3 -3 0  3 -3 0  3 3 0  -3 3 0]
    "normal N" [0 0 1  0 0 1  0 0 1  0 0 1] "float uv" [0 0  1 0  1 1  0 1]
  AttributeBegin
    Texture "checks" "spectrum" "checkerboard" "float uscale" 40 "float vscale" 40
    Material "matte" "texture Kd" "checks"
    Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-9 -9 6  9 -9 6  9 9 6  -9 9 6] "float uv" [0 0 1 0 1 1 0 1]
    Material "mirror"
    Translate 0 0 1
    Shape "sphere"
  AttributeEnd
)";
  const auto picture = [&](const std::string& more) {
    const test::BuiltScene built(text + more + "WorldEnd\n");
    return render(*built.scene, {}).picture.rgb;
  };
  const auto alone = picture(""), with_another = picture("Translate 0 0 9000 Shape \"sphere\"\n");
  ASSERT_EQ(alone.size(), with_another.size());
  float worst = 0;
  for (size_t i = 0; i < alone.size(); ++i) worst = std::max(worst, std::abs(with_another[i] / alone[i] - 1));
  EXPECT_LT(worst, 1e-4f);
}

}  // namespace
}  // namespace whit
