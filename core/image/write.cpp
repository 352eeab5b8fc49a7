#include "core/image/write.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <filesystem>
#include <limits>
#include <new>

#include "core/base/plain_text.h"
#include "core/image/encode.h"
#include "core/image/oiio/module.h"

namespace whit {
namespace {

const char* const kKnown = ".exr .pfm .png .tga .jpg .jpeg .tif .tiff";

// The largest value that still rounds to a finite half.
constexpr float kHalfMax = 65504.0f;
// The smallest that a half stores with all of its digits.
constexpr float kHalfMin = 0x1p-14f;

std::string extension(const std::string& path) { return lower_case(std::filesystem::path(path).extension().string()); }

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

// NaN becomes 0: both comparisons of the clamp are false for it.
template <class T>
T quantise(float v, float most) {
  const float scaled = v * most + 0.5f;
  return static_cast<T>(scaled > 0 ? std::min(scaled, most) : 0.0f);
}

template <class T>
std::vector<unsigned char> quantise_all(std::span<const float> values) {
  constexpr float kMost = static_cast<T>(~T{0});
  std::vector<unsigned char> bytes(values.size() * sizeof(T));
  T* const out = reinterpret_cast<T*>(bytes.data());  // memory from new fits any number
#pragma omp simd
  for (size_t i = 0; i < values.size(); ++i) out[i] = quantise<T>(values[i], kMost);
  return bytes;
}

// True if a value that goes into a half channel is finite but beyond half's range.
bool exceeds_half(const OutputImage& image) {
  auto beyond = [](std::span<const float> values) {
    int found = 0;
#pragma omp simd reduction(| : found)
    for (size_t i = 0; i < values.size(); ++i) {
      const float v = std::abs(values[i]);
      found |= static_cast<int>(v > kHalfMax) & static_cast<int>(v <= std::numeric_limits<float>::max());
    }
    return found != 0;
  };
  return beyond(image.rgb) || std::any_of(image.layers.begin(), image.layers.end(),
                                          [&](const OutputLayer& l) { return !l.full_float && beyond(l.values); });
}

// True if all of the picture is below what a half stores with all its digits; much of it might be stored as 0.
bool below_half(const OutputImage& image) {
  float most = 0;
#pragma omp simd reduction(max : most)
  for (size_t i = 0; i < image.rgb.size(); ++i) most = std::max(most, std::abs(image.rgb[i]));
  return most > 0 && most < kHalfMin;
}

// Beyond half's range the whole file becomes float, which `warning` says.
void write_linear(AtomicFile& file, const std::string& path, const OutputImage& image, bool full_float,
                  std::string& warning) {
  if (!full_float && exceeds_half(image)) {
    full_float = true;
    warning = fmt::format("\"{}\" holds values above {:.0f}, the most a half can store: written as 32-bit float", path,
                          kHalfMax);
  } else if (!full_float && below_half(image)) {
    full_float = true;
    warning = fmt::format(
        "\"{}\" holds no value above {:.1e}, below which a half loses digits: written as 32-bit float", path, kHalfMin);
  }
  write_exr(file, image, full_float);
}

void write_display(AtomicFile& file, const std::string& format, const OutputImage& image, const WriteOptions& options) {
  const bool wide = options.bits == 16 && (format == "png" || format == "tif" || format == "tiff");
  DisplayPixels pixels{image.width, image.height, wide ? 16 : 8, {}, image.metadata};
  pixels.bytes = wide ? quantise_all<uint16_t>(image.rgb) : quantise_all<uint8_t>(image.rgb);
  const auto bytes = format == "png" ? encode_png(pixels) : oiio().encode(pixels, format, options.jpeg_quality);
  file.write_at(bytes.data(), bytes.size(), 0);
}

// No library at hand writes PFM. Rows go bottom to top, and the sign of the scale says
// which end of a number comes first. http://netpbm.sourceforge.net/doc/pfm.html
void write_pfm(AtomicFile& file, const OutputImage& image) {
  const uint16_t one = 1;
  const bool little = *reinterpret_cast<const unsigned char*>(&one) == 1;
  const std::string header = fmt::format("PF\n{} {}\n{}\n", image.width, image.height, little ? "-1.0" : "1.0");
  int64_t at = static_cast<int64_t>(file.write_at(header.data(), header.size(), 0));
  const size_t row = 3 * static_cast<size_t>(image.width);
  for (int y = image.height - 1; y >= 0; --y)
    at += static_cast<int64_t>(file.write_at(image.rgb.data() + row * static_cast<size_t>(y), row * sizeof(float), at));
}

// Throws a library's reason; a failure of the file itself stays in `file`, and what a library says to it is dropped.
void encode(AtomicFile& file, const std::string& path, const OutputImage& image, const WriteOptions& options,
            std::string& warning) try {
  const std::string format = extension(path).substr(1);
  if (format == "exr") write_linear(file, path, image, options.full_float, warning);
  else if (format == "pfm") write_pfm(file, image);
  else write_display(file, format, image, options);
} catch (const std::exception&) {
  if (file.failure().empty()) throw;
}

}  // namespace

bool is_linear_format(const std::string& path) {
  const std::string e = extension(path);
  return e == ".exr" || e == ".pfm";
}

bool holds_layers(const std::string& path) { return extension(path) == ".exr"; }

WriteResult write_image(const std::string& path, const OutputImage& image, const WriteOptions& options) {
  WriteResult result;
  std::string reason = extension_problem(path);
  if (reason.empty()) reason = image_problem(image);
  if (reason.empty()) {
    try {
      AtomicFile file(path);
      if (file.failure().empty()) encode(file, path, image, options, result.warning);
      reason = file.commit();
    } catch (const std::bad_alloc&) {
      result.out_of_memory = true;
      reason = "not enough memory";
    } catch (const std::exception& e) { reason = e.what(); }
  }
  if (!reason.empty()) result = {write_error(path, reason), "", result.out_of_memory};
  return result;
}

std::string check_writable(const std::string& path) {
  if (std::string reason = extension_problem(path); !reason.empty()) return write_error(path, reason);
  const AtomicFile probe(path);  // its destructor removes what it made
  return probe.failure().empty() ? "" : write_error(path, probe.failure());
}

}  // namespace whit
