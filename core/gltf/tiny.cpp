#include "core/gltf/tiny.h"

#include <limits>

namespace whit::gltf {
namespace {

/// What tinygltf is shown. It looks at accessors only to see that those of indices exist and have a buffer view, which they
/// need not have; and some builds of it would decode Draco's meshes, so that their extension is shown under another name.
Json shown_part(const Json& checked) {
  Json out = Json::object();
  for (auto it = checked.begin(); it != checked.end(); ++it) {
    if (it.key() == "buffers" || it.key() == "images" || it.key() == "bufferViews" || it.key() == "extras") continue;
    if (it.key() != "accessors") {
      out[it.key()] = it.value();
      continue;
    }
    out["bufferViews"] = Json::array({{{"buffer", 0}, {"byteLength", 1}}});
    const Json plain = {{"bufferView", 0}, {"componentType", 5126}, {"count", 1}, {"type", "SCALAR"}};
    out["accessors"] = Json(it.value().size(), plain);
  }
  if (!out.contains("meshes")) return out;
  for (Json& mesh : out["meshes"]) {
    if (!mesh.contains("primitives")) continue;
    for (Json& primitive : mesh["primitives"]) {
      const auto extensions = primitive.find("extensions");
      if (extensions == primitive.end() || !extensions->contains("KHR_draco_mesh_compression")) continue;
      (*extensions)[kDracoShown] = std::move((*extensions)["KHR_draco_mesh_compression"]);
      extensions->erase("KHR_draco_mesh_compression");
    }
  }
  return out;
}

tinygltf::FsCallbacks no_files() {
  return {[](const std::string&, void*) { return false; }, [](const std::string& path, void*) { return path; },
          [](std::vector<unsigned char>*, std::string*, const std::string&, void*) { return false; },
          [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; }, nullptr};
}

bool no_picture(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
  return true;
}

}  // namespace

std::unique_ptr<const tinygltf::Model> parse_typed(const Json& checked, std::string& problem) {
  try {
    const std::string text = shown_part(checked).dump();
    if (text.size() > std::numeric_limits<unsigned>::max()) return problem = "its JSON is too long", nullptr;
    tinygltf::TinyGLTF reader;
    reader.SetFsCallbacks(no_files());
    reader.SetImageLoader(no_picture, nullptr);
    auto model = std::make_unique<tinygltf::Model>();
    std::string warning;
    if (reader.LoadASCIIFromString(model.get(), &problem, &warning, text.data(), static_cast<unsigned>(text.size()),
                                   "")) {
      return model;
    }
  } catch (const std::exception& e) { problem = e.what(); }
  if (problem.empty()) problem = "tinygltf cannot read it";
  return nullptr;
}

const tinygltf::Value* member(const tinygltf::Value& object, const char* key) {
  return object.Has(key) ? &object.Get(key) : nullptr;
}

const tinygltf::Value* member(const tinygltf::ExtensionMap& extensions, const char* key) {
  const auto found = extensions.find(key);
  return found == extensions.end() ? nullptr : &found->second;
}

double number(const tinygltf::Value& object, const char* key, double otherwise) {
  const tinygltf::Value* value = member(object, key);
  return value && value->IsNumber() ? value->GetNumberAsDouble() : otherwise;
}

int integer(const tinygltf::Value& object, const char* key, int otherwise) {
  const tinygltf::Value* value = member(object, key);
  return value && value->IsInt() ? value->GetNumberAsInt() : otherwise;
}

std::vector<double> numbers(const tinygltf::Value& object, const char* key) {
  std::vector<double> out;
  const tinygltf::Value* value = member(object, key);
  for (size_t i = 0; value && i < value->ArrayLen(); ++i)
    out.push_back(value->Get(static_cast<int>(i)).GetNumberAsDouble());
  return out;
}

std::string text(const tinygltf::Value& object, const char* key) {
  const tinygltf::Value* value = member(object, key);
  return value && value->IsString() ? value->Get<std::string>() : std::string();
}

}  // namespace whit::gltf
