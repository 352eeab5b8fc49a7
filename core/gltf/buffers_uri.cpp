// URIs: data, and files that lie with the model.
#include <fmt/format.h>

#include <charconv>
#include <filesystem>

#include "core/gltf/buffers.h"

namespace whit::gltf {
namespace {

/// Undoes %20 and the like; nullopt when what follows a % is no byte.
std::optional<std::string> without_escapes(std::string_view uri) {
  std::string out;
  for (size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      out += uri[i];
      continue;
    }
    unsigned byte = 0;
    const std::string_view digits = uri.substr(i + 1, 2);
    const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
    if (digits.size() != 2 || code != std::errc() || end != digits.data() + 2) return std::nullopt;
    out += static_cast<char>(byte);
    i += 2;
  }
  return out;
}

/// "https" of a URI that begins with a scheme, else "". One letter is a drive.
std::string_view scheme_of(std::string_view uri) {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
  const size_t colon = uri.find(':');
  if (colon == uri.npos || colon < 2 || kLetters.find(uri.front()) == kLetters.npos) return {};
  const std::string_view scheme = uri.substr(0, colon);
  return scheme.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789+-.") == scheme.npos
             ? scheme
             : std::string_view{};
}

/// The path of "file:///path" and "file:path".
std::string without_scheme(const std::string& name) {
  if (scheme_of(name).empty()) return name;
  const std::string path = name.substr(name.find(':') + 1);
  const size_t slashes = path.find_first_not_of('/');
  return slashes == path.npos || slashes < 2 ? path : path.substr(slashes - 1);
}

/// "data:image/png;base64,...".
std::optional<Resource> read_data(std::string_view uri, const Item& item, const char* key) {
  const size_t comma = uri.find(',');
  if (comma == uri.npos) return item.error_at(key, "is a data URI without a comma"), std::nullopt;
  const std::string_view head = uri.substr(5, comma - 5), body = uri.substr(comma + 1);
  Resource out;
  out.mime_type = head.substr(0, head.find(';'));
  constexpr std::string_view kBase64 = ";base64";
  if (head.size() >= kBase64.size() && head.substr(head.size() - kBase64.size()) == kBase64) {
    out.data = decode_base64(body);
  } else if (const auto plain = without_escapes(body)) {
    out.data = std::vector<uint8_t>(plain->begin(), plain->end());
  }
  if (!out.data) return item.error_at(key, "is a data URI that cannot be decoded"), std::nullopt;
  return out;
}

/// The path without links, so that none leads out of the folder unseen. Parts that do not exist stay as they are.
std::optional<std::filesystem::path> resolved(const std::filesystem::path& path) {
  std::error_code problem;
  const auto out = std::filesystem::weakly_canonical(path, problem);
  if (problem) return std::nullopt;
  return out;
}

bool is_below(const std::filesystem::path& path, const std::filesystem::path& folder) {
  auto p = path.begin();
  for (const auto& part : folder) {
    if (part.empty()) continue;  // After a last slash.
    if (p == path.end() || *p != part) return false;
    ++p;
  }
  return true;
}

}  // namespace

std::optional<Resource> resolve(const Item& item, const char* key, const std::string& folder,
                                const LoadOptions& options) {
  if (!item.value()[key].is_string()) return item.error_at(key, "must be a string"), std::nullopt;
  const std::string& uri = item.value()[key].get_ref<const std::string&>();
  if (uri.substr(0, 5) == "data:") return read_data(uri, item, key);
  const std::string_view scheme = scheme_of(uri);
  if (!scheme.empty() && scheme != "file") {
    item.error_at(key, fmt::format("{} is no file", shown_text(uri)),
                  "save it beside the model and name it without folders");
    return std::nullopt;
  }
  const auto name = without_escapes(uri);
  if (!name || name->empty() || name->find('\0') != name->npos) {
    return item.error_at(key, fmt::format("{} is no name of a file", shown_text(uri))), std::nullopt;
  }
  const auto path = resolved(std::filesystem::path(folder) / without_scheme(*name));
  if (!path) return item.error_at(key, fmt::format("{} is no name of a file", shown_text(uri))), std::nullopt;
  if (!options.allow_outside && !is_below(*path, folder)) {
    item.error_at(key, fmt::format("{} is outside of the model's folder", shown_text(uri)),
                  "put the file into the folder, or give --allow-outside if you trust the model");
    return std::nullopt;
  }
  Resource out;
  out.file = path->string();
  return out;
}

}  // namespace whit::gltf
