#include "core/gltf/buffers.h"

#include <fmt/format.h>

#include <array>

#include "core/base/plain_text.h"

namespace whit::gltf {

size_t size_of(Component c) {
  switch (c) {
    case Component::Int8:
    case Component::Uint8: return 1;
    case Component::Int16:
    case Component::Uint16: return 2;
    case Component::Uint32:
    case Component::Float: break;
  }
  return 4;
}

Bytes Buffers::plain_view(int view) const {
  const BufferView& v = views[static_cast<size_t>(view)];
  if (v.buffer < 0) return {};
  const Bytes& b = buffers[static_cast<size_t>(v.buffer)];
  return {b.bytes.subspan(v.offset, v.length), b.owner, b.file};
}

std::string Buffers::problem() const {
  for (const Bytes& buffer : buffers) {
    const std::string problem = buffer.file ? buffer.file->problem() : std::string();
    if (!problem.empty()) return fmt::format("{}: {}", shown_text(buffer.file->path(), 300), problem);
  }
  return {};
}

std::string Buffers::view(int view, std::span<const uint8_t>& out) const {
  const BufferView& v = views[static_cast<size_t>(view)];
  if (!v.compression) {
    out = plain_view(view).bytes;
    return {};
  }
  Decoded& decoded = decoded_[static_cast<size_t>(view)];
  std::call_once(decoded.once, [&] {
    const Compression& c = *v.compression;
    const std::span<const uint8_t> source = buffers[static_cast<size_t>(c.buffer)].bytes;
    const std::string error = decompress(c, source.subspan(c.offset, c.length), decoded.bytes);
    if (!error.empty()) {
      decoded.error = fmt::format("/bufferViews/{}/extensions/EXT_meshopt_compression: {}", view, error);
    }
  });
  out = decoded.bytes;
  return decoded.error;
}

std::optional<std::vector<uint8_t>> decode_base64(std::string_view text) {
  static constexpr auto kDigits = [] {
    std::array<int8_t, 256> digits{};
    digits.fill(-1);
    constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < kAlphabet.size(); ++i)
      digits[static_cast<unsigned char>(kAlphabet[i])] = static_cast<int8_t>(i);
    return digits;
  }();
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  std::vector<uint8_t> out;
  out.reserve(text.size() / 4 * 3 + 2);
  uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int digit = kDigits[static_cast<unsigned char>(c)];
    if (digit < 0) return std::nullopt;
    bits = (bits << 6) | static_cast<uint32_t>(digit);
    if ((count += 6) < 8) continue;
    count -= 8;
    out.push_back(static_cast<uint8_t>(bits >> count));
  }
  return out;
}

}  // namespace whit::gltf
