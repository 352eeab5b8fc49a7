// Makes glTF files of a few numbers for tests.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/gltf/model.h"
#include "tests/base/temp_folder.h"

namespace whit::test {

using Json = nlohmann::json;

class ModelBuilder {
 public:
  Json json = {{"asset", {{"version", "2.0"}}}};
  std::string bytes;  ///< Of the one buffer.

  /// The number of a new view of these bytes, which begin at a multiple of four.
  int view(const std::string& content, int stride = 0) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    Json v = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", content.size()}};
    if (stride != 0) v["byteStride"] = stride;
    bytes += content;
    json["bufferViews"].push_back(v);
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }

  template <class T>
  static std::string raw(const std::vector<T>& numbers) {
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T)};
  }

  template <class T>
  static int component_type() {
    return std::is_same_v<T, float>      ? 5126
           : std::is_same_v<T, int8_t>   ? 5120
           : std::is_same_v<T, uint8_t>  ? 5121
           : std::is_same_v<T, int16_t>  ? 5122
           : std::is_same_v<T, uint16_t> ? 5123
                                         : 5125;
  }

  /// An accessor of numbers of its own.
  template <class T>
  int accessor(const std::string& type, const std::vector<T>& numbers, bool normalized = false) {
    static const std::map<std::string, size_t> kWidths{
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
    Json a = {{"bufferView", view(raw(numbers))},
              {"componentType", component_type<T>()},
              {"type", type},
              {"count", numbers.size() / kWidths.at(type)}};
    if (normalized) a["normalized"] = true;
    return accessor(a);
  }
  int accessor(const Json& a) {
    json["accessors"].push_back(a);
    return static_cast<int>(json["accessors"].size()) - 1;
  }

  int mesh(const Json& primitive) {
    json["meshes"].push_back({{"primitives", Json::array({primitive})}});
    return static_cast<int>(json["meshes"].size()) - 1;
  }

  /// A .glb file.
  std::string glb() const {
    Json whole = json;
    std::string chunk = bytes;
    chunk.resize((chunk.size() + 3) / 4 * 4);
    if (!chunk.empty() && !whole.contains("buffers")) whole["buffers"] = Json::array({{{"byteLength", chunk.size()}}});
    std::string text = whole.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto word = [](size_t n) { return raw(std::vector<uint32_t>{static_cast<uint32_t>(n)}); };
    std::string out = "glTF" + word(2) + word(12 + 8 + text.size() + (chunk.empty() ? 0 : 8 + chunk.size()));
    out += word(text.size()) + "JSON" + text;
    if (!chunk.empty()) out += word(chunk.size()) + std::string("BIN\0", 4) + chunk;
    return out;
  }

  std::shared_ptr<const gltf::Model> load(Diagnostics& diagnostics) const {
    return gltf::load_model(write_temp("model.glb", glb()), "model.glb", {}, {}, diagnostics);
  }
  /// The same of a model without errors.
  std::shared_ptr<const gltf::Model> load() const {
    Diagnostics diagnostics;
    auto model = load(diagnostics);
    for (const Diagnostic& d : diagnostics.all()) EXPECT_EQ(d.message, "");
    EXPECT_TRUE(model);
    return model;
  }
};

/// All messages, a line each.
inline std::string messages(const Diagnostics& diagnostics) {
  std::string out;
  for (const Diagnostic& d : diagnostics.all()) out += d.message + (d.remedy.empty() ? "\n" : " (" + d.remedy + ")\n");
  return out;
}

}  // namespace whit::test
