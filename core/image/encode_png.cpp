// PNG files, encoded by libspng.
#include <spng.h>

#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <variant>

#include "core/image/encode.h"

namespace whit {
namespace {

void check(int error) {
  if (error != 0) throw std::runtime_error(spng_strerror(error));
}

std::string as_text(const OutputMetadata& m) {
  if (const auto* text = std::get_if<std::string>(&m.value)) return *text;
  if (const auto* whole = std::get_if<int>(&m.value)) return std::to_string(*whole);
  return std::to_string(std::get<float>(m.value));
}

// PNG's text entries. A keyword is at most 79 letters long; `values` keeps the texts alive until they are written.
std::vector<spng_text> text_entries(const std::vector<OutputMetadata>& metadata, std::vector<std::string>& values) {
  for (const OutputMetadata& m : metadata) values.push_back(as_text(m));
  std::vector<spng_text> entries(metadata.size());
  for (size_t i = 0; i < entries.size(); ++i) {
    metadata[i].name.copy(entries[i].keyword, sizeof entries[i].keyword - 1);
    entries[i].type = SPNG_TEXT;
    entries[i].text = values[i].data();
    entries[i].length = values[i].size();
  }
  return entries;
}

}  // namespace

std::vector<unsigned char> encode_png(const DisplayPixels& pixels) {
  const std::unique_ptr<spng_ctx, void (*)(spng_ctx*)> owner(spng_ctx_new(SPNG_CTX_ENCODER), spng_ctx_free);
  spng_ctx* const png = owner.get();
  check(spng_set_option(png, SPNG_ENCODE_TO_BUFFER, 1));
  // Noise does not compress: more effort than this takes three times as long for a file a few percent smaller, and
  // looking for anything but runs (zlib's Z_RLE) 15 to 70 % longer for one that is as large.
  constexpr int kRunLengths = 3;
  check(spng_set_option(png, SPNG_IMG_COMPRESSION_LEVEL, 2));
  check(spng_set_option(png, SPNG_IMG_COMPRESSION_STRATEGY, kRunLengths));
  check(spng_set_option(png, SPNG_FILTER_CHOICE, SPNG_FILTER_CHOICE_UP));
  spng_ihdr size{};
  size.width = static_cast<uint32_t>(pixels.width);
  size.height = static_cast<uint32_t>(pixels.height);
  size.bit_depth = static_cast<uint8_t>(pixels.bits);
  size.color_type = SPNG_COLOR_TYPE_TRUECOLOR;
  check(spng_set_ihdr(png, &size));
  check(spng_set_srgb(png, 0));  // rendering intent: perceptual
  std::vector<std::string> values;
  std::vector<spng_text> entries = text_entries(pixels.metadata, values);
  if (!entries.empty()) check(spng_set_text(png, entries.data(), static_cast<uint32_t>(entries.size())));
  check(spng_encode_image(png, pixels.bytes.data(), pixels.bytes.size(), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE));
  int error = 0;
  size_t length = 0;
  const std::unique_ptr<void, void (*)(void*)> file(spng_get_png_buffer(png, &length, &error), std::free);
  check(error);
  const auto* bytes = static_cast<const unsigned char*>(file.get());
  return {bytes, bytes + length};
}

}  // namespace whit
