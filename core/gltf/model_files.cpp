#include "core/gltf/model_files.h"

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/file_names.h"

namespace whit {
namespace {

namespace fs = std::filesystem;

/// The JSON of a model: the file, or the first chunk of a .glb. Discarded when it is no JSON (yet).
nlohmann::json json_of_model(const std::string& path) {
  std::error_code failed;
  if (!fs::is_regular_file(path, failed)) return nlohmann::json::value_t::discarded;
  std::ifstream in(path, std::ios::binary);
  std::array<unsigned char, 20> head{};
  in.read(reinterpret_cast<char*>(head.data()), head.size());
  if (!in || std::memcmp(head.data(), "glTF", 4) != 0) {
    in.clear();
    in.seekg(0);
    return nlohmann::json::parse(in, nullptr, false);
  }
  const size_t said = head[12] | head[13] << 8 | head[14] << 16 | static_cast<size_t>(head[15]) << 24;
  const auto whole = static_cast<size_t>(fs::file_size(path, failed));
  if (failed || whole < head.size() || std::memcmp(&head[16], "JSON", 4) != 0)
    return nlohmann::json::value_t::discarded;
  std::string text(std::min(said, whole - head.size()), '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  return nlohmann::json::parse(text, nullptr, false);
}

}  // namespace

std::vector<std::string> files_of_model(const std::string& path) {
  const nlohmann::json model = json_of_model(path);
  std::vector<std::string> files;
  if (!model.is_object()) return files;
  for (const char* list : {"buffers", "images"}) {
    const auto items = model.find(list);
    if (items == model.end() || !items->is_array()) continue;
    for (const nlohmann::json& item : *items) {
      const auto uri = item.is_object() ? item.find("uri") : item.end();
      if (!item.is_object() || uri == item.end() || !uri->is_string()) continue;
      const auto text = uri->get<std::string>();
      if (text.rfind("data:", 0) == 0) continue;
      files.push_back((fs::path(path).parent_path() / percent_decoded(text)).string());
    }
  }
  return files;
}

}  // namespace whit
