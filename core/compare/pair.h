// Two pictures made alike, ready to be compared: the same channels, the same pixels, numbers that mean the same.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/vec.h"
#include "core/compare/channels.h"
#include "core/image/planes.h"

namespace whit {

/// A channel of both pictures.
struct ComparedChannel {
  std::string name;
  ChannelKind kind = ChannelKind::Colour;
  SampleFormat a_format = SampleFormat::Float, b_format = SampleFormat::Float;  ///< What the files store.
  std::vector<float> a, b;  ///< A number for each pixel of the window, row by row, top row first.
};

/// The channels of one layer that are of one kind: R, G and B in this order where it has them, else as in the files.
struct ComparedLayer {
  std::string name;  ///< "", "Albedo"; with the channel's own name where a layer has several kinds: "A".
  ChannelKind kind = ChannelKind::Colour;
  std::vector<size_t> channels;  ///< Numbers of PicturePair::channels.
};

/// How the numbers of the colours are to be read.
enum class PairScale : uint8_t {
  Linear,   ///< Light.
  Display,  ///< Both files hold numbers for a display, on the same scale; they are compared as they are.
};

/// What is asked of reading.
struct PairRequest {
  std::string channels;      ///< Patterns (see matches_any()); "" takes all, which both must have.
  std::string colour_space;  ///< Of files with integers: a name as core/color knows it; "" takes the files'.
  bool statistics = false;   ///< Compare these channels too.
  bool crop = false;         ///< `window` is asked for.
  Box2i window{};            ///< In pixels of the display window, the maximum included.
};

struct PicturePair {
  std::string a_path, b_path;
  ImageInfo a, b;        ///< What the files' headers say.
  Box2i window{};        ///< Pixels compared, in the display window, the maximum included.
  bool cropped = false;  ///< The window is less than what both have, as was asked for.
  PairScale scale = PairScale::Linear;
  std::vector<ComparedChannel> channels;
  std::vector<ComparedLayer> layers;  ///< Of the picture: the colours "" first, statistics only where asked for.
  std::vector<std::string> notes;     ///< What was made alike, in sentences.

  int width() const { return window.max.x - window.min.x + 1; }
  int height() const { return window.max.y - window.min.y + 1; }
  size_t pixels() const { return static_cast<size_t>(width()) * static_cast<size_t>(height()); }
  /// The place in the display window of a pixel of the planes.
  Vec2i place(size_t pixel) const {
    const auto across = static_cast<size_t>(width());
    return window.min + Vec2i(static_cast<int>(pixel % across), static_cast<int>(pixel / across));
  }
  /// The channel of that name; null when there is none.
  const ComparedChannel* find(const std::string& name) const;
  /// The layer that people look at: R, G and B, else Y, else the first with colours; null when there is none.
  const ComparedLayer* beauty() const;
};

/// The pixels that a picture has, in its display window, the maximum included.
Box2i data_window(const ImageInfo& info);

/// "x 3 to 10, y 0 to 7" of pixels, the maximum included.
std::string window_text(const Box2i& box);

/// Reads both files and makes them alike. `error` says what one has and the other lacks, or which file cannot be read.
Result<PicturePair> read_pair(const std::string& a, const std::string& b, const PairRequest& request);

/// The same of pictures that have been read.
Result<PicturePair> make_pair_of(PicturePlanes a, PicturePlanes b, const std::string& a_path, const std::string& b_path,
                                 const PairRequest& request);

/// Which of the two.
enum class Side : uint8_t { A, B };

/// One picture's colours of the beauty, three a pixel (grey three times over). Empty without a beauty.
std::vector<float> interleaved_colours(const PicturePair& pair, Side side);

}  // namespace whit
