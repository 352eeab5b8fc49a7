// Sources: Portable Network Graphics (PNG) Specification, 2nd ed., W3C 2003; ISO/IEC 15948.
#include "core/image/png_stream.h"

#include <isa-l/crc.h>
#include <isa-l/igzip_lib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "core/image/decode.h"

namespace whit {
namespace {

constexpr size_t kBuffer = size_t{1} << 16;
constexpr uint32_t kMost = std::numeric_limits<int32_t>::max();  // of sizes and lengths, as the standard has it

[[noreturn]] void fail(const char* reason) { throw std::runtime_error(reason); }

uint32_t word(const uint8_t* b) { return uint32_t{b[0]} << 24 | b[1] << 16 | b[2] << 8 | b[3]; }

bool is(const std::array<uint8_t, 4>& type, const char* name) { return std::memcmp(type.data(), name, 4) == 0; }

// Which bits each kind of colour may have.
bool allowed(int colour, int bits) {
  switch (colour) {
    case PngHeader::Grey: return bits == 1 || bits == 2 || bits == 4 || bits == 8 || bits == 16;
    case PngHeader::Palette: return bits == 1 || bits == 2 || bits == 4 || bits == 8;
    case PngHeader::Rgb:
    case PngHeader::GreyAlpha:
    case PngHeader::RgbAlpha: return bits == 8 || bits == 16;
    default: return false;
  }
}

}  // namespace

int PngHeader::numbers() const {
  switch (colour) {
    case Rgb: return 3;
    case GreyAlpha: return 2;
    case RgbAlpha: return 4;
    default: return 1;
  }
}

PngStream::PngStream(const PictureFile& picture)
    : file_(open_to_read(picture)), inflate_(std::make_unique<inflate_state>()), buffer_(kBuffer) {
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);  // pixels are read in larger pieces than its own
  read_header();
  find_pixels();
  isal_inflate_init(inflate_.get());
  inflate_->crc_flag = ISAL_ZLIB;
}

PngStream::~PngStream() = default;

size_t PngStream::memory() { return kBuffer + sizeof(inflate_state); }

// The next bytes of the file, which count into the chunk's sum.
void PngStream::read_file(uint8_t* to, size_t n) {
  if (std::fread(to, 1, n, file_.get()) != n)
    fail(std::ferror(file_.get()) ? std::strerror(errno) : "the file ends early");
  crc_ = crc32_gzip_refl(crc_, to, n);
}

PngStream::Chunk PngStream::begin_chunk() {
  std::array<uint8_t, 4> length;
  Chunk chunk;
  read_file(length.data(), 4);
  chunk.length = word(length.data());
  if (chunk.length > kMost) fail("a chunk claims an impossible length");
  crc_ = 0;
  read_file(chunk.type.data(), 4);
  return chunk;
}

void PngStream::end_chunk() {
  const uint32_t sum = crc_;
  std::array<uint8_t, 4> stored;
  read_file(stored.data(), 4);
  if (word(stored.data()) != sum) fail("its checksums do not fit its contents: the file is damaged");
}

std::vector<uint8_t> PngStream::small_chunk(const Chunk& chunk, size_t most) {
  if (chunk.length > most) fail("a chunk is too long");
  std::vector<uint8_t> bytes(chunk.length);
  read_file(bytes.data(), bytes.size());
  end_chunk();
  return bytes;
}

void PngStream::skip_chunk(const Chunk& chunk) {
  if (std::fseek(file_.get(), static_cast<long>(chunk.length) + 4, SEEK_CUR) != 0) fail(std::strerror(errno));
}

void PngStream::read_header() {
  std::array<uint8_t, 8> signature;
  read_file(signature.data(), signature.size());
  if (std::memcmp(signature.data(), "\x89PNG\r\n\x1a\n", 8) != 0) fail("it does not begin as PNG files do");
  const Chunk first = begin_chunk();
  if (!is(first.type, "IHDR") || first.length != 13) fail("it does not begin with a header");
  const std::vector<uint8_t> b = small_chunk(first, 13);
  const uint32_t width = word(&b[0]), height = word(&b[4]);
  if (width == 0 || height == 0 || width > kMost || height > kMost) fail("the header claims an impossible size");
  if (!allowed(b[9], b[8])) fail("the header claims a kind of pixels that PNG does not have");
  if (b[10] != 0 || b[11] != 0 || b[12] > 1) fail("the header asks for a compression that PNG does not have");
  header.width = static_cast<int>(width), header.height = static_cast<int>(height);
  header.bits = b[8], header.colour = static_cast<PngHeader::Colour>(b[9]), header.interlaced = b[12] == 1;
}

// On to the first chunk of pixels, with the palette on the way.
void PngStream::find_pixels() {
  bool has_palette = false, has_space = false;
  for (;;) {
    const Chunk chunk = begin_chunk();
    if (is(chunk.type, "IDAT")) {
      if (header.colour == PngHeader::Palette && !has_palette) fail("its palette is missing");
      left_ = chunk.length;
      return;
    }
    if (is(chunk.type, "IEND")) fail("it has no pixels");
    if (is(chunk.type, "PLTE")) {
      const std::vector<uint8_t> colours = small_chunk(chunk, palette.size());
      std::copy(colours.begin(), colours.end(), palette.begin());
      has_palette = true;
    } else if (is(chunk.type, "tRNS") && (header.colour == PngHeader::Grey || header.colour == PngHeader::Rgb)) {
      const std::vector<uint8_t> numbers = small_chunk(chunk, 2 * 3);
      if (numbers.size() != 2 * static_cast<size_t>(header.numbers())) fail("its transparent colour is not one");
      for (size_t i = 0; i < numbers.size(); i += 2) clear.push_back(numbers[i] << 8 | numbers[i + 1]);
    } else if (is(chunk.type, "tRNS") && header.colour == PngHeader::Palette) {
      const std::vector<uint8_t> alphas = small_chunk(chunk, palette_alpha.size());
      palette_alpha.fill(255);
      std::copy(alphas.begin(), alphas.end(), palette_alpha.begin());
      has_palette_alpha = true;
    } else if (is(chunk.type, "sRGB") || is(chunk.type, "iCCP")) {
      // These go before gAMA, wherever they are.
      has_space = true;
      power = 0;
      skip_chunk(chunk);
    } else if (is(chunk.type, "gAMA") && chunk.length == 4 && !has_space) {
      power = word(small_chunk(chunk, 4).data());
    } else if ((chunk.type[0] & 0x20) == 0) {
      fail("it has a critical chunk that PNG does not have");
    } else {
      skip_chunk(chunk);
    }
  }
}

// More compressed bytes; false when there are none.
bool PngStream::refill() {
  while (left_ == 0) {
    end_chunk();
    const Chunk next = begin_chunk();
    if (!is(next.type, "IDAT")) return false;
    left_ = next.length;
  }
  const auto n = static_cast<uint32_t>(std::min<size_t>(left_, buffer_.size()));
  read_file(buffer_.data(), n);
  left_ -= n;
  inflate_->next_in = buffer_.data();
  inflate_->avail_in = n;
  return true;
}

void PngStream::finish() {
  while (left_ > 0) {
    const auto n = static_cast<uint32_t>(std::min<size_t>(left_, buffer_.size()));
    read_file(buffer_.data(), n);
    left_ -= n;
  }
  end_chunk();
  // What comes behind is of no use here, but a file without its end has been cut off.
  for (;;) {
    const Chunk chunk = begin_chunk();
    if (is(chunk.type, "IEND")) return end_chunk();
    skip_chunk(chunk);
  }
}

void PngStream::read(uint8_t* to, size_t n) {
  while (n > 0) {
    const auto part = static_cast<uint32_t>(std::min<size_t>(n, size_t{1} << 30));
    inflate_->next_out = to;
    inflate_->avail_out = part;
    const int outcome = isal_inflate(inflate_.get());
    if (outcome < 0 || outcome == ISAL_NEED_DICT) fail("its compressed pixels are damaged");
    const size_t got = part - inflate_->avail_out;
    to += got, n -= got;
    if (n == 0 || inflate_->avail_out == 0) continue;
    const bool ended = inflate_->block_state == ISAL_BLOCK_FINISH;
    if (ended || (inflate_->avail_in == 0 && !refill())) fail("it has fewer pixels than its header claims");
  }
}

}  // namespace whit
