#include "core/base/ply.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace whit {
namespace {

enum class Order { Little, Big };

/// The bytes of a value in the given order.
template <class T>
std::string bytes(Order order, T value) {
  std::string s(sizeof(T), '\0');
  std::memcpy(s.data(), &value, sizeof(T));
  if ((order == Order::Big) == (std::endian::native == std::endian::little)) std::reverse(s.begin(), s.end());
  return s;
}

const char* const kXyz = "property float x\nproperty float y\nproperty float z\n";
const char* const kFaces = "property list uchar int vertex_indices\nend_header\n";

std::string header(const char* format, int vertices, const std::string& properties, int faces,
                   const std::string& face_properties = kFaces) {
  return std::string("ply\nformat ") + format + " 1.0\ncomment made by a test\nelement vertex " +
         std::to_string(vertices) + "\n" + properties + "element face " + std::to_string(faces) + "\n" +
         face_properties;
}

/// A square of two triangles: vertices (0,0,0) (1,0,0) (1,1,0.5) (0,1,0.25).
const double kSquare[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0.25}};

template <class Coordinate, class Count, class Index>
std::string binary_square(Order order, const char* coordinate, const char* count, const char* index) {
  const std::string c(coordinate);
  std::string s = header(order == Order::Big ? "binary_big_endian" : "binary_little_endian", 4,
                         "property " + c + " x\nproperty " + c + " y\nproperty " + c + " z\n", 2,
                         std::string("property list ") + count + " " + index + " vertex_indices\nend_header\n");
  for (const auto& v : kSquare)
    for (const double x : v) s += bytes(order, static_cast<Coordinate>(x));
  for (const auto& f : {std::vector<int>{0, 1, 2}, std::vector<int>{0, 2, 3}}) {
    s += bytes(order, static_cast<Count>(3));
    for (const int i : f) s += bytes(order, static_cast<Index>(i));
  }
  return s;
}

void expect_square(const std::string& file) {
  PlyMesh mesh;
  ASSERT_EQ(parse_ply(file, mesh), "");
  ASSERT_EQ(mesh.positions.size(), 12u);
  for (size_t i = 0; i < 12; ++i) EXPECT_EQ(mesh.positions[i], kSquare[i / 3][i % 3]);
  EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(mesh.skipped_faces, 0u);
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_TRUE(mesh.uvs.empty());
}

std::string error_of(const std::string& file) {
  PlyMesh mesh;
  return parse_ply(file, mesh);
}

TEST(Ply, Ascii) {
  const std::string data = "0 0 0\n1 0 0\n1 1 .5\n0 1 2.5e-1\n3 0 1 2\n3 0 2 3";
  expect_square(header("ascii", 4, kXyz, 2) + data);
  expect_square(header("ascii", 4, kXyz, 2) + data + "\n");
  std::string windows;
  for (const char c : header("ascii", 4, kXyz, 2) + data) windows += c == '\n' ? "\r\n" : std::string(1, c);
  expect_square(windows);
  expect_square(header("ascii", 4, kXyz, 2, "property list uchar int vertex_index\nend_header\n") + data);
  expect_square(header("ascii", 4, kXyz, 2) + "+0 -0 0 1 0 0\t1 1 .5  0 1 0.25\n\n 3 0 1 2 3 0 2 3");
}

TEST(Ply, BinaryOfAllTypesAndOrders) {
  for (const Order order : {Order::Little, Order::Big}) {
    expect_square(binary_square<float, uint8_t, int32_t>(order, "float", "uchar", "int"));
    expect_square(binary_square<float, uint8_t, uint32_t>(order, "float32", "uint8", "uint32"));
    expect_square(binary_square<double, uint8_t, int16_t>(order, "double", "char", "short"));
    expect_square(binary_square<double, uint32_t, uint16_t>(order, "float64", "uint", "ushort"));
    expect_square(binary_square<float, int16_t, uint8_t>(order, "float", "int16", "uchar"));
  }
}

TEST(Ply, PropertiesInAnyOrderWithStrangersBetween) {
  // An element before, a list among the vertex properties, colours, and a flag after the face's list.
  const std::string head =
      "ply\nformat binary_little_endian 1.0\nobj_info x\nelement camera 2\nproperty list uchar short a\nproperty "
      "double b\n"
      "element vertex 3\nproperty uchar red\nproperty float t\nproperty double z\nproperty float nz\nproperty float "
      "nx\n";
  const Order o = Order::Little;
  for (const bool list : {false, true}) {
    std::string s =
        head + (list ? "property list uchar float weights\n" : "") +
        "property float ny\nproperty float y\nproperty short x\nproperty float s\nelement face 1\n"
        "property float quality\nproperty list int ushort vertex_indices\nproperty uchar flag\nend_header\n";
    for (int i = 0; i < 2; ++i) s += bytes(o, uint8_t{1}) + bytes(o, int16_t{7}) + bytes(o, 1.0);
    for (int i = 0; i < 3; ++i) {
      const float f = static_cast<float>(i);
      s += bytes(o, uint8_t{9}) + bytes(o, 0.5f + f) + bytes(o, 30.0 + i) + bytes(o, 300 + f) + bytes(o, 100 + f);
      if (list) s += bytes(o, uint8_t{2}) + bytes(o, 1.f) + bytes(o, 2.f);
      s += bytes(o, 200 + f) + bytes(o, 20 + f) + bytes(o, static_cast<int16_t>(10 + i)) + bytes(o, 0.25f + f);
    }
    s += bytes(o, 1.f) + bytes(o, int32_t{3});
    for (const int i : {2, 1, 0}) s += bytes(o, static_cast<uint16_t>(i));
    s += bytes(o, uint8_t{1});
    PlyMesh mesh;
    ASSERT_EQ(parse_ply(s, mesh), "");
    EXPECT_EQ(mesh.positions, (std::vector<double>{10, 20, 30, 11, 21, 31, 12, 22, 32}));
    EXPECT_EQ(mesh.normals, (std::vector<float>{100, 200, 300, 101, 201, 301, 102, 202, 302}));
    EXPECT_EQ(mesh.uvs, (std::vector<float>{0.25f, 0.5f, 1.25f, 1.5f, 2.25f, 2.5f}));
    EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{2, 1, 0}));
  }
}

TEST(Ply, NamesOfSurfaceParameters) {
  for (const auto& [u, v] : {std::pair{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}}) {
    PlyMesh mesh;
    const std::string uv = std::string("property float ") + u + "\nproperty float " + v + "\n";
    ASSERT_EQ(parse_ply(header("ascii", 3, kXyz + uv, 1) + "0 0 0 .1 .2 1 0 0 .3 .4 0 1 0 .5 .6 3 0 1 2", mesh), "");
    EXPECT_EQ(mesh.uvs, (std::vector<float>{.1f, .2f, .3f, .4f, .5f, .6f}));
  }
}

TEST(Ply, QuadsAreSplitAsPbrtDoesAndPolygonsSkipped) {
  PlyMesh mesh;
  ASSERT_EQ(parse_ply(header("ascii", 5, kXyz, 4) +
                          "0 0 0 1 0 0 1 1 0 0 1 0 .5 2 0\n4 0 1 2 3\n5 0 1 2 4 3\n2 0 1\n3 2 4 3\n",
                      mesh),
            "");
  EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2, 3, 0, 2, 2, 4, 3}));
  EXPECT_EQ(mesh.skipped_faces, 2u);
}

TEST(Ply, EveryTruncationIsAnError) {
  for (const std::string& whole : {binary_square<float, uint8_t, int32_t>(Order::Little, "float", "uchar", "int"),
                                   binary_square<double, uint32_t, uint16_t>(Order::Big, "double", "uint", "ushort")}) {
    for (size_t n = 0; n < whole.size(); ++n) { EXPECT_NE(error_of(whole.substr(0, n)), "") << n; }
    EXPECT_NE(error_of(whole.substr(0, whole.size() - 1)).find("PLY data ends early"), std::string::npos);
  }
  const std::string ascii = header("ascii", 3, kXyz, 1) + "0 0 0 1 0 0 0 1 0 3 0 1";
  EXPECT_EQ(error_of(ascii), "PLY data ends early");
  EXPECT_EQ(error_of(ascii + " 2"), "");
}

TEST(Ply, LyingCountsAreRefusedBeforeAllocating) {
  const std::string huge = "PLY header promises more than the file holds";
  for (const char* format : {"ascii", "binary_little_endian"}) {
    std::string s = std::string("ply\nformat ") + format + " 1.0\nelement vertex 4000000000\n" + kXyz +
                    "element face 1\n" + kFaces + "0 0 0";
    EXPECT_NE(error_of(s).find(huge), std::string::npos) << error_of(s);
    s = std::string("ply\nformat ") + format + " 1.0\nelement vertex 3\n" + kXyz +
        "element face 18446744073709551615\n" + kFaces + std::string(100, '0');
    EXPECT_NE(error_of(s).find(huge), std::string::npos) << error_of(s);
  }
  EXPECT_NE(error_of("ply\nformat ascii 1.0\nelement x 99999999999\nelement vertex 3\n" + std::string(kXyz) +
                     "element face 1\n" + kFaces + "0 0 0 1 0 0 0 1 0 3 0 1 2"),
            "");
}

TEST(Ply, BadContentsAreErrors) {
  const std::string three = "0 0 0 1 0 0 0 1 0 ";
  const auto says = [&](const std::string& file, const char* what) {
    EXPECT_NE(error_of(file).find(what), std::string::npos) << "\"" << error_of(file) << "\" should say " << what;
  };
  says("", "not a PLY file");
  says("hello", "not a PLY file");
  says("\x89PNG\r\n\x1a\n", "not a PLY file");
  says("ply\nformat ascii 1.0\n", "header ends early");
  says(header("ascii", 3, kXyz, 1) + three + "3 0 1 900", "does not exist: 900; the file has 3 vertices");
  says(header("ascii", 3, kXyz, 1) + three + "3 0 1 -1", "negative");
  says(header("ascii", 3, kXyz, 1) + three + "3 0 1 99999999999", "does not exist");
  says(header("ascii", 3, kXyz, 1) + "0 0 zero 1 0 0 0 1 0 3 0 1 2", "no number in \"zero\"");
  says(header("ascii", 3, "property float x\nproperty float y\n", 1) + "0 0 1 1 2 2 3 0 1 2", "lack x, y or z");
  says(header("ascii", 3, kXyz, 1, "property int i\nend_header\n") + three + "1", "lack \"vertex_indices\"");
  says(header("ascii", 3, kXyz, 1, "property list uchar float vertex_indices\nend_header\n") + three + "3 0 1 2",
       "integers");
  // Of which the last once counted as the only one, as did every odd one, and the first two were read by its columns.
  says(header("ascii", 3, kXyz, 1,
              "property int i\nelement face 1\nproperty int i\nelement face 1\n" + std::string(kFaces)) +
           three + "1 1 3 0 1 2",
       "several elements \"face\"");
  says(header("utf8", 3, kXyz, 1) + three + "3 0 1 2", "format is unknown");
  says("ply\nformat ascii 1.0\nelement vertex x\n", "count is no number");
  says("ply\nformat ascii 1.0\nproperty float x\n", "before the first element");
  says("ply\nformat ascii 1.0\nelement vertex 3\nproperty half x\n", "type is unknown");
  says("ply\nelement vertex 3\n" + std::string(kXyz) + "element face 1\n" + kFaces + three + "3 0 1 2",
       "no \"format\"");
  // A negative index in the fast path.
  std::string s = binary_square<float, uint8_t, int32_t>(Order::Little, "float", "uchar", "int");
  s.replace(s.size() - 4, 4, bytes(Order::Little, int32_t{-7}));
  says(s, "does not exist");
}

TEST(Ply, AMeshMayBeEmpty) {
  for (const uint64_t vertices : {0, 1}) {
    PlyMesh mesh;
    EXPECT_EQ(parse_ply(header("ascii", vertices, kXyz, 0) + "0 0 0", mesh), "");
    EXPECT_TRUE(mesh.indices.empty());
  }
  // A cloud of points, and faces without vertices.
  PlyMesh mesh;
  EXPECT_EQ(parse_ply("ply\nformat ascii 1.0\nelement vertex 1\n" + std::string(kXyz) + "end_header\n0 0 0", mesh), "");
  EXPECT_TRUE(mesh.indices.empty());
  EXPECT_EQ(parse_ply(header("ascii", 0, kXyz, 1) + "3 0 1 2", mesh), "");
  EXPECT_TRUE(mesh.indices.empty());
}

TEST(Ply, NormalsAndParametersAreFinitePointsAreAsTheFileSays) {
  // A point that is no number may be there if nothing uses it, so points are passed on. A normal that is none is 0, which
  // is no direction: the surface's own is taken, as in pbrt-v3.
  const std::string more =
      "property float nx\nproperty float ny\nproperty float nz\nproperty float u\nproperty float v\n";
  PlyMesh mesh;
  EXPECT_EQ(parse_ply(header("ascii", 3, std::string(kXyz) + more, 1) +
                          "0 0 nan  nan 0 1  0 0  1 0 0  0 inf 1  1 nan  0 inf 0  0 0 1  1e999 1  3 0 1 2",
                      mesh),
            "");
  EXPECT_TRUE(std::isnan(mesh.positions[2]));
  EXPECT_TRUE(std::isinf(mesh.positions[7]));
  EXPECT_EQ(mesh.normals, (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(mesh.uvs, (std::vector<float>{0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(mesh.bad_numbers, 4u);
}

TEST(Ply, InBinaryToo) {
  // The same by the ways that read packed values, of either size and order: x nx of each vertex are NaN and infinite.
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
  const std::string normals =
      "property double x\nproperty float y\nproperty float z\nproperty float nx\n"
      "property double ny\nproperty float nz\n";
  for (const Order order : {Order::Little, Order::Big}) {
    std::string file = header(order == Order::Big ? "binary_big_endian" : "binary_little_endian", 3, normals, 0);
    for (const double bad : {kNan, kInf, -kInf}) {
      file += bytes(order, bad) + bytes(order, 1.0f) + bytes(order, 2.0f);
      file += bytes(order, static_cast<float>(bad)) + bytes(order, bad) + bytes(order, 3.0f);
    }
    file.replace(file.find("face 0"), 6, "face 1");
    file += bytes(order, uint8_t{3}) + bytes(order, 0) + bytes(order, 1) + bytes(order, 2);
    PlyMesh mesh;
    ASSERT_EQ(parse_ply(file, mesh), "");
    EXPECT_EQ(mesh.bad_numbers, 6u);
    EXPECT_EQ(mesh.normals, (std::vector<float>{0, 0, 3, 0, 0, 3, 0, 0, 3}));
    EXPECT_TRUE(std::isnan(mesh.positions[0]));
    EXPECT_EQ(mesh.positions[3], kInf);
    EXPECT_EQ(mesh.positions[6], -kInf);
  }
}

TEST(Ply, WhatHasNoEndIsNotReadToIt) {
  // 16 MiB of zeros behind what looks like a beginning, which stand for the gigabytes of a sparse file:
  // messages say that reading ended where it is known what they are.
  const std::string zeros(size_t{1} << 24, '\0');
  PlyMesh mesh;
  EXPECT_EQ(parse_ply(zeros, mesh), "not a PLY file: it does not begin with \"ply\"");
  EXPECT_EQ(parse_ply("ply\nformat ascii 1.0\ncomment " + zeros, mesh),
            "the header of the PLY file has no end: it has more than 1048576 bytes, the limit ply-header-bytes");
  const std::string error = parse_ply(header("ascii", 3, kXyz, 1) + zeros, mesh);
  EXPECT_EQ(error.substr(0, 28), "PLY data has no number in \"" + std::string(1, '\0'));
}

TEST(Ply, TinyNumbersAreZeroNotErrors) {
  PlyMesh mesh;
  EXPECT_EQ(parse_ply(header("ascii", 3, kXyz, 1) + "0 0 1e-999 1 0 0 0 1 0 3 0 1 2", mesh), "");
  EXPECT_EQ(mesh.positions[2], 0);
}

TEST(Ply, GarbageAfterAnyByteNeverCrashes) {
  const std::string whole = binary_square<float, uint8_t, int32_t>(Order::Little, "float", "uchar", "int");
  uint32_t state = 1;
  for (size_t at = 0; at < whole.size(); ++at) {
    for (int k = 0; k < 8; ++k) {
      std::string s = whole;
      s[at] = static_cast<char>((state = state * 1664525u + 1013904223u) >> 24);
      PlyMesh mesh;
      if (!parse_ply(s, mesh).empty()) continue;
      for (const uint32_t i : mesh.indices) EXPECT_LT(i, mesh.positions.size() / 3);
      for (const float x : mesh.normals) EXPECT_TRUE(std::isfinite(x));
      for (const float x : mesh.uvs) EXPECT_TRUE(std::isfinite(x));
    }
  }
}

TEST(Ply, CountsAreToldByTheHeaderAndTheEnd) {
  const auto expect = [](const std::string& file, uint64_t vertices, uint64_t triangles, uint64_t floats) {
    const PlyCounts counts = count_ply(file);
    EXPECT_EQ(counts.vertices, vertices);
    EXPECT_EQ(counts.triangles, triangles);
    EXPECT_EQ(counts.floats, floats);
  };
  expect(binary_square<float, uint8_t, int32_t>(Order::Little, "float", "uchar", "int"), 4, 2, 0);
  expect(binary_square<double, uint16_t, uint16_t>(Order::Big, "double", "ushort", "ushort"), 4, 2, 0);
  const std::string points = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  expect(header("ascii", 4, kXyz, 2) + points + "3 0 1 2\n3 0 2 3\n", 4, 2, 0);
  // Of a quad there are two. The last line tells, whatever blanks stand behind it.
  expect(header("ascii", 4, kXyz, 1) + points + "4 0 1 2 3\n \n", 4, 2, 0);
  const std::string more = std::string(kXyz) + "property float nx\nproperty float ny\nproperty float nz\n" +
                           "property float u\nproperty float v\n";
  std::string quads = header("binary_little_endian", 4, more, 3);
  for (int i = 0; i < 4 * 8; ++i) quads += bytes(Order::Little, 0.5f);
  for (int i = 0; i < 3; ++i) {
    quads += '\4';
    for (int k = 0; k < 4; ++k) quads += bytes(Order::Little, k);
  }
  expect(quads, 4, 6, 5);
  // What a file cannot hold is not told, nor anything of files that are none.
  EXPECT_LT(count_ply(header("ascii", 2000000000, kXyz, 2000000000)).vertices, 1000u);
  expect("no ply at all", 0, 0, 0);
  expect(header("ascii", 0, kXyz, 0), 0, 0, 0);
  for (size_t n = 0; n < quads.size(); ++n) EXPECT_LE(count_ply(quads.substr(0, n)).triangles, 6u);
}

TEST(Ply, AttributesAreReadWhereAskedFor) {
  const std::string properties =
      std::string(kXyz) +
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\nproperty float u1\n"
      "property float v1\nproperty float tx\nproperty float ty\nproperty float tz\nproperty float tw\n";
  const auto file = [&](Order order) {
    std::string s = header(order == Order::Big ? "binary_big_endian" : "binary_little_endian", 3, properties, 1);
    for (int v = 0; v < 3; ++v) {
      for (int c = 0; c < 3; ++c) s += bytes(order, float(c == v));
      s += std::string{static_cast<char>(51), static_cast<char>(102 + v), static_cast<char>(255), 0};
      for (const float x : {0.5f + float(v), -1.0f, 1.0f, 2.0f, float(v), v == 1 ? -1.0f : 1.0f}) s += bytes(order, x);
    }
    s += static_cast<char>(3);
    for (const int i : {0, 1, 2}) s += bytes(order, i);
    return s;
  };
  for (const Order order : {Order::Little, Order::Big}) {
    PlyMesh mesh;
    ASSERT_EQ(parse_ply(file(order), mesh), "");
    EXPECT_TRUE(mesh.uvs1.empty() && mesh.colors.empty());
    EXPECT_EQ(mesh.tangents, (std::vector<float>{1, 2, 0, 1, 2, 1, 1, 2, 2}));  // surfaces themselves ask for these
    EXPECT_EQ(mesh.bitangent_signs, (std::vector<float>{1, -1, 1}));
    ASSERT_EQ(parse_ply(file(order), mesh, {.uvs1 = true, .colors = true}), "");
    EXPECT_EQ(mesh.uvs1, (std::vector<float>{0.5f, -1, 1.5f, -1, 2.5f, -1}));
    ASSERT_EQ(mesh.colors.size(), 12u);
    for (size_t v = 0; v < 3; ++v) {
      const float expected[] = {51 / 255.0f, (102 + float(v)) / 255, 1, 0};
      for (size_t c = 0; c < 4; ++c) EXPECT_EQ(mesh.colors[4 * v + c], expected[c]);
    }
    EXPECT_TRUE(mesh.uvs.empty() && mesh.normals.empty());
    EXPECT_EQ(mesh.positions[4], 1);
  }
}

TEST(Ply, AttributesInAsciiMayBeIncompleteAndUnsound) {
  // Floats as they are, alpha 1 where there is none; what is not finite is 0 and counted.
  const std::string ends = "3 0 1 2\n";
  PlyMesh mesh;
  const MeshAttributes all{.uvs1 = true, .colors = true};
  ASSERT_EQ(parse_ply(header("ascii", 3,
                             std::string(kXyz) + "property float red\nproperty float green\nproperty float blue\n"
                                                 "property float u1\nproperty float tx\nproperty float tw\n",
                             1) +
                          "0 0 0 2.5 nan 0 1 1 1\n1 0 0 0 1 inf 1 1 1\n0 1 0 0 0 0 1 1 1\n" + ends,
                      mesh, all),
            "");
  EXPECT_EQ(mesh.colors, (std::vector<float>{2.5f, 0, 0, 1, 0, 1, 0, 1, 0, 0, 0, 1}));
  EXPECT_EQ(mesh.bad_numbers, 2u);
  EXPECT_TRUE(mesh.uvs1.empty());             // v1 is missing
  EXPECT_TRUE(mesh.tangents.empty());         // ty and tz are
  EXPECT_TRUE(mesh.bitangent_signs.empty());  // and without tangents a sign says nothing
  // 16 bits, and a list by the name of a colour.
  ASSERT_EQ(
      parse_ply(header("ascii", 3,
                       std::string(kXyz) + "property ushort red\nproperty ushort green\nproperty ushort blue\n", 1) +
                    "0 0 0 65535 0 0\n1 0 0 0 13107 0\n0 1 0 0 0 0\n" + ends,
                mesh, all),
      "");
  EXPECT_EQ(mesh.colors[0], 1.0f);
  EXPECT_EQ(mesh.colors[5], 13107 / 65535.0f);
  ASSERT_EQ(
      parse_ply(
          header("ascii", 3,
                 std::string(kXyz) + "property list uchar float red\nproperty float green\nproperty float blue\n", 1) +
              "0 0 0 1 5 0 0\n1 0 0 0 0 0\n0 1 0 2 1 1 0 0\n" + ends,
          mesh, all),
      "");
  EXPECT_TRUE(mesh.colors.empty());
}

}  // namespace
}  // namespace whit
