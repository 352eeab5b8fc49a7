// Numbers of accessors: every component type, normalised or not, interleaved, sparse, and matrices with padding.
#include "core/gltf/accessor.h"

#include <limits>

#include "tests/gltf_reader/model_builder.h"

namespace whit::test {
namespace {

std::vector<float> floats(const ModelBuilder& b, int accessor) {
  std::vector<float> out;
  const auto model = b.load();
  if (model) { EXPECT_EQ(gltf::read_floats(*model, accessor, out), ""); }
  return out;
}

template <class T>
void expect_component(float scale) {
  using Limits = std::numeric_limits<T>;
  const std::vector<T> numbers{Limits::min(), static_cast<T>(1), Limits::max()};
  ModelBuilder b;
  const int plain = b.accessor("SCALAR", numbers), normalized = b.accessor("SCALAR", numbers, true);
  const auto plain_floats = floats(b, plain), fractions = floats(b, normalized);
  ASSERT_EQ(plain_floats.size(), 3u);
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(plain_floats[i], static_cast<float>(numbers[i]));
  // Section 3.11: f = c / (2^b - 1), or max(c / (2^(b-1) - 1), -1).
  EXPECT_EQ(fractions[0], std::is_signed_v<T> ? -1.0f : 0.0f);
  EXPECT_EQ(fractions[1], 1 / scale);
  EXPECT_EQ(fractions[2], 1.0f);
}

TEST(GltfAccessor, EveryComponentType) {
  expect_component<int8_t>(127);
  expect_component<uint8_t>(255);
  expect_component<int16_t>(32767);
  expect_component<uint16_t>(65535);
  ModelBuilder b;
  const int integers = b.accessor("SCALAR", std::vector<uint32_t>{0, 7, 4000000000u}),
            reals = b.accessor("VEC2", std::vector<float>{1.5f, -2, 3e30f, 1e-40f});
  EXPECT_EQ(floats(b, integers), (std::vector<float>{0, 7, 4e9f}));
  EXPECT_EQ(floats(b, reals), (std::vector<float>{1.5f, -2, 3e30f, 1e-40f}));
  const auto model = b.load();
  std::vector<uint32_t> exact;
  EXPECT_EQ(gltf::read_integers(*model, integers, exact), "");
  EXPECT_EQ(exact, (std::vector<uint32_t>{0, 7, 4000000000u}));
  EXPECT_EQ(gltf::element_count(*model, reals), 2u);
  EXPECT_EQ(gltf::components_of(*model, reals), 2);
}

TEST(GltfAccessor, InterleavedElementsLieAStrideApart) {
  // Two vertices of 16 bytes: a VEC3 of floats, then a VEC2 of bytes, then padding.
  std::string content;
  for (int v = 0; v < 2; ++v) {
    content += ModelBuilder::raw(std::vector<float>{1.0f + static_cast<float>(v), 2, 3});
    content += std::string{static_cast<char>(10 + v), static_cast<char>(20), 0, 0};
  }
  ModelBuilder b;
  const int view = b.view(content, 16);
  const int positions = b.accessor(Json{{"bufferView", view}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 2}});
  const int bytes = b.accessor(
      Json{{"bufferView", view}, {"byteOffset", 12}, {"componentType", 5121}, {"type", "VEC2"}, {"count", 2}});
  EXPECT_EQ(floats(b, positions), (std::vector<float>{1, 2, 3, 2, 2, 3}));
  EXPECT_EQ(floats(b, bytes), (std::vector<float>{10, 20, 11, 20}));
}

TEST(GltfAccessor, ColumnsOfMatricesBeginAtMultiplesOfFour) {
  // A MAT2 of bytes has two bytes of padding after its first column, a MAT3 one after each but the last (section 3.6.2.4).
  ModelBuilder b;
  const int two = b.view(std::string("\1\2\0\0\3\4", 6)), three = b.view(std::string("\1\2\3\0\4\5\6\0\7\10\11", 11));
  const int a = b.accessor(Json{{"bufferView", two}, {"componentType", 5121}, {"type", "MAT2"}, {"count", 1}});
  const int c = b.accessor(Json{{"bufferView", three}, {"componentType", 5121}, {"type", "MAT3"}, {"count", 1}});
  EXPECT_EQ(floats(b, a), (std::vector<float>{1, 2, 3, 4}));
  EXPECT_EQ(floats(b, c), (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TEST(GltfAccessor, SparseValuesReplaceOthers) {
  ModelBuilder b;
  const int base = b.view(ModelBuilder::raw(std::vector<float>{1, 2, 3, 4, 5, 6}));
  const int indices = b.view(ModelBuilder::raw(std::vector<uint16_t>{0, 2})),
            values = b.view(ModelBuilder::raw(std::vector<float>{10, 20, 50, 60}));
  const Json sparse = {{"count", 2},
                       {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                       {"values", {{"bufferView", values}}}};
  const int with = b.accessor(
      Json{{"bufferView", base}, {"componentType", 5126}, {"type", "VEC2"}, {"count", 3}, {"sparse", sparse}});
  const int without = b.accessor(Json{{"componentType", 5126}, {"type", "VEC2"}, {"count", 3}, {"sparse", sparse}});
  const int zeros = b.accessor(Json{{"componentType", 5123}, {"type", "VEC3"}, {"count", 2}});
  EXPECT_EQ(floats(b, with), (std::vector<float>{10, 20, 3, 4, 50, 60}));
  EXPECT_EQ(floats(b, without), (std::vector<float>{10, 20, 0, 0, 50, 60}));
  EXPECT_EQ(floats(b, zeros), (std::vector<float>{0, 0, 0, 0, 0, 0}));
}

TEST(GltfAccessor, NumbersThatAreNotFiniteAreErrors) {
  ModelBuilder b;
  std::vector<float> numbers(9000, 1.0f);
  numbers[5001] = std::numeric_limits<float>::infinity();
  const int accessor = b.accessor("VEC3", numbers);
  std::vector<float> out;
  EXPECT_EQ(gltf::read_floats(*b.load(), accessor, out), "/accessors/0: element 1667 is not finite");
}

}  // namespace
}  // namespace whit::test
