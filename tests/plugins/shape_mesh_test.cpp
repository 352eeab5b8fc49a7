// Shapes that are meshes: what they build, and what they refuse.

#include <cmath>
#include <filesystem>
#include <fstream>

#include "shape_support.h"
#include "tests/base/temp_folder.h"

namespace whit::shape_test {
namespace {

Parameter normals(const char* name, std::vector<double> v) { return numbers(ParamType::Normal3, name, std::move(v)); }
Parameter vectors(const char* name, std::vector<double> v) { return numbers(ParamType::Vector3, name, std::move(v)); }
Parameter point2s(const char* name, std::vector<double> v) { return numbers(ParamType::Point2, name, std::move(v)); }

const std::vector<double> kTriangle{0, 0, 0, 1, 0, 0, 0, 1, 0};

ParameterList triangle(std::vector<Parameter> more = {}) {
  ParameterList list{integers("indices", {0, 1, 2}), points("P", kTriangle)};
  list.insert(list.end(), more.begin(), more.end());
  return list;
}

TEST(TriangleMesh, HandsOnWhatTheSceneSays) {
  Made made("trianglemesh", triangle({normals("N", {0, 0, 1, 0, 0, 1, 0, 1, 0}),
                                      vectors("S", {1, 0, 0, 1, 0, 0, 1, 0, 0}), point2s("uv", {0, 0, 1, 0, 0, 1})}));
  ASSERT_TRUE(made.ok()) << made.said();
  MeshData mesh;
  ASSERT_TRUE(made.build(mesh));
  EXPECT_EQ(std::vector<double>(mesh.positions.begin(), mesh.positions.end()), kTriangle);
  EXPECT_EQ(mesh.positions.data(), made.params[1].numbers().data());  // not copied
  EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2}));
  EXPECT_EQ(mesh.normals, (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 1, 0}));
  EXPECT_EQ(mesh.tangents, (std::vector<float>{1, 0, 0, 1, 0, 0, 1, 0, 0}));
  EXPECT_EQ(mesh.uvs, (std::vector<float>{0, 0, 1, 0, 0, 1}));
  EXPECT_TRUE(made.diagnostics.all().empty()) << made.said();
}

TEST(TriangleMesh, SurfaceParametersUnderAllTheirNamesAndTypes) {
  const std::vector<double> uv{0.5, 0, 1, 0, 0, 1};
  for (const Parameter& p : {point2s("uv", uv), point2s("st", uv), floats("uv", uv), floats("st", uv)}) {
    Made made("trianglemesh", triangle({p}));
    MeshData mesh;
    ASSERT_TRUE(made.ok() && made.build(mesh)) << made.said();
    EXPECT_EQ(mesh.uvs, (std::vector<float>{0.5, 0, 1, 0, 0, 1}));
    EXPECT_TRUE(made.diagnostics.all().empty()) << made.said();
  }
  Made both("trianglemesh", triangle({floats("st", {9, 9, 9, 9, 9, 9}), floats("uv", uv)}));
  MeshData mesh;
  ASSERT_TRUE(both.build(mesh));
  EXPECT_EQ(mesh.uvs[0], 0.5f);
}

TEST(TriangleMesh, PairsOfPointsComeBeforeFloats) {
  // pbrt-v3 looks for point2 uv, point2 st, float uv and float st, whatever their order in the file.
  const std::vector<double> yes{0.5, 0, 1, 0, 0, 1}, no{9, 9, 9, 9, 9, 9};
  const std::vector<std::vector<Parameter>> cases = {{point2s("uv", yes), floats("uv", no)},
                                                     {floats("uv", no), point2s("uv", yes)},
                                                     {floats("uv", no), point2s("st", yes)},
                                                     {point2s("st", yes), floats("uv", no), floats("st", no)},
                                                     {point2s("st", no), point2s("uv", yes)}};
  for (const std::vector<Parameter>& given : cases) {
    Made made("trianglemesh", triangle(given));
    MeshData mesh;
    ASSERT_TRUE(made.ok() && made.build(mesh)) << made.said();
    EXPECT_EQ(mesh.uvs[0], 0.5f) << &given - cases.data();
  }
}

TEST(EmptyMeshes, AreLeftOutWithAWarning) {
  const auto left_out = [](const char* name, ParameterList list) {
    Made made(name, std::move(list));
    EXPECT_EQ(made.diagnostics.all().size(), 1u) << name << made.said();
    EXPECT_TRUE(made.ok() && made.says("left out")) << name << made.said();
    MeshData mesh;
    EXPECT_TRUE(made.build(mesh)) << name;
    EXPECT_TRUE(mesh.indices.empty() && mesh.positions.empty()) << name;
  };
  for (const char* name : {"trianglemesh", "loopsubdiv"}) {
    left_out(name, {points("P", {}), integers("indices", {})});
    left_out(name, {points("P", kTriangle), integers("indices", {})});
    left_out(name, {points("P", kTriangle)});
    left_out(name, {integers("indices", {0, 1, 2})});
    left_out(name, {});
  }
  left_out("trianglemesh", {points("P", {}), normals("N", {}), integers("indices", {}), point2s("uv", {})});
  left_out("heightfield", {integers("nu", {0}), integers("nv", {0}), floats("Pz", {})});
  left_out("heightfield", {});
  left_out("heightfield", {integers("nu", {3}), integers("nv", {1}), floats("Pz", {1, 2, 3})});
  left_out("nurbs", {integers("nu", {0}), integers("nv", {0}), points("P", {})});
  for (const ParameterList& list : {ParameterList{points("P", {})}, ParameterList{}}) {
    Made curve("curve", list);
    CurveData data;
    EXPECT_TRUE(curve.ok() && curve.says("left out") && curve.build(data)) << curve.said();
    EXPECT_TRUE(data.control_points.empty());
  }
}

TEST(TriangleMesh, MistakesAreErrorsAtTheirPlace) {
  const auto refused = [](ParameterList list, const char* what) {
    Made made("trianglemesh", std::move(list));
    EXPECT_FALSE(made.ok()) << what;
    EXPECT_TRUE(made.says(what)) << made.said();
    for (const auto& d : made.diagnostics.all()) EXPECT_TRUE(d.where.known());
  };
  refused({integers("indices", {0, 1, 2, 0}), points("P", kTriangle)}, "not a multiple of three");
  refused({integers("indices", {0, 1, 7}), points("P", kTriangle)}, "vertex index 7, but there are 3 vertices");
  refused({integers("indices", {0, 1, -1}), points("P", kTriangle)}, "-1");
  refused({integers("indices", {0, 1, 2}), points("P", {0, 0, 0, 1, 0, NAN, 0, 1, 0})}, "finite");
  refused({integers("indices", {0, 1, 2}), points("P", {0, 0, 0, 1, 0, 0, 0, 1})}, "multiple of 3");
  refused(triangle({normals("N", {0, 0, 1})}), "\"N\" has 1 normals, but \"P\" has 3 vertices");
  refused(triangle({vectors("S", {0, 0, 1})}), "\"S\" has 1 tangents");
  refused(triangle({floats("uv", {0, 0, 1, 0})}), "\"uv\" has 4 numbers");
  refused(triangle({floats("uv", {0, 0, 1, 0, INFINITY, 0})}), "usable number");
}

TEST(TriangleMesh, MoreSurfaceParametersThanNeededWarn) {
  Made made("trianglemesh", triangle({floats("uv", {0, 0, 1, 0, 0, 1, 1, 1})}));
  EXPECT_TRUE(made.ok());
  EXPECT_TRUE(made.says("need only 6")) << made.said();
  MeshData mesh;
  ASSERT_TRUE(made.build(mesh));
  EXPECT_EQ(mesh.uvs.size(), 6u);
}

TEST(TriangleMesh, TrianglesWithoutAreaAreLeftOutAndCounted) {
  // Two corners alike, three on a line (up to rounding: thirds are not exact), and a good one 1e-200 in size.
  const double t = 1e-200;
  Made made("trianglemesh",
            {integers("indices", {0, 0, 1, 0, 1, 2, 3, 4, 5}),
             points("P", {0, 0, 0, 0.1, 0.2, 0.7, 0.1 * 3, 0.2 * 3, 0.7 * 3, 0, 0, 0, t, 0, 0, 0, t, 0})});
  MeshData mesh;
  ASSERT_TRUE(made.ok() && made.build(mesh)) << made.said();
  EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{3, 4, 5}));
  EXPECT_EQ(mesh.degenerate, 2u);
  EXPECT_EQ(made.said(), "");  // The scene's builder says it once for all shapes.
}

/// A file that is there for one test.
class TemporaryFile {
 public:
  TemporaryFile(const char* name, const std::string& contents) : path_(test::temp_folder() + '/' + name) {
    std::ofstream(path_, std::ios::binary) << contents;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  const char* path() const { return path_.c_str(); }

 private:
  std::string path_;
};

TEST(PlyMesh, ReadsAFile) {
  const TemporaryFile file(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 3\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 1 0 0 1 1 0 0 1 0\n4 0 1 2 3\n3 0 1 1\n1 0\n");
  Made made("plymesh", {text("filename", file.path())});
  ASSERT_TRUE(made.ok()) << made.said();
  MeshData built;
  ASSERT_TRUE(made.build(built)) << made.said();
  const MeshData mesh = std::move(built);  // positions stay valid
  EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2, 3, 0, 2}));
  EXPECT_EQ(std::vector<double>(mesh.positions.begin(), mesh.positions.end()),
            (std::vector<double>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}));
  EXPECT_EQ(mesh.degenerate, 1u);
  EXPECT_TRUE(made.says("1 faces with fewer than 3")) << made.said();
}

TEST(PlyMesh, AnEmptyMeshIsLeftOut) {
  const TemporaryFile file("e.ply",
                           "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
                           "property float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n");
  Made made("plymesh", {text("filename", file.path())});
  MeshData mesh;
  ASSERT_TRUE(made.build(mesh)) << made.said();
  EXPECT_TRUE(mesh.indices.empty());
  EXPECT_TRUE(made.says("e.ply has no faces")) << made.said();
  EXPECT_FALSE(made.diagnostics.has_errors());
}

TEST(PlyMesh, ErrorsStandAtTheFileName) {
  const TemporaryFile file("b.ply",
                           "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                           "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                           "end_header\n0 0 0 1 0 0 0 1 0 3 0 1");
  Made made("plymesh", {text("filename", file.path())});
  MeshData mesh;
  EXPECT_FALSE(made.build(mesh));
  ASSERT_TRUE(made.says("PLY data ends early")) << made.said();
  EXPECT_EQ(made.diagnostics.all()[0].where.offset, 200u);
  EXPECT_EQ(made.diagnostics.all()[0].error_class, ErrorClass::File);
  EXPECT_FALSE(Made("plymesh", {}).ok());
  const TemporaryFile empty("c.ply", "");
  Made nothing("plymesh", {text("filename", empty.path())});
  EXPECT_FALSE(nothing.build(mesh));
  EXPECT_TRUE(nothing.says("not a PLY file"));
}

TEST(Heightfield, SpreadsItsPointsOverTheUnitSquare) {
  Made made("heightfield", {integers("nu", {3}), integers("nv", {2}), floats("Pz", {1, 2, 3, 4, 5, 6})});
  MeshData mesh;
  ASSERT_TRUE(made.ok() && made.build(mesh)) << made.said();
  EXPECT_EQ(std::vector<double>(mesh.positions.begin(), mesh.positions.end()),
            (std::vector<double>{0, 0, 1, 0.5, 0, 2, 1, 0, 3, 0, 1, 4, 0.5, 1, 5, 1, 1, 6}));
  EXPECT_EQ(mesh.uvs, (std::vector<float>{0, 0, 0.5, 0, 1, 0, 0, 1, 0.5, 1, 1, 1}));
  EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4}));
}

TEST(Heightfield, CountsMustFit) {
  Made few("heightfield", {integers("nu", {2}), integers("nv", {2}), floats("Pz", {1, 2, 3})});
  EXPECT_FALSE(few.ok());
  EXPECT_TRUE(few.says("\"Pz\" has 3 values, expected 4")) << few.said();
  EXPECT_EQ(few.diagnostics.all()[0].where.offset, 200u);
  EXPECT_FALSE(Made("heightfield", {integers("nu", {1}), integers("nv", {2}), floats("Pz", {1, 2, 3})}).ok());
  EXPECT_FALSE(
      Made("heightfield", {integers("nu", {2147483647}), integers("nv", {2147483647}), floats("Pz", {1})}).ok());
}

/// A bilinear patch in the order-2 form: knots 0 0 1 1 both ways.
ParameterList patch(Parameter control) {
  return {integers("nu", {2}), integers("uorder", {2}), floats("uknots", {0, 0, 1, 1}),
          integers("nv", {2}), integers("vorder", {2}), floats("vknots", {0, 0, 1, 1}),
          std::move(control)};
}

TEST(Nurbs, ABilinearPatchIsBilinear) {
  Made made("nurbs", patch(points("P", {0, 0, 0, 2, 0, 0, 0, 3, 0, 2, 3, 4})));
  MeshData mesh;
  ASSERT_TRUE(made.ok() && made.build(mesh)) << made.said();
  ASSERT_EQ(mesh.positions.size(), 2700u);
  EXPECT_EQ(mesh.indices.size(), 3u * 2 * 29 * 29);
  for (size_t j = 0; j < 30; ++j) {
    for (size_t i = 0; i < 30; ++i) {
      const double u = static_cast<double>(i) / 29, v = static_cast<double>(j) / 29;
      const size_t k = 30 * j + i;
      EXPECT_NEAR(mesh.positions[3 * k], 2 * u, 1e-14);
      EXPECT_NEAR(mesh.positions[3 * k + 1], 3 * v, 1e-14);
      EXPECT_NEAR(mesh.positions[3 * k + 2], 4 * u * v, 1e-14);
      EXPECT_FLOAT_EQ(mesh.uvs[2 * k], static_cast<float>(u));
      // dpdu = (2, 0, 4v), dpdv = (0, 3, 4u).
      const Vec3d n = Vec3d(2, 0, 4 * v).cross(Vec3d(0, 3, 4 * u)).normalized();
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(mesh.normals[3 * k + c], n[static_cast<int>(c)], 1e-6);
    }
  }
}

/// A quarter of a cylinder of radius 1: the rational quadratic arc (1,0) (1,1) (0,1) with weights 1, sqrt(1/2), 1.
ParameterList quarter_cylinder() {
  const double w = std::sqrt(0.5);
  return {integers("nu", {3}),
          integers("uorder", {3}),
          floats("uknots", {0, 0, 0, 1, 1, 1}),
          integers("nv", {2}),
          integers("vorder", {2}),
          floats("vknots", {0, 0, 1, 1}),
          floats("Pw", {1, 0, 0, 1, w, w, 0, w, 0, 1, 0, 1, 1, 0, 2, 1, w, w, 2 * w, w, 0, 1, 2, 1})};
}

TEST(Nurbs, ARationalArcIsACircle) {
  Made made("nurbs", quarter_cylinder());
  MeshData mesh;
  ASSERT_TRUE(made.ok() && made.build(mesh)) << made.said();
  for (size_t k = 0; k < 900; ++k) {
    const double x = mesh.positions[3 * k], y = mesh.positions[3 * k + 1];
    EXPECT_NEAR(x * x + y * y, 1, 1e-14);
    EXPECT_NEAR(mesh.normals[3 * k], x, 1e-6);
    EXPECT_NEAR(mesh.normals[3 * k + 1], y, 1e-6);
    EXPECT_NEAR(mesh.normals[3 * k + 2], 0, 1e-6);
  }
}

TEST(Nurbs, PartsAndInnerKnots) {
  // Order 2 with an inner knot: a polyline in u through x = 0, 1, 4 at u = 0, 1, 3. From u0 = 0.5 to u1 = 2.
  Made made("nurbs",
            {integers("nu", {3}), integers("uorder", {2}), floats("uknots", {0, 0, 1, 3, 3}), floats("u0", {0.5}),
             floats("u1", {2}), integers("nv", {2}), integers("vorder", {2}), floats("vknots", {0, 0, 1, 1}),
             points("P", {0, 0, 0, 1, 0, 0, 4, 0, 0, 0, 1, 0, 1, 1, 0, 4, 1, 0})});
  MeshData mesh;
  ASSERT_TRUE(made.ok() && made.build(mesh)) << made.said();
  for (size_t i = 0; i < 30; ++i) {
    const double u = 0.5 + 1.5 * static_cast<double>(i) / 29;
    EXPECT_NEAR(mesh.positions[3 * i], u <= 1 ? u : 1 + 1.5 * (u - 1), 1e-13);
    EXPECT_FLOAT_EQ(mesh.uvs[2 * i], static_cast<float>(u));
  }
}

TEST(Nurbs, ASideDrawnTogetherHasNormals) {
  // Both points at v = 0 coincide: dpdu is 0 there.
  Made made("nurbs", patch(points("P", {0, 0, 0, 0, 0, 0, -1, 1, 0, 1, 1, 0})));
  MeshData mesh;
  ASSERT_TRUE(made.ok() && made.build(mesh)) << made.said();
  for (size_t k = 0; k < 900; ++k) EXPECT_NEAR(mesh.normals[3 * k + 2], 1, 1e-6) << k;
  EXPECT_EQ(mesh.indices.size(), 3u * (2 * 29 * 29 - 29));
}

TEST(Nurbs, CountsMustFit) {
  const auto refused = [](size_t replace, Parameter by, const char* what) {
    ParameterList list = patch(points("P", {0, 0, 0, 2, 0, 0, 0, 3, 0, 2, 3, 4}));
    list[replace] = std::move(by);
    Made made("nurbs", std::move(list));
    EXPECT_FALSE(made.ok()) << what;
    EXPECT_TRUE(made.says(what)) << made.said();
  };
  refused(2, floats("uknots", {0, 0, 1}), "number of knots does not match");
  refused(2, floats("uknots", {0, 1, 0, 1}), "must not decrease");
  refused(2, floats("uknots", {0, 1, 1, 2}), "span no interval");
  refused(2, floats("u0", {0}), "\"uknots\" is missing");
  refused(1, integers("uorder", {3}), "at least as many points");
  refused(1, integers("uorder", {1}), "at least 2");
  refused(6, points("P", {0, 0, 0}), "expected 12");
  refused(6, floats("Pw", {0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 1, 1, 1, 0, 1}), "weights");
  refused(6, floats("u0", {-1}), "between the knots");
  refused(6, floats("u0", {0}), "neither \"P\" nor \"Pw\"");
}

}  // namespace
}  // namespace whit::shape_test
