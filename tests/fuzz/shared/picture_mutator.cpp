#include "tests/fuzz/shared/picture_mutator.h"

#include <zlib.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/shared/fuzz.h"

namespace whit::fuzz {
namespace {

constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
constexpr std::string_view kNames[] = {"IHDR", "PLTE", "tRNS", "IDAT", "IEND", "gAMA", "sRGB", "zTXt"};

struct Chunk {
  std::string name, data;
};

uint32_t big_endian(std::string_view bytes) {
  uint32_t value = 0;
  for (const char c : bytes.substr(0, 4)) value = value << 8 | static_cast<uint8_t>(c);
  return value;
}

std::string big_endian(uint32_t value) {
  std::string out;
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift);
  return out;
}

std::vector<Chunk> chunks_of(std::string_view png) {
  std::vector<Chunk> all;
  for (png.remove_prefix(kSignature.size()); png.size() >= 12;) {
    const size_t length = std::min<size_t>(big_endian(png), png.size() - 12);
    all.push_back({std::string(png.substr(4, 4)), std::string(png.substr(8, length))});
    png.remove_prefix(12 + length);
  }
  return all;
}

std::string png_of(const std::vector<Chunk>& chunks) {
  std::string out(kSignature);
  for (const Chunk& c : chunks) {
    const std::string checked = c.name + c.data;
    const auto sum = crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
    out += big_endian(static_cast<uint32_t>(c.data.size())) + checked + big_endian(static_cast<uint32_t>(sum));
  }
  return out;
}

void mutate_bytes(std::string& text) {
  const size_t size = text.size();
  text.resize(size + 16);
  text.resize(LLVMFuzzerMutate(reinterpret_cast<uint8_t*>(text.data()), size, text.size()));
}

/// At most this much is unpacked: a seed has less.
constexpr size_t kMostUnpacked = 1 << 16;

/// Changes what is packed in a chunk rather than its bytes, of which most make it unreadable.
void mutate_packed(std::string& data) {
  std::string unpacked(kMostUnpacked, '\0');
  uLongf size = kMostUnpacked;
  auto* const to = reinterpret_cast<Bytef*>(unpacked.data());
  if (uncompress(to, &size, reinterpret_cast<const Bytef*>(data.data()), data.size()) != Z_OK)
    return mutate_bytes(data);
  unpacked.resize(size);
  mutate_bytes(unpacked);
  uLongf packed = compressBound(unpacked.size());
  data.resize(packed);
  compress2(reinterpret_cast<Bytef*>(data.data()), &packed, reinterpret_cast<const Bytef*>(unpacked.data()),
            unpacked.size(), 1);
  data.resize(packed);
}

/// Sizes that fit the data are small; depth, colour and interlacing have few values each.
void mutate_header(std::string& data, Dice& dice) {
  constexpr uint8_t kDepths[] = {1, 2, 4, 8, 16, 3}, kColours[] = {0, 2, 3, 4, 6, 1};
  if (data.size() != 13) return mutate_bytes(data);
  switch (dice.below(4)) {
    case 0: data.replace(4 * dice.below(2), 4, big_endian(static_cast<uint32_t>(dice.below(20)))); break;
    case 1: data[8] = static_cast<char>(dice.one_of(kDepths)); break;
    case 2: data[9] = static_cast<char>(dice.one_of(kColours)); break;
    default: data[12] = static_cast<char>(dice.below(3));
  }
}

void mutate_chunks(std::vector<Chunk>& chunks, Dice& dice) {
  if (chunks.empty()) return;
  const size_t i = dice.below(chunks.size()), j = dice.below(chunks.size());
  Chunk& chunk = chunks[i];
  switch (dice.below(10)) {
    case 0: std::swap(chunks[i], chunks[j]); break;
    case 1: chunks.insert(chunks.begin() + static_cast<std::ptrdiff_t>(i), Chunk(chunks[j])); break;
    case 2: chunks.erase(chunks.begin() + static_cast<std::ptrdiff_t>(i)); break;
    case 3: chunk.name = dice.one_of(kNames); break;
    default:
      if (chunk.name == "IHDR") mutate_header(chunk.data, dice);
      else if (chunk.name == "IDAT" && !dice.one_in(4)) mutate_packed(chunk.data);
      else mutate_bytes(chunk.data);
  }
}

}  // namespace

size_t mutate_picture(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  Dice dice(seed);
  const std::string text = text_of(data, size);
  if (!text.starts_with(kSignature) || dice.one_in(8)) return LLVMFuzzerMutate(data, size, max_size);
  std::vector<Chunk> chunks = chunks_of(text);
  for (size_t n = 1 + dice.below(3); n > 0; --n) mutate_chunks(chunks, dice);
  return put_text(png_of(chunks), data, max_size);
}

}  // namespace whit::fuzz
