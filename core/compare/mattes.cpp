#include "core/compare/mattes.h"

#include <bit>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/plain_text.h"

namespace whit {
namespace {

// The manifest of the cryptomatte of that name: "cryptomatte/KEY/name" says which KEY it has.
std::string manifest_of(const ImageInfo& info, const std::string& matte) {
  for (const auto& [entry, value] : info.metadata) {
    if (entry.rfind("cryptomatte/", 0) != 0 || value != matte || entry.size() < 5) continue;
    if (entry.compare(entry.size() - 5, 5, "/name") != 0) continue;
    const auto manifest = info.metadata.find(entry.substr(0, entry.size() - 4) + "manifest");
    if (manifest != info.metadata.end()) return manifest->second;
  }
  return "";
}

// From the bits of a float that stands for a name to the name.
std::map<uint32_t, std::string> names_of(const std::string& manifest) {
  std::map<uint32_t, std::string> names;
  const auto json = nlohmann::json::parse(manifest, nullptr, false);
  if (!json.is_object()) return names;
  for (const auto& [name, hash] : json.items())
    if (hash.is_string())
      names[static_cast<uint32_t>(std::strtoul(hash.get<std::string>().c_str(), nullptr, 16))] = name;
  return names;
}

Matte make_matte(const ComparedChannel& ids, const std::map<uint32_t, std::string>& names) {
  Matte matte;
  std::map<uint32_t, int> numbers;
  for (const auto& [id, name] : names) {
    numbers[id] = static_cast<int>(matte.names.size());
    matte.names.push_back(name);
  }
  matte.pixels.reserve(ids.a.size());
  for (size_t i = 0; i < ids.a.size(); ++i) {
    const auto a = std::bit_cast<uint32_t>(ids.a[i]), b = std::bit_cast<uint32_t>(ids.b[i]);
    const auto number = numbers.find(b);
    matte.pixels.push_back(a == b && number != numbers.end() ? number->second : -1);
  }
  return matte;
}

}  // namespace

std::optional<Matte> find_matte(const PicturePair& pair) {
  // By what people call things: objects before what they are made of.
  for (const char* kind : {"object", "shape", "asset", "material", ""})
    for (const ComparedChannel& ids : pair.channels) {
      if (!is_first_matte_rank(ids.name) || lower_case(layer_of(ids.name)).find(kind) == std::string::npos) continue;
      const std::string layer = layer_of(ids.name), name = layer.substr(0, layer.size() - 2);
      std::map<uint32_t, std::string> names = names_of(manifest_of(pair.b, name));
      names.merge(names_of(manifest_of(pair.a, name)));
      if (!names.empty()) return make_matte(ids, names);
    }
  return std::nullopt;
}

}  // namespace whit
