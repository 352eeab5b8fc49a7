// The transform statements, as pbrt-v3 means them, in row-vector convention: p' = p * M.
#include "parser/transforms.h"

#include <cmath>
#include <limits>

#include "tests/parser/parser_test_support.h"

namespace whit {
namespace {

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance = 1e-14) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << a << " != " << b;
}

/// The transform of the last shape of a world.
TransformPair last_shape_pair(const std::string& body) {
  const Parsed parsed(in_world(body + "\nShape \"s\""));
  EXPECT_FALSE(parsed.result.diagnostics.has_errors()) << parsed.messages();
  const SceneDescription& scene = parsed.scene();
  return scene.transforms[static_cast<size_t>(scene.shapes.back().transform)];
}
Mat4d last_shape(const std::string& body) { return last_shape_pair(body).start; }

TEST(Transforms, TheStatementNearestTheShapeIsAppliedFirst) {
  // The point (1, 0, 0) is doubled, then turned a quarter about z to (0, 2, 0), then moved by (10, 0, 0).
  const Mat4d m = last_shape("Translate 10 0 0 Rotate 90 0 0 1 Scale 2 2 2");
  EXPECT_EQ(transform_point(m, {1, 0, 0}), Vec3d(10, 2, 0));
}

TEST(Transforms, RotateIsCounterclockwiseInDegrees) {
  // Right-hand rule: x to y about z, y to z about x, z to x about y; a third of a turn about the diagonal
  // permutes the axes x to y to z.
  EXPECT_EQ(transform_vector(rotation(90, {0, 0, 1}), {1, 0, 0}), Vec3d(0, 1, 0));
  EXPECT_EQ(transform_vector(rotation(90, {5, 0, 0}), {0, 1, 0}), Vec3d(0, 0, 1));
  EXPECT_EQ(transform_vector(rotation(90, {0, 1e-200, 0}), {0, 0, 1}), Vec3d(1, 0, 0));
  expect_near(transform_vector(rotation(120, {1, 1, 1}), {1, 0, 0}), {0, 1, 0});
  expect_near(transform_vector(rotation(30, {0, 0, 1}), {1, 0, 0}), {std::sqrt(3) / 2, 0.5, 0});
  EXPECT_EQ(rotation(-270, {0, 0, 1}), rotation(90, {0, 0, 1}));
  EXPECT_EQ(rotation(360, {0, 0, 1}), Mat4d());
}

TEST(Transforms, TransformListsTheMatrixRowByRow) {
  // pbrt's list has the translation in elements 12 to 14.
  const Mat4d m = last_shape("Translate 7 7 7 Transform [ 1 0 0 0  0 2 0 0  0 0 3 0  10 20 30 1 ]");
  EXPECT_EQ(transform_point(m, {1, 1, 1}), Vec3d(11, 22, 33));
  // ConcatTransform keeps what was there and applies it afterwards.
  EXPECT_EQ(
      transform_point(last_shape("Translate 7 0 0 ConcatTransform [ 2 0 0 0  0 2 0 0  0 0 2 0  0 0 0 1 ]"), {1, 0, 0}),
      Vec3d(9, 0, 0));
  EXPECT_EQ(last_shape("Translate 7 0 0 Identity"), Mat4d());
}

TEST(Transforms, LookAt) {
  // From (0, -5, 1) along +y with z up. In pbrt's left-handed space right is up x view = z x y = -x.
  const Mat4d m = *looking_at({0, -5, 1}, {0, 0, 1}, {0, 0, 1});
  EXPECT_EQ(transform_point(m, {0, -5, 1}), Vec3d(0, 0, 0));
  EXPECT_EQ(transform_point(m, {0, 0, 1}), Vec3d(0, 0, 5));
  EXPECT_EQ(transform_point(m, {0, -5, 3}), Vec3d(0, 2, 0));
  EXPECT_EQ(transform_point(m, {1, -5, 1}), Vec3d(-1, 0, 0));
  EXPECT_FALSE(swaps_handedness(m));
  // The up vector need be neither long nor upright; tiny and huge scenes work alike.
  const Mat4d slant = *looking_at({0, 0, 0}, {0, 1e-200, 0}, {0, 1e200, 1e200});
  expect_near(transform_vector(slant, {0, 0, 1}), {0, 1, 0});
}

TEST(Transforms, LookAtDegenerate) {
  EXPECT_FALSE(looking_at({1, 2, 3}, {1, 2, 3}, {0, 0, 1}));
  EXPECT_FALSE(looking_at({0, 0, 0}, {1, 2, 3}, {0, 0, 0}));
  EXPECT_FALSE(looking_at({0, 0, 0}, {1, 2, 3}, {-2, -4, -6}));
  EXPECT_TRUE(looking_at({0, 0, 0}, {1, 2, 3}, {-2, -4, -6.0001}));
  expect_only(Parsed("LookAt 0 0 0  0 0 0  0 1 0 WorldBegin WorldEnd"), Severity::Error, 1, 1, "coincide");
  expect_only(Parsed("LookAt 0 0 0  0 1 0  0 2 0 WorldBegin WorldEnd"), Severity::Error, 1, 1, "parallel");
}

TEST(Transforms, CameraStoresWorldToCamera) {
  const Parsed parsed(
      "LookAt 0 -5 1  0 0 1  0 0 1\nCamera \"perspective\"\nTranslate 9 9 9\nWorldBegin\nShape \"s\"\nWorldEnd\n");
  const SceneDescription& scene = parsed.scene();
  const Mat4d camera = scene.transforms[static_cast<size_t>(scene.camera_transform)].start;
  EXPECT_EQ(camera, *looking_at({0, -5, 1}, {0, 0, 1}, {0, 0, 1}));
  // WorldBegin resets the CTM.
  EXPECT_EQ(scene.shapes[0].transform, 0);
  EXPECT_EQ(scene.transforms[0].start, Mat4d());
}

TEST(Transforms, CoordinateSystems) {
  // "camera" is camera to world: its origin is the eye.
  const Parsed parsed(
      "LookAt 0 -5 1  0 0 1  0 0 1 Camera \"perspective\" WorldBegin\n"
      "Translate 1 0 0 CoordinateSystem \"here\" Translate 1 0 0\n"
      "CoordSysTransform \"camera\" Shape \"s\" CoordSysTransform \"here\" Shape \"s\" CoordSysTransform \"world\" "
      "Shape "
      "\"s\" WorldEnd");
  expect_clean(parsed);
  const SceneDescription& scene = parsed.scene();
  const auto origin = [&](size_t i) {
    return transform_point(scene.transforms[static_cast<size_t>(scene.shapes.at(i).transform)].start, {0, 0, 0});
  };
  expect_near(origin(0), {0, -5, 1});
  EXPECT_EQ(origin(1), Vec3d(1, 0, 0));
  EXPECT_EQ(origin(2), Vec3d(0, 0, 0));
}

TEST(Transforms, UnknownCoordinateSystemIsIgnoredWithAWarning) {
  const Parsed parsed(in_world("CoordSysTransform \"wrold\""));
  expect_only(parsed, Severity::Warning, 2, 19, "no coordinate system named \"wrold\"", "did you mean \"world\"?");
}

TEST(Transforms, ActiveTransform) {
  const TransformPair pair = last_shape_pair(
      "ActiveTransform StartTime Translate 1 0 0 ActiveTransform EndTime Translate 2 0 0 "
      "ActiveTransform All Translate 0 5 0");
  EXPECT_EQ(transform_point(pair.start, {0, 0, 0}), Vec3d(1, 5, 0));
  EXPECT_EQ(transform_point(pair.end, {0, 0, 0}), Vec3d(2, 5, 0));
  EXPECT_TRUE(pair.animated());
  // CoordSysTransform sets both times, whichever is active; an AttributeEnd restores which is active.
  const TransformPair both = last_shape_pair("Translate 1 0 0 ActiveTransform EndTime CoordSysTransform \"world\"");
  EXPECT_EQ(both.start, Mat4d());
  const TransformPair restored = last_shape_pair(
      "AttributeBegin ActiveTransform EndTime AttributeEnd Translate 1 0 0 "
      "TransformBegin ActiveTransform StartTime TransformEnd Translate 1 0 0");
  EXPECT_EQ(transform_point(restored.start, {0, 0, 0}), Vec3d(2, 0, 0));
  EXPECT_FALSE(restored.animated());
  expect_only(Parsed(in_world("ActiveTransform Both")), Severity::Error, 2, 17, "\"Both\"", "StartTime");
}

TEST(Transforms, TransformTimes) {
  const Parsed parsed("TransformTimes .25 2 WorldBegin WorldEnd");
  EXPECT_EQ(parsed.scene().time_start, .25);
  EXPECT_EQ(parsed.scene().time_end, 2);
}

TEST(Transforms, TexturesAndLightsCannotMove) {
  const Parsed parsed(in_world("ActiveTransform EndTime Translate 1 0 0\nLightSource \"point\""));
  expect_only(parsed, Severity::Warning, 3, 1, "LightSource cannot move", "start time");
  EXPECT_EQ(parsed.scene().lights[0].transform, 0);
}

TEST(Transforms, RegularWhateverTheScale) {
  // Uniformly tiny, very flat, both rotated, and far away: all of these can be inverted.
  EXPECT_TRUE(is_regular(scaling({1e-100, 1e-100, 1e-100})));
  EXPECT_TRUE(is_regular(scaling({1e-120, 1, 1e120})));
  EXPECT_TRUE(is_regular(scaling({1e-30, 1, 1}) * rotation(33, {1, 2, 3}) * translation({1e30, 0, 0})));
  EXPECT_TRUE(is_regular(rotation(33, {1, 2, 3}) * scaling({1e-30, 1, 1})));
  EXPECT_TRUE(is_regular(rotation(33, {1, 2, 3}) * scaling({1e-10, 1, 1}) * rotation(50, {1, 0, 3})));
  EXPECT_TRUE(is_regular(*looking_at({1e6, 2e6, 3}, {0, 0, 0}, {0, 0, 1})));
}

TEST(Transforms, Singular) {
  EXPECT_FALSE(is_regular(scaling({1, 0, 1})));
  EXPECT_FALSE(is_regular(scaling({1e-320, 1e-320, 1e-320})));
  EXPECT_FALSE(is_regular(Mat4d(1, 2, 3, 0, 2, 4, 6, 0, 7, 8, 10, 0, 0, 0, 0, 1)));
  // A projection rotated: its zero pivot is rounding noise, not zero.
  EXPECT_FALSE(is_regular(rotation(33, {1, 2, 3}) * scaling({1, 0, 1}) * rotation(50, {1, 0, 3})));
  EXPECT_FALSE(is_regular(scaling({std::numeric_limits<double>::infinity(), 1, 1})));
  EXPECT_FALSE(is_regular(translation({std::numeric_limits<double>::quiet_NaN(), 1, 1})));
}

TEST(Transforms, SingularOnesAreKeptWithTheStatementThatMadeThem) {
  // Whether they are mistakes depends on what stands there, and whether that is seen.
  const auto singular = [](const std::string& text) {
    const Parsed parsed(in_world(text));
    EXPECT_TRUE(parsed.result.diagnostics.all().empty());
    std::vector<std::string> found;
    for (const ShapeDescription& shape : parsed.scene().shapes) {
      const auto made = parsed.scene().singular_transforms.find(shape.transform);
      found.push_back("regular");
      if (made == parsed.scene().singular_transforms.end()) continue;
      const auto& [statement, where] = parsed.scene().singular[static_cast<size_t>(made->second)];
      const SourcePlace place = parsed.sources.place(where);
      found.back() = statement + " " + std::to_string(place.line) + ":" + std::to_string(place.column);
    }
    return found;
  };
  using Found = std::vector<std::string>;
  EXPECT_EQ(singular("Translate 1 0 0\n  Scale 1 0 1\nTranslate 1 0 0 Shape \"s\""), Found{"Scale 3:3"});
  EXPECT_EQ(singular("Transform [ 1 0 0 0  0 1 0 0  0 0 0 0  0 0 0 1 ] Shape \"s\""), Found{"Transform 2:1"});
  EXPECT_EQ(singular("AttributeBegin Scale 0 1 1 Shape \"s\" AttributeEnd Shape \"s\""),
            (Found{"Scale 2:16", "regular"}));
  EXPECT_EQ(singular("Scale 0 1 1 CoordinateSystem \"c\" Identity Shape \"s\" CoordSysTransform \"c\" Shape \"s\""),
            (Found{"regular", "Scale 2:1"}));
  // Overflow by repetition is found where it happens.
  EXPECT_EQ(singular("Scale 1e200 1 1\nScale 1e200 1 1 Shape \"s\""), Found{"Scale 3:1"});
  expect_only(Parsed(in_world("Rotate 30 0 0 0")), Severity::Error, 2, 8, "axis of length zero");
  // Before the world, where the camera stands.
  expect_only(Parsed("Scale 1 0 1\n" + in_world("")), Severity::Error, 1, 1, "cannot be inverted");
}

TEST(Transforms, EqualOnesAreKeptOnce) {
  const Parsed parsed(in_world("Translate 1 0 0 Shape \"s\" Shape \"s\" Identity Shape \"s\""));
  EXPECT_EQ(parsed.scene().transforms.size(), 2u);
  EXPECT_EQ(parsed.scene().shapes[1].transform, 1);
  EXPECT_EQ(parsed.scene().shapes[2].transform, 0);
}

}  // namespace
}  // namespace whit
