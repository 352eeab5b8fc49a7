// The files that a model names.
#include "core/gltf/model_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/base/temp_folder.h"

namespace whit {
namespace {

using Names = std::vector<std::string>;

void put(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

TEST(ModelFiles, BuffersAndPictures) {
  std::filesystem::create_directory(test::temp_path("model_files"));
  const auto in_folder = [](const std::string& name) { return test::temp_path("model_files/" + name); };
  const std::string path = in_folder("m.gltf");
  put(path, R"({"buffers": [{"uri": "a%20b.bin"}, {"uri": "data:,x"}, {}], "images": [{"uri": "t/c.png"}, 3]})");
  EXPECT_EQ(files_of_model(path), (Names{in_folder("a b.bin"), in_folder("t/c.png")}));
  put(path, "{");
  EXPECT_EQ(files_of_model(path), Names{});
  // A .glb: 12 bytes of head, the length of the JSON (31) and its kind, and the JSON.
  const std::string json = R"({"buffers": [{"uri": "b.bin"}]})";
  ASSERT_EQ(json.size(), 31u);
  std::string glb("glTF\2\0\0\0\x33\0\0\0\x1f\0\0\0JSON", 20);
  glb.append(json);
  put(in_folder("m.glb"), glb);
  EXPECT_EQ(files_of_model(in_folder("m.glb")), Names{in_folder("b.bin")});
  for (size_t n = 0; n < glb.size(); ++n) {
    put(in_folder("m.glb"), glb.substr(0, n));
    EXPECT_EQ(files_of_model(in_folder("m.glb")), Names{}) << n;
  }
}

}  // namespace
}  // namespace whit
