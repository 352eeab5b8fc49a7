#include "core/image/write.h"

#include <Imath/half.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <exception>
#include <filesystem>

#include "core/image/atomic_file.h"

namespace whit {
namespace {

const char* const kKnown = ".exr .pfm .png .tga .jpg .jpeg .tif .tiff";

// The largest value that still rounds to a finite half.
constexpr float kHalfMax = 65504.0f;

std::string extension(const std::string& path) {
  std::string e = std::filesystem::path(path).extension().string();
  for (char& c : e) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return e;
}

std::string write_error(const std::string& path, std::string reason) {
  while (!reason.empty() && (reason.back() == '\n' || reason.back() == '.')) reason.pop_back();
  return fmt::format("cannot write \"{}\": {}", path, reason.empty() ? "unknown failure" : reason);
}

std::string extension_problem(const std::string& path) {
  static const std::vector<std::string> known{".exr", ".pfm", ".png", ".tga", ".jpg", ".jpeg", ".tif", ".tiff"};
  const std::string e = extension(path);
  if (std::find(known.begin(), known.end(), e) != known.end()) return "";
  if (e.empty()) return fmt::format("it has no extension; known are {}", kKnown);
  return fmt::format("unknown extension \"{}\"; known are {}", e, kKnown);
}

std::string image_problem(const OutputImage& image) {
  if (image.width <= 0 || image.height <= 0) return "the picture has no pixels";
  const size_t n = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  if (image.rgb.size() != 3 * n)
    return fmt::format("{} x {} pixels need {} numbers, got {}", image.width, image.height, 3 * n, image.rgb.size());
  for (const OutputLayer& layer : image.layers)
    if (layer.values.size() != n)
      return fmt::format("layer \"{}\" has {} numbers instead of {}", layer.name, layer.values.size(), n);
  return "";
}

// Lets OpenImageIO write into an AtomicFile, which keeps errno's reason for a failure.
class FileProxy : public OIIO::Filesystem::IOProxy {
 public:
  FileProxy(AtomicFile& file, const std::string& path) : IOProxy(path, Write), file_(file) {}
  // Not "file": OpenImageIO's JPEG writer takes that for its own class and casts.
  const char* proxytype() const override { return "whit"; }
  void close() override { m_mode = Closed; }
  size_t write(const void* data, size_t size) override {
    const size_t n = file_.write_at(data, size, m_pos);
    m_pos += static_cast<int64_t>(n);
    return n;
  }
  size_t read(void* data, size_t size) override {
    const size_t n = file_.read_at(data, size, m_pos);
    m_pos += static_cast<int64_t>(n);
    return n;
  }
  size_t pread(void* data, size_t size, int64_t at) override { return file_.read_at(data, size, at); }
  size_t pwrite(const void* data, size_t size, int64_t at) override { return file_.write_at(data, size, at); }
  size_t size() const override { return static_cast<size_t>(file_.size()); }

 private:
  AtomicFile& file_;
};

// Fills one row of the file, in the file's own number formats.
using RowFiller = void (*)(const OutputImage&, const OIIO::ImageSpec&, int row, unsigned char* out);

void fill_exr_row(const OutputImage& image, const OIIO::ImageSpec& spec, int row, unsigned char* out) {
  const size_t first = static_cast<size_t>(row) * image.width;
  for (size_t i = first; i < first + image.width; ++i)
    for (int c = 0; c < spec.nchannels; ++c) {
      const float v = c < 3 ? image.rgb[3 * i + c] : image.layers[c - 3].values[i];
      if (spec.channelformat(c) == OIIO::TypeDesc::HALF) {
        const uint16_t bits = Imath::half(v).bits();
        std::memcpy(out, &bits, sizeof bits);
        out += sizeof bits;
      } else {
        std::memcpy(out, &v, sizeof v);
        out += sizeof v;
      }
    }
}

// NaN becomes 0: both comparisons of the clamp are false for it.
template <class T>
T quantise(float v, float most) {
  const float scaled = v * most + 0.5f;
  return static_cast<T>(scaled > 0 ? std::min(scaled, most) : 0.0f);
}

template <class T>
void fill_display_row(const OutputImage& image, const OIIO::ImageSpec&, int row, unsigned char* out) {
  const float most = static_cast<float>(static_cast<T>(~T{0}));
  const size_t n = 3 * static_cast<size_t>(image.width), first = static_cast<size_t>(row) * n;
  for (size_t i = 0; i < n; ++i) {
    const T v = quantise<T>(image.rgb[first + i], most);
    std::memcpy(out + i * sizeof(T), &v, sizeof(T));
  }
}

void add_metadata(const OutputImage& image, OIIO::ImageSpec& spec) {
  for (const OutputMetadata& m : image.metadata)
    std::visit([&](const auto& value) { spec.attribute(m.name, value); }, m.value);
}

// Rows are converted and handed over in slabs, so that a large picture is not copied whole.
std::string write_rows(OIIO::ImageOutput& output, const OutputImage& image, const OIIO::ImageSpec& spec,
                       RowFiller fill) {
  const size_t row_bytes = spec.scanline_bytes(true);
  const int slab = 64;
  std::vector<unsigned char> buffer(row_bytes * static_cast<size_t>(std::min(slab, image.height)));
  for (int y0 = 0; y0 < image.height; y0 += slab) {
    const int y1 = std::min(y0 + slab, image.height);
    for (int y = y0; y < y1; ++y) fill(image, spec, y, buffer.data() + row_bytes * (y - y0));
    if (!output.write_scanlines(spec.y + y0, spec.y + y1, 0, OIIO::TypeDesc::UNKNOWN, buffer.data()))
      return output.geterror();
  }
  return output.close() ? "" : output.geterror();
}

// Writes through OpenImageIO; returns "" or the reason.
std::string write_with_oiio(AtomicFile& file, const std::string& path, const OutputImage& image,
                            const OIIO::ImageSpec& wanted, RowFiller fill) {
  FileProxy proxy(file, path);
  std::string reason;
  {
    auto output = OIIO::ImageOutput::create(extension(path).substr(1));
    if (!output || !output->supports("ioproxy")) return "this OpenImageIO cannot write the format";
    output->set_ioproxy(&proxy);
    OIIO::ImageSpec spec = wanted;
    if (!output->open(path, spec)) {
      reason = output->geterror();
    } else {
      // The rows are filled in the formats asked for; a writer that settles for others must not get them.
      const OIIO::ImageSpec& got = output->spec();
      if (got.format != spec.format || got.channelformats != spec.channelformats)
        reason = "this OpenImageIO cannot store the number format";
      else reason = write_rows(*output, image, spec, fill);
    }
  }
  return file.failure().empty() ? reason : file.failure();
}

// True if a value that goes into a half channel is finite but beyond half's range.
bool exceeds_half(const OutputImage& image) {
  auto beyond = [](std::span<const float> values) {
    return std::any_of(values.begin(), values.end(),
                       [](float v) { return std::isfinite(v) && std::abs(v) > kHalfMax; });
  };
  return beyond(image.rgb) || std::any_of(image.layers.begin(), image.layers.end(),
                                          [&](const OutputLayer& l) { return !l.full_float && beyond(l.values); });
}

OIIO::ImageSpec exr_spec(const OutputImage& image, bool full_float) {
  const OIIO::TypeDesc colour = full_float ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::HALF;
  OIIO::ImageSpec spec(image.width, image.height, 3 + static_cast<int>(image.layers.size()), colour);
  spec.x = image.x;
  spec.y = image.y;
  spec.full_x = spec.full_y = 0;
  spec.full_width = image.full_width > 0 ? image.full_width : image.x + image.width;
  spec.full_height = image.full_height > 0 ? image.full_height : image.y + image.height;
  spec.channelnames = {"R", "G", "B"};
  spec.alpha_channel = spec.z_channel = -1;
  bool mixed = false;
  std::vector<OIIO::TypeDesc> formats(3, colour);
  for (const OutputLayer& layer : image.layers) {
    spec.channelnames.push_back(layer.name);
    formats.push_back(layer.full_float ? OIIO::TypeDesc(OIIO::TypeDesc::FLOAT) : colour);
    mixed |= formats.back() != colour;
  }
  if (mixed) spec.channelformats = formats;
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "");  // or OpenImageIO puts the time of day, and equal pictures differ
  add_metadata(image, spec);
  return spec;
}

std::string write_exr(AtomicFile& file, const std::string& path, const OutputImage& image, const WriteOptions& options,
                      std::string& warning) {
  bool full_float = options.full_float;
  if (!full_float && exceeds_half(image)) {
    full_float = true;
    warning = fmt::format("\"{}\" holds values above {:.0f}, the most a half can store: written as 32-bit float", path,
                          kHalfMax);
  }
  return write_with_oiio(file, path, image, exr_spec(image, full_float), fill_exr_row);
}

std::string write_display(AtomicFile& file, const std::string& path, const OutputImage& image,
                          const WriteOptions& options) {
  const std::string e = extension(path);
  const bool wide = options.bits == 16 && (e == ".png" || e == ".tif" || e == ".tiff");
  OIIO::ImageSpec spec(image.width, image.height, 3, wide ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8);
  if (e == ".tif" || e == ".tiff") {
    // No colour space: it goes into an EXIF directory, which OpenImageIO 2.4 cannot write through a proxy (the file
    // comes out unreadable). An empty date, because the time of day would make equal pictures differ.
    spec.attribute("compression", "zip");
    spec.attribute("DateTime", "");
  } else {
    spec.attribute("oiio:ColorSpace", "sRGB");
  }
  if (e == ".jpg" || e == ".jpeg") spec.attribute("compression", fmt::format("jpeg:{}", options.jpeg_quality));
  if (e != ".tga") add_metadata(image, spec);  // TGA's few fields would hold half of it, and a false version
  return write_with_oiio(file, path, image, spec, wide ? fill_display_row<uint16_t> : fill_display_row<uint8_t>);
}

// OpenImageIO 2.4 reads PFM but does not write it. Rows go bottom to top, and the sign of the scale says
// which end of a number comes first. http://netpbm.sourceforge.net/doc/pfm.html
std::string write_pfm(AtomicFile& file, const OutputImage& image) {
  const uint16_t one = 1;
  const bool little = *reinterpret_cast<const unsigned char*>(&one) == 1;
  const std::string header = fmt::format("PF\n{} {}\n{}\n", image.width, image.height, little ? "-1.0" : "1.0");
  int64_t at = static_cast<int64_t>(file.write_at(header.data(), header.size(), 0));
  const size_t row = 3 * static_cast<size_t>(image.width);
  for (int y = image.height - 1; y >= 0; --y)
    at += static_cast<int64_t>(file.write_at(image.rgb.data() + row * static_cast<size_t>(y), row * sizeof(float), at));
  return file.failure();
}

}  // namespace

bool is_linear_format(const std::string& path) {
  const std::string e = extension(path);
  return e == ".exr" || e == ".pfm";
}

WriteResult write_image(const std::string& path, const OutputImage& image, const WriteOptions& options) {
  WriteResult result;
  std::string reason = extension_problem(path);
  if (reason.empty()) reason = image_problem(image);
  if (reason.empty()) {
    try {
      AtomicFile file(path);
      const std::string e = extension(path);
      if (!file.failure().empty()) reason = file.failure();
      else if (e == ".exr") reason = write_exr(file, path, image, options, result.warning);
      else if (e == ".pfm") reason = write_pfm(file, image);
      else reason = write_display(file, path, image, options);
      if (reason.empty()) reason = file.commit();
    } catch (const std::exception& e) { reason = e.what(); }
  }
  if (!reason.empty()) result = {write_error(path, reason), ""};
  return result;
}

std::string check_writable(const std::string& path) {
  if (std::string reason = extension_problem(path); !reason.empty()) return write_error(path, reason);
  const AtomicFile probe(path);  // its destructor removes what it made
  return probe.failure().empty() ? "" : write_error(path, probe.failure());
}

}  // namespace whit
