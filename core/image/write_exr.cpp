// OpenEXR files, written by OpenEXR itself.
#include <Imath/half.h>
#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>

#include <algorithm>
#include <thread>

#include "core/image/encode.h"

namespace whit {
namespace {

// Lets OpenEXR write into an AtomicFile, which keeps errno's reason for a failure.
class FileStream : public Imf::OStream {
 public:
  explicit FileStream(AtomicFile& file) : OStream("picture"), file_(file) {}
  void write(const char* data, int size) override {
    position_ += file_.write_at(data, static_cast<size_t>(size), static_cast<int64_t>(position_));
  }
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override { position_ = position; }

 private:
  AtomicFile& file_;
  uint64_t position_ = 0;
};

// A channel of the file: every `stride`th number from `first`, and how it is stored.
struct Channel {
  std::string name;
  const float* first;
  size_t stride;
  Imf::PixelType type;
  size_t bytes() const { return type == Imf::HALF ? sizeof(Imath::half) : sizeof(float); }
};

std::vector<Channel> channels(const OutputImage& image, bool full_float) {
  const Imf::PixelType colour = full_float ? Imf::FLOAT : Imf::HALF;
  std::vector<Channel> all;
  for (const size_t c : {0, 1, 2}) all.push_back({std::string(1, "RGB"[c]), image.rgb.data() + c, 3, colour});
  for (const OutputLayer& layer : image.layers)
    all.push_back({layer.name, layer.values.data(), 1, layer.full_float ? Imf::FLOAT : colour});
  return all;
}

Imf::Header header(const OutputImage& image, const std::vector<Channel>& all) {
  const int full_width = image.full_width > 0 ? image.full_width : image.x + image.width;
  const int full_height = image.full_height > 0 ? image.full_height : image.y + image.height;
  const Imath::Box2i display({0, 0}, {full_width - 1, full_height - 1});
  const Imath::Box2i data({image.x, image.y}, {image.x + image.width - 1, image.y + image.height - 1});
  Imf::Header header(display, data);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = 2;  // noise does not compress: the default of 4 takes longer for little
  for (const Channel& channel : all) header.channels().insert(channel.name, Imf::Channel(channel.type));
  for (const OutputMetadata& m : image.metadata) {
    if (const auto* text = std::get_if<std::string>(&m.value)) header.insert(m.name, Imf::StringAttribute(*text));
    if (const auto* real = std::get_if<float>(&m.value)) header.insert(m.name, Imf::FloatAttribute(*real));
    if (const auto* whole = std::get_if<int>(&m.value)) header.insert(m.name, Imf::IntAttribute(*whole));
  }
  for (const OutputMatrix& m : image.matrices) header.insert(m.name, Imf::M44fAttribute(m.value));
  return header;
}

// A number of each pixel in rows [y0, y1), as the file stores them.
void fill_slab(const Channel& channel, int width, int y0, int y1, std::vector<char>& slab) {
  const size_t first = static_cast<size_t>(y0) * width, n = static_cast<size_t>(y1 - y0) * width;
  slab.resize(n * channel.bytes());
  for (size_t i = 0; i < n; ++i) {
    const float v = channel.first[(first + i) * channel.stride];
    if (channel.type == Imf::HALF) reinterpret_cast<Imath::half*>(slab.data())[i] = Imath::half(v);
    else reinterpret_cast<float*>(slab.data())[i] = v;
  }
}

}  // namespace

void write_exr(AtomicFile& file, const OutputImage& image, bool full_float) {
  // Compression is worth threads where there is a megapixel of it; Imf's own pool starts with none.
  const bool large = image.width * static_cast<double>(image.height) > 1e6;
  if (large) Imf::setGlobalThreadCount(static_cast<int>(std::thread::hardware_concurrency()));
  const std::vector<Channel> all = channels(image, full_float);
  FileStream stream(file);
  Imf::OutputFile output(stream, header(image, all));
  // Slab by slab, so that a large picture is not copied whole.
  constexpr int kSlab = 256;
  std::vector<std::vector<char>> slabs(all.size());
  for (int y0 = 0; y0 < image.height; y0 += kSlab) {
    const int y1 = std::min(y0 + kSlab, image.height);
    Imf::FrameBuffer pixels;
    for (size_t c = 0; c < all.size(); ++c) {
      fill_slab(all[c], image.width, y0, y1, slabs[c]);
      const Imath::V2i origin(image.x, image.y + y0);
      pixels.insert(all[c].name, Imf::Slice::Make(all[c].type, slabs[c].data(), origin, image.width, y1 - y0));
    }
    output.setFrameBuffer(pixels);
    output.writePixels(y1 - y0);
  }
}

}  // namespace whit
