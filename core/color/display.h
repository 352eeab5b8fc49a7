// From linear light to the values of a display, through OpenColorIO. Only core/color includes OpenColorIO.
//
// Without a configuration of the user's, one is built in code. Its scene_linear is linear Rec.709, its display
// is sRGB, and its views are
//   sRGB        the default and what pbrt-v3 writes: the exact sRGB curve, clamped to [0, 1]. 0.18 -> 0.461.
//   ACES SDR    the ACES 1.x output transform for 100 cd/m2 (OpenColorIO's SDR-VIDEO_1.0). 0.18 -> 0.356.
//   exposure=e  1 - exp(-L / (1 - e)) for each channel, 0 <= e < 1, whose result is the light the display emits
//               and is therefore sRGB-encoded. e = 0 is the plain curve 1 - exp(-L); larger e is brighter.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace whit {

/// Which transform is wanted.
struct DisplaySpec {
  std::string config_path;  ///< An OpenColorIO config; empty: the one $OCIO names, else the built-in.
  std::string view;         ///< A view of the default display, or "Display/View"; empty: the default view.
  float exposure = 0;       ///< In stops: values are multiplied by 2^exposure first.
  std::string input_space = "scene_linear";  ///< Colour space or role of the pixels in the config.
};

struct DisplayResult;

/// A view of a display, ready to apply. Immutable: any number of threads may use it at once.
class DisplayTransform {
 public:
  ~DisplayTransform();

  /// Replaces n linear pixels (RGB interleaved) by display-encoded values in [0, 1]. Values may be of any size and sign;
  /// NaN counts as 0, and infinity as very bright. A result does not depend on the other pixels.
  void apply(float* rgb, size_t n_pixels) const;

  /// For the log: "sRGB (built-in)", "Film (sRGB display, studio.ocio), +1 stops".
  std::string describe() const;

  /// The views one may ask for, as they are spelt in DisplaySpec::view.
  std::vector<std::string> view_names() const;

 private:
  friend DisplayResult make_display_transform(const DisplaySpec& spec);
  struct Impl;
  explicit DisplayTransform(std::unique_ptr<const Impl> impl);
  std::unique_ptr<const Impl> impl_;
};

/// A transform, or the text that says why there is none.
struct DisplayResult {
  std::unique_ptr<const DisplayTransform> transform;
  std::string error;
  bool bad_config = false;  ///< The error is the config's, rather than of what is asked of it.
};

/// Makes the transform. The config is spec.config_path, else the file $OCIO names, else the built-in one. Errors: an
/// unreadable config, an unknown view (the text lists the known ones), e outside [0, 1), exposure not finite.
DisplayResult make_display_transform(const DisplaySpec& spec);

}  // namespace whit
