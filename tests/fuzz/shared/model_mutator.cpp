#include <algorithm>

#include "tests/fuzz/shared/json_mutator.h"

namespace whit::fuzz {
namespace {

constexpr uint32_t kMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;

uint32_t little_endian(std::string_view bytes) {
  uint32_t value = 0;
  for (size_t i = 4; i-- > 0;) value = value << 8 | static_cast<uint8_t>(bytes[i]);
  return value;
}

void put(uint32_t value, std::string& out) {
  for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>(value >> shift);
}

/// A .glb file taken apart; `text` is the JSON.
struct Model {
  std::string text, buffer;
  bool binary = false;
};

Model model_of(const std::string& file) {
  if (file.size() < 20 || little_endian(file) != kMagic) return {file, "", false};
  const size_t length = std::min<size_t>(little_endian(file.substr(12, 4)), file.size() - 20);
  const size_t buffer = 20 + length + 8;
  return {file.substr(20, length), buffer < file.size() ? file.substr(buffer) : "", true};
}

std::string file_of(Model m) {
  if (!m.binary) return m.text;
  m.text.resize((m.text.size() + 3) / 4 * 4, ' '), m.buffer.resize((m.buffer.size() + 3) / 4 * 4);
  const size_t size = 20 + m.text.size() + (m.buffer.empty() ? 0 : 8 + m.buffer.size());
  std::string out;
  put(kMagic, out), put(2, out), put(static_cast<uint32_t>(size), out);
  put(static_cast<uint32_t>(m.text.size()), out), put(kJsonChunk, out);
  out += m.text;
  if (!m.buffer.empty()) put(static_cast<uint32_t>(m.buffer.size()), out), put(kBinaryChunk, out), out += m.buffer;
  return out;
}

}  // namespace

size_t mutate_model(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  Dice dice(seed);
  Model model = model_of(text_of(data, size));
  nlohmann::json json = nlohmann::json::parse(model.text, nullptr, false);
  if (json.is_discarded() || dice.one_in(8)) return LLVMFuzzerMutate(data, size, max_size);
  if (!model.buffer.empty() && dice.one_in(3)) {
    const size_t kept = model.buffer.size();
    model.buffer.resize(LLVMFuzzerMutate(reinterpret_cast<uint8_t*>(model.buffer.data()), kept, kept));
  } else {
    for (size_t n = 1 + dice.below(3); n > 0; --n) mutate_json(json, dice);
    model.text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  }
  return put_text(file_of(model), data, max_size);
}

}  // namespace whit::fuzz
