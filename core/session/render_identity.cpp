#include "core/session/render_identity.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "core/image/checksum.h"
#include "core/session/files.h"

namespace whit {

void RenderIdentity::save(ByteWriter& out) const {
  out.value(static_cast<uint32_t>(parts.size()));
  for (const Part& p : parts) out.text(p.what), out.text(p.value);
}

void RenderIdentity::restore(ByteReader& in) {
  for (auto n = in.value<uint32_t>(); n > 0 && in.ok(); --n) {
    std::string what = in.text();
    add(std::move(what), in.text());
  }
}

RenderIdentity identity_of(const std::string& scene, const ParsedFile& file) {
  RenderIdentity identity;
  const auto sum_of = [](const std::string& path) {
    const std::optional<uint64_t> sum = file_checksum(path);
    return sum ? checksum_text(*sum) : "missing";
  };
  identity.add("the program", sum_of("/proc/self/exe"));
  uint64_t text = 0;
  for (uint32_t i = 0; i < file.sources->size(); ++i) text = checksum(file.sources->text(i), text);
  identity.add("the scene's text", checksum_text(text));
  const std::filesystem::path folder = std::filesystem::absolute(scene).parent_path();
  for (const std::string& path : assets_of(file)) {
    const std::filesystem::path in_scene = std::filesystem::path(path).lexically_proximate(folder);
    identity.add(fmt::format("the file {}", in_scene.string()), sum_of(path));
  }
  return identity;
}

std::string difference(const RenderIdentity& was, const RenderIdentity& is) {
  const size_t n = std::max(was.parts.size(), is.parts.size());
  for (size_t i = 0; i < n; ++i) {
    if (i >= was.parts.size()) return fmt::format("{} was not part of it", is.parts[i].what);
    if (i >= is.parts.size()) return fmt::format("{} was part of it", was.parts[i].what);
    const RenderIdentity::Part &a = was.parts[i], &b = is.parts[i];
    if (a == b) continue;
    if (a.what != b.what) return fmt::format("it had {}, and here is {}", a.what, b.what);
    const bool is_sum = a.value.size() == 16 || b.value.size() == 16 || b.value == "missing";
    if (is_sum) return fmt::format("{} is another one", a.what);
    const auto shown = [](const std::string& value) { return value.empty() ? std::string("none") : value; };
    return fmt::format("{} was {} and is {}", a.what, shown(a.value), shown(b.value));
  }
  return {};
}

}  // namespace whit
