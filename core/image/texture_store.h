// Image textures of a scene: decoded when first looked up, shared when the same, reduced when memory is short.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "core/base/attachment.h"
#include "core/base/diagnostics.h"
#include "core/image/texture_kinds.h"

namespace whit {

/// Everything that makes an image texture; two equal specs are one texture.
struct TextureSpec {
  std::string path;
  std::shared_ptr<const PictureBytes> bytes;  ///< Where not null, the picture; `path` is then not looked at.
  TextureKind kind = TextureKind::Rgb;
  TextureChannel channel = TextureChannel::Luminance;  ///< Float only.
  WrapMode wrap = WrapMode::Repeat;
  std::optional<bool> gamma = false;  ///< Decode sRGB; if it is not said, by default_gamma().
  float scale = 1;
  TextureFilter filter = TextureFilter::Ewa;
  float max_anisotropy = 8;  ///< EWA only.
  bool flip = true;          ///< t = 0 is the bottom row (imagemap); lights take false.
};

/// What happened so far; memory in bytes.
struct TextureStatistics {
  size_t resident_bytes = 0, peak_bytes = 0;  ///< Of texels, and of what is being decoded.
  int64_t files = 0;                          ///< Of which anything was decoded.
  int64_t decodes = 0;
  int64_t decoded_bytes = 0;  ///< Of the levels that decoding kept, all decodes together.
  double decode_seconds = 0;  ///< Processor time of decoding, from opening a file to its levels.
  int64_t trims = 0;          ///< Times that levels nobody had looked up were given up.
  int64_t evictions = 0;      ///< Times that all of a texture was, or went into a file.
  int64_t returns = 0;        ///< Times that it came back from there.
  int64_t lookups = 0;        ///< Points looked up.
};

class MipMap;
class TextureMemory;
class TextureSource;

/// One image texture: a handle that a TextureStore made and owns. Lookups may come from any thread; results
/// depend on their own point only, to the bit. Linear Rec.709 values, unless the file holds something else.
class ImageTexture {
 public:
  /// n filtered RGB values. The derivatives of st along the screen's x and y may all be null: bilinear at the
  /// finest level, unless the filter is Point. A texture of one channel gives r = g = b. A file that cannot be decoded gives black, and the store
  /// keeps the error.
  void lookup(int n, const float* s, const float* t, const float* dsdx, const float* dtdx, const float* dsdy,
              const float* dtdy, float* r, float* g, float* b) const;

  /// n filtered numbers: TextureSpec::channel of a Float texture, the luminance of an RGB one.
  void lookup_float(int n, const float* s, const float* t, const float* dsdx, const float* dtdx, const float* dsdy,
                    const float* dtdy, float* out) const;

  /// n RGB values, trilinear over a square of side `width` in st (pbrt's Lookup(st, width)).
  void lookup_width(int n, const float* s, const float* t, const float* width, float* r, float* g, float* b) const;

  /// The decoded pyramid, for callers that scan it (a light's sampling table); kept alive by the pointer. Null when the
  /// file cannot be decoded.
  std::shared_ptr<const MipMap> pyramid() const;

  const TextureSpec& spec() const { return spec_; }

 private:
  friend class TextureStore;
  ImageTexture(TextureMemory& memory, TextureSource& source, TextureSpec spec);
  template <class Look>
  bool with_pyramid(int n, const Look& look) const;
  template <class Look>
  void look_up_rgb(int n, const std::array<float*, 3>& out, const Look& look) const;

  TextureMemory& memory_;
  TextureSource& source_;
  TextureSpec spec_;
};

/// Owns the textures of a scene. Thread-safe. Handles live as long as the store.
class TextureStore {
 public:
  static constexpr size_t kDefaultMemory = size_t{1} << 30;

  TextureStore();
  ~TextureStore();
  TextureStore(const TextureStore&) = delete;
  TextureStore& operator=(const TextureStore&) = delete;

  /// The texture of that spec, made on first request; reads nothing (check the file with probe_image).
  /// `where` is the place of the file's name, for errors(). From here on the file has to stay what it is until it is no
  /// longer read: one that was written to or replaced is an error, since a picture would show both.
  const ImageTexture* add(const TextureSpec& spec, SourcePos where = {});

  /// The most bytes (kDefaultMemory unless set) that texels and what is being decoded may take. Before there would be
  /// more, levels finer than anyone has looked up are dropped, to be decoded again when needed; then whole textures, the
  /// least recently used first, go into a nameless file in $TMPDIR or /var/tmp and come back from there, or are dropped
  /// too where it has no room. One in use stays until its lookup ends; the latest decoded stays in any case.
  void set_memory_limit(size_t bytes);

  TextureStatistics statistics() const;

  /// Whether the files of all textures are still what they were when these were added, by size and time. Otherwise it is
  /// time for another store.
  bool is_current() const;

  /// Reads the pictures of all textures and keeps none: errors() then knows every one that cannot be decoded.
  void read_all();

  /// True once a texture could not be decoded. Cheap, for a render to ask now and then.
  bool failed() const;

  /// Why textures could not be decoded, one each naming the file; empty when all is well.
  Diagnostics errors() const;

 private:
  struct Textures;
  std::unique_ptr<TextureMemory> memory_;
  std::unique_ptr<Textures> textures_;
};

}  // namespace whit
