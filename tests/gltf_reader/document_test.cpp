// Files: .glb and .gltf, what is no glTF, URIs, and what lies outside of the model's folder.
#include <sys/stat.h>

#include <filesystem>

#include "core/gltf/accessor.h"
#include "tests/gltf_reader/model_builder.h"

namespace whit::test {
namespace {

std::string load_text(const std::string& text, const gltf::LoadOptions& options = {},
                      std::shared_ptr<const gltf::Model>* out = nullptr) {
  Diagnostics diagnostics;
  const auto model = gltf::load_model(write_temp("file.gltf", text), "file.gltf", options, {}, diagnostics);
  EXPECT_EQ(model == nullptr, diagnostics.has_errors());
  if (out) *out = model;
  return messages(diagnostics);
}

void expect_message(const std::string& said, const std::string& wanted) {
  EXPECT_NE(said.find(wanted), said.npos) << wanted << " is not in\n" << said;
}

TEST(GltfDocument, NoGltf) {
  expect_message(load_text(""), "file.gltf: the file is empty");
  expect_message(load_text("solid cube\n"), "file.gltf: it is neither glTF's JSON nor a .glb file");
  expect_message(load_text("   "), "file.gltf: there is no JSON in it");
  expect_message(load_text("{"), "file.gltf: its JSON is not right: parse error at line 1, column 2");
  expect_message(load_text("{\"asset\": {\"version\": \"2.0\"}, \"scene\": 1e999}"),
                 "file.gltf: its JSON is not right: number overflow");
  expect_message(load_text("{\"asset\": {\"version\": \"\xff\"}}"), "file.gltf: its JSON is not right");
  expect_message(load_text("{\"a\":" + std::string(100000, '[') + std::string(100000, ']') + "}"),
                 "its JSON is nested 100001 deep, and 200 is the most that is read");
  EXPECT_EQ(load_text("\xef\xbb\xbf{\"asset\": {\"version\": \"2.0\"}}"), "");
  Diagnostics diagnostics;
  EXPECT_FALSE(gltf::load_model(temp_path("none.glb"), "none.glb", {}, {}, diagnostics));
  EXPECT_FALSE(gltf::load_model(temp_folder(), "folder.glb", {}, {}, diagnostics));
  const std::string pipe = temp_path("pipe.glb");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_FALSE(gltf::load_model(pipe, "pipe.glb", {}, {}, diagnostics));
  EXPECT_EQ(messages(diagnostics),
            "none.glb: cannot be opened: No such file or directory (check the name of the file)\n"
            "folder.glb: cannot be opened: Is a directory (check the name of the file)\n"
            "pipe.glb: cannot be opened: it is not a regular file (check the name of the file)\n");
  for (const Diagnostic& d : diagnostics.all()) EXPECT_EQ(d.error_class, ErrorClass::File);
}

TEST(GltfDocument, DamagedBinaryFiles) {
  ModelBuilder b;
  b.accessor("SCALAR", std::vector<float>{1, 2, 3, 4});
  const std::string whole = b.glb();
  EXPECT_EQ(load_text(whole), "");
  // Cut off anywhere it is an error, and never a crash.
  for (size_t n = 4; n < whole.size(); ++n) EXPECT_NE(load_text(whole.substr(0, n)), "");
  const auto with_word = [&](size_t offset, uint32_t word) {
    std::string changed = whole;
    std::memcpy(changed.data() + offset, &word, 4);
    return load_text(changed);
  };
  expect_message(with_word(4, 1), "file.gltf: glTF 1.0 is not read (re-export as glTF 2.0)");
  expect_message(with_word(4, 3), "file.gltf: the version of the file is 3, and 2 is read");
  expect_message(with_word(8, 4000000000u), "file.gltf: its header says that it is 4000000000 bytes long");
  expect_message(with_word(12, 4000000000u), "file.gltf: chunk 0 of it is 4000000000 bytes long");
  expect_message(with_word(16, 0), "file.gltf: its first chunk is not JSON");
}

std::string with_buffer(const std::string& uri, size_t length = 8) {
  return Json{{"asset", {{"version", "2.0"}}},
              {"buffers", {{{"uri", uri}, {"byteLength", length}}}},
              {"bufferViews", {{{"buffer", 0}, {"byteLength", 8}}}},
              {"accessors", {{{"bufferView", 0}, {"componentType", 5126}, {"type", "SCALAR"}, {"count", 2}}}}}
      .dump();
}

std::vector<float> numbers_of(const std::string& text) {
  std::shared_ptr<const gltf::Model> model;
  EXPECT_EQ(load_text(text, {}, &model), "");
  std::vector<float> out;
  if (model) { EXPECT_EQ(gltf::read_floats(*model, 0, out), ""); }
  return out;
}

TEST(GltfDocument, BuffersFromFilesAndText) {
  write_temp("my numbers.bin", ModelBuilder::raw(std::vector<float>{1, 2}));
  EXPECT_EQ(numbers_of(with_buffer("my%20numbers.bin")), (std::vector<float>{1, 2}));
  EXPECT_EQ(numbers_of(with_buffer("my numbers.bin")), (std::vector<float>{1, 2}));
  EXPECT_EQ(numbers_of(with_buffer("./here/../my numbers.bin")), (std::vector<float>{1, 2}));
  // 1.0f is 00 00 80 3f, 2.0f is 00 00 00 40.
  EXPECT_EQ(numbers_of(with_buffer("data:application/octet-stream;base64,AACAPwAAAEA=")), (std::vector<float>{1, 2}));
  EXPECT_EQ(numbers_of(with_buffer("data:;base64,AACAPwAAAEA")), (std::vector<float>{1, 2}));
  EXPECT_EQ(numbers_of(with_buffer("data:,%00%00%80%3f%00%00%00%40")), (std::vector<float>{1, 2}));
  expect_message(load_text(with_buffer("data:;base64,AACAPw*AAEA=")),
                 "file.gltf: /buffers/0/uri: is a data URI that cannot be decoded");
  expect_message(load_text(with_buffer("data:;base64")), "file.gltf: /buffers/0/uri: is a data URI without a comma");
  expect_message(load_text(with_buffer("my%20numbers.bin", 9)),
                 "file.gltf: /buffers/0/byteLength: is 9, and there are 8 bytes (the file is cut off");
  expect_message(load_text(with_buffer("none.bin")), "No such file or directory (put the file where the model has it");
  expect_message(load_text(with_buffer("a%zzb.bin")), "\"a%zzb.bin\" is no name of a file");
  expect_message(load_text(with_buffer("a%00b.bin")), "\"a%00b.bin\" is no name of a file");
  expect_message(load_text(with_buffer("https://example.com/a.bin")),
                 "\"https://example.com/a.bin\" is no file (save it beside the model");
}

TEST(GltfDocument, NothingOutsideOfTheFolderIsRead) {
  namespace fs = std::filesystem;
  const std::string inner = temp_path("inner");
  fs::create_directories(inner + "/deep");
  write_temp("secret.bin", ModelBuilder::raw(std::vector<float>{1, 2}));
  write_temp("inner/own.bin", ModelBuilder::raw(std::vector<float>{3, 4}));
  std::error_code ignored;
  fs::create_symlink("../secret.bin", inner + "/link.bin", ignored);
  fs::create_directory_symlink("..", inner + "/up", ignored);
  const std::string absolute = temp_path("secret.bin");
  for (const std::string& uri :
       {std::string("../secret.bin"), std::string("%2e%2e/secret.bin"), std::string("..%2Fsecret.bin"),
        std::string("deep/../../secret.bin"), std::string("link.bin"), std::string("up/secret.bin"), absolute,
        "file://" + absolute, "file:" + absolute}) {
    const std::string path = write_temp("inner/model.gltf", with_buffer(uri));
    Diagnostics refused, allowed;
    EXPECT_FALSE(gltf::load_model(path, "model.gltf", {}, {}, refused)) << uri;
    expect_message(messages(refused),
                   "is outside of the model's folder (put the file into the folder, or give --allow-outside if you "
                   "trust the model)");
    gltf::LoadOptions outside;
    outside.allow_outside = true;
    EXPECT_TRUE(gltf::load_model(path, "model.gltf", outside, {}, allowed)) << uri << messages(allowed);
  }
  for (const std::string& uri :
       {std::string("own.bin"), std::string("deep/../own.bin"), std::string("../inner/own.bin"), inner + "/own.bin"}) {
    Diagnostics diagnostics;
    EXPECT_TRUE(gltf::load_model(write_temp("inner/model.gltf", with_buffer(uri)), "model.gltf", {}, {}, diagnostics))
        << uri << messages(diagnostics);
  }
  // A folder whose name begins alike is another one.
  fs::create_directories(temp_path("inner2"));
  write_temp("inner2/own.bin", "12345678");
  Diagnostics diagnostics;
  EXPECT_FALSE(gltf::load_model(write_temp("inner/model.gltf", with_buffer("../inner2/own.bin")), "model.gltf", {}, {},
                                diagnostics));
}

TEST(GltfDocument, Pictures) {
  const Json model = {
      {"asset", {{"version", "2.0"}}},
      {"images",
       {{{"uri", "not%20there.JPEG"}}, {{"uri", "data:image/png;base64,iVBORw=="}}, {{"uri", "data:;base64,/9j/"}}}}};
  std::shared_ptr<const gltf::Model> loaded;
  EXPECT_EQ(load_text(model.dump(), {}, &loaded), "");
  ASSERT_TRUE(loaded);
  ASSERT_EQ(loaded->images.size(), 3u);
  EXPECT_EQ(loaded->images[0].file, std::filesystem::canonical(temp_folder()).string() + "/not there.JPEG");
  EXPECT_EQ(loaded->images[0].extension, "jpg");
  EXPECT_EQ(loaded->images[1].extension, "png");
  EXPECT_EQ(loaded->images[1].inside->bytes.size(), 4u);
  EXPECT_EQ(loaded->images[1].inside->name, "file.gltf: /images/1");
  EXPECT_EQ(loaded->images[2].extension, "jpg");
  expect_message(load_text(Json{{"asset", {{"version", "2.0"}}}, {"images", {{{"uri", "../a.png"}}}}}.dump()),
                 "file.gltf: /images/0/uri: \"../a.png\" is outside of the model's folder");
}

}  // namespace
}  // namespace whit::test
