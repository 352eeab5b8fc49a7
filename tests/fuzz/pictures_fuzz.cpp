// libFuzzer entry: any bytes are a picture in memory, read whole, and made a texture that is looked up. Kinds that
// have a decoder here or that scenes are known to have: png, jpeg, tga, exr, pfm.
#include <cmath>
#include <stdexcept>

#include "core/image/decode.h"
#include "core/image/mipmap.h"
#include "core/image/oiio/module.h"
#include "core/image/signature.h"
#include "tests/fuzz/shared/fuzz.h"
#include "tests/fuzz/shared/picture_mutator.h"

namespace {

using whit::fuzz::require;

/// How much memory a header may claim here: what a large one does is not what is looked for.
constexpr double kMostNumbers = 1 << 20;

bool is_wanted(const whit::PictureFile& file) {
  if (whit::kind_of_picture(file) != whit::PictureKind::Other) return true;
  const std::string begin(file.bytes->bytes.begin(),
                          file.bytes->bytes.begin() + std::min<ptrdiff_t>(4, file.bytes->bytes.size()));
  return begin.starts_with("PF\n") || begin.starts_with("Pf\n") || begin == "\x76\x2f\x31\x01";
}

void check(const whit::Image& image) {
  require(image.width > 0 && image.height > 0 && image.channels > 0);
  require(image.channel_names.size() == static_cast<size_t>(image.channels));
  require(image.pixels.size() ==
          static_cast<size_t>(image.width) * static_cast<size_t>(image.height) * static_cast<size_t>(image.channels));
  const bool is_integer = image.format == whit::SampleFormat::UInt8 || image.format == whit::SampleFormat::UInt16;
  if (!is_integer) return;
  for (const float v : image.pixels) require(v >= 0 && v <= 1);
}

void look_up(const whit::PictureFile& file, const whit::MipMapOptions& options) {
  const auto rows = whit::open_picture(file);
  const whit::MipMap map(*rows, options);
  const float s[] = {0, 0.3f, -7, 1e9f}, t[] = {1, 0.5f, 3, -1e9f}, d[] = {0, 0.1f, 2, 1e6f};
  float values[3][4];
  float* const out[] = {values[0], values[1], values[2]};
  map.lookup({4, s, t, d, d, d, d}, {}, out);
}

}  // namespace

/// Loading OpenImageIO takes seconds with sanitizers, which shall not count as an input's.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  whit::oiio();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto bytes = std::make_shared<whit::PictureBytes>();
  bytes->name = "fuzz", bytes->bytes = {data, size};
  const whit::PictureFile file(bytes);
  if (size == 0 || !is_wanted(file)) return 0;
  const auto header = whit::probe_image(file);
  const whit::ImageInfo& info = header.value;
  if (!header.ok() || double(info.width) * info.height * info.channels > kMostNumbers) return 0;
  const auto image = whit::read_image(file);
  if (!image.ok()) return 0;
  check(image.value);
  const uint8_t last = data[size - 1];
  try {
    look_up(file,
            {.single = (last & 1) != 0, .alpha = (last & 2) != 0, .gamma = (last & 4) != 0, .floats = (last & 8) != 0});
  } catch (const whit::ExceedsHalves&) {  // Who reads textures takes floats then.
  }
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  return whit::fuzz::mutate_picture(data, size, max_size, seed);
}
