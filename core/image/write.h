// Writing pictures: a file appears complete under its name or not at all, and every failure is reported.
//
// .exr (linear, half or float, any number of layers) and .pfm (linear float) take linear values;
// .png .tga .jpg .jpeg .tif .tiff take values that are display-encoded already (core/color), in [0, 1].
#pragma once

#include <Imath/ImathMatrix.h>

#include <span>
#include <string>
#include <variant>
#include <vector>

namespace whit {

/// One more channel of an OpenEXR file: "Albedo.R", "N.X", "Z", "Variance.R", ...
struct OutputLayer {
  std::string name;
  std::span<const float> values;  ///< width x height, top row first; the caller keeps them alive.
  bool full_float = false;        ///< Store as 32-bit float even in a half file (positions, depths, ids).
};

/// An entry of the header: "Software", samples per pixel, render time, ... OpenEXR keeps all of them, PNG, JPEG and TIFF
/// those they have a place for, TGA and PFM none. "DateTime" ("2026:11:22 12:00:00") is written only if it is among them, so
/// that equal pictures are equal files.
struct OutputMetadata {
  std::string name;
  std::variant<std::string, float, int> value;
};

/// A matrix in the header, for row vectors: "worldToCamera", "worldToNDC".
struct OutputMatrix {
  std::string name;
  Imath::M44f value;
};

/// A picture to write, by reference: the arrays must outlive the call.
struct OutputImage {
  int width = 0, height = 0;            ///< Size of the data window: the pixels there are.
  int x = 0, y = 0;                     ///< Its upper left corner inside the display window.
  int full_width = 0, full_height = 0;  ///< The display window, from (0, 0); 0: x + width and y + height.
  std::span<const float> rgb{};         ///< height x width x 3, top row first.
  std::vector<OutputLayer> layers{};    ///< .exr only; others leave them out.
  std::vector<OutputMetadata> metadata{};
  std::vector<OutputMatrix> matrices{};  ///< .exr only, as layers.
};

struct WriteOptions {
  bool full_float = false;  ///< .exr: 32-bit float instead of half.
  int bits = 8;             ///< .png and .tiff: 8 or 16. Others have 8.
  int jpeg_quality = 95;    ///< 1 to 100.
};

/// What became of it: `error` is empty when the file is there; `warning` may say what was done differently.
struct WriteResult {
  std::string error;
  std::string warning;
  bool out_of_memory = false;  ///< The error is for lack of memory.
  bool ok() const { return error.empty(); }
};

/// True for .exr and .pfm, whose values are linear; the other formats want display-encoded ones.
bool is_linear_format(const std::string& path);

/// True for .exr, which holds any number of layers.
bool holds_layers(const std::string& path);

/// Writes the picture to `path`, whose extension (any case) chooses the format.
///
/// .exr: ZIP-compressed scanlines, half unless `full_float`; a value beyond half's range (65504), or none above its lower
/// end (6e-5), makes the whole file float, and `warning` says so. A crop is a data window inside the display window. .pfm and the
/// display formats hold the data window only, as in pbrt-v3; the latter clamp to [0, 1] and round half up, NaN is 0.
///
/// The file is written under a temporary name in the same folder and renamed when complete, so the old file
/// stays until then; on failure nothing is left behind and the error names the path and the reason.
WriteResult write_image(const std::string& path, const OutputImage& image, const WriteOptions& options = {});

/// Whether write_image could create `path` now: known extension, folder exists, permission. "" or the reason.
/// Leaves nothing behind and does not touch an existing file.
std::string check_writable(const std::string& path);

}  // namespace whit
