#include "core/gltf/document.h"

#include <fmt/format.h>

#include <cstring>

#include "core/base/limits.h"
#include "core/base/plain_text.h"

namespace whit::gltf {
namespace {

constexpr uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
/// Objects and arrays in each other. The specification's own need a dozen; libraries call themselves for each.
constexpr int kMostNesting = 200;

uint32_t word_at(std::string_view bytes, size_t offset) {
  uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, sizeof word);
  return word;
}

/// Takes a .glb file apart.
bool split_binary(std::string_view bytes, Problems& problems, std::string_view& json, Document& out) {
  constexpr size_t kHeader = 12, kChunkHeader = 8;
  if (bytes.size() < kHeader + kChunkHeader) return problems.error({}, "the file ends in its header"), false;
  const uint32_t version = word_at(bytes, 4), length = word_at(bytes, 8);
  if (version == 1) return problems.error({}, "glTF 1.0 is not read", "re-export as glTF 2.0"), false;
  if (version != 2)
    return problems.error({}, fmt::format("the version of the file is {}, and 2 is read", version)), false;
  if (length > bytes.size() || length < kHeader + kChunkHeader) {
    problems.error({}, fmt::format("its header says that it is {} bytes long, and it has {}", length, bytes.size()));
    return false;
  }
  std::string_view rest = bytes.substr(kHeader, length - kHeader);
  for (int chunk = 0; rest.size() >= kChunkHeader; ++chunk) {
    const uint32_t size = word_at(rest, 0), type = word_at(rest, 4);
    rest.remove_prefix(kChunkHeader);
    if (size > rest.size()) {
      problems.error({}, fmt::format("chunk {} of it is {} bytes long, and {} are left", chunk, size, rest.size()));
      return false;
    }
    if (chunk == 0 && type != kJsonChunk) return problems.error({}, "its first chunk is not JSON"), false;
    if (chunk == 0) json = rest.substr(0, size);
    if (chunk == 1 && type == kBinaryChunk) {
      out.chunk = {reinterpret_cast<const uint8_t*>(rest.data()), size};
      out.has_chunk = true;
    }
    // Chunks begin at multiples of four bytes; a file without the last padding is read all the same.
    rest.remove_prefix(std::min(rest.size(), (size_t{size} + 3) / 4 * 4));
  }
  return true;
}

/// How deep objects and arrays lie in each other, as far as brackets outside of strings tell.
int nesting_of(std::string_view json) {
  int depth = 0, deepest = 0;
  bool in_string = false;
  for (size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_string) {
      // Long strings are buffers as text.
      i = json.find_first_of("\"\\", i);
      if (i == json.npos) break;
      if (json[i] == '\\') ++i;
      else in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      deepest = std::max(deepest, ++depth);
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return deepest;
}

bool parse_json(std::string_view json, Problems& problems, Json& out) {
  if (json.substr(0, 3) == "\xef\xbb\xbf") json.remove_prefix(3);
  // Some files pad with what the specification does not allow.
  while (!json.empty() && (json.back() == '\0' || json.back() == ' ')) json.remove_suffix(1);
  if (json.empty()) return problems.error({}, "there is no JSON in it"), false;
  if (json.front() != '{' && std::string_view(" \t\r\n").find(json.front()) == std::string_view::npos) {
    problems.error({}, "it is neither glTF's JSON nor a .glb file", "convert other formats to glTF 2.0 first");
    return false;
  }
  if (const int deepest = nesting_of(json); deepest > kMostNesting) {
    problems.error({},
                   fmt::format("its JSON is nested {} deep, and {} is the most that is read", deepest, kMostNesting));
    return false;
  }
  try {
    out = Json::parse(json.begin(), json.end());
  } catch (const std::exception& e) {
    problems.error({}, "its JSON is not right: " + json_message(e.what()));
    return false;
  }
  if (!out.is_object()) return problems.error({}, "its JSON is no object"), false;
  return true;
}

}  // namespace

bool read_document(const std::string& path, Problems& problems, Document& out) {
  out.file = std::make_shared<MappedFile>(path);
  if (!out.file->error().empty()) {
    problems.file_error({}, "cannot be opened: " + out.file->error(), "check the name of the file");
    return false;
  }
  const std::string_view bytes = out.file->bytes();
  if (bytes.empty()) return problems.error({}, "the file is empty"), false;
  std::string_view json = bytes;
  if (bytes.substr(0, 4) == "glTF" && !split_binary(bytes, problems, json, out)) return false;
  if (json.size() > kGltfJsonBytes.most) {
    problems.error({}, more_bytes_than(kGltfJsonBytes), "put its buffers and pictures into files of their own");
    return false;
  }
  return parse_json(json, problems, out.json);
}

}  // namespace whit::gltf
