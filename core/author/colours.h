// The colours in a scene file: where they are, what they look like, and how others are written.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/author/workspace.h"
#include "core/base/parameter.h"
#include "core/base/vec.h"

namespace whit::author {

/// Linear Rec.709 of a parameter that stands for a colour; nothing of others, and where its file cannot be read.
std::optional<RGB> colour_of(const Parameter& parameter, const std::string& folder);

/// "#ff8000", of the colour scaled to at most 1.
std::string srgb_hex(const RGB& colour);

struct ColourAt {
  Span values;  ///< The three numbers.
  RGB linear;
};
/// The rgb values in a span of a file.
std::vector<ColourAt> colours_in(const File& file, Span span);

/// What an editor shows: sRGB between 0 and 1. Of colours that are brighter it is the hue; `scale` is how much brighter.
struct ShownColour {
  double red = 0, green = 0, blue = 0, scale = 1;
};
ShownColour shown(const RGB& linear);
/// The numbers for a colour as shown, brighter by `scale`.
std::string written(double red, double green, double blue, double scale);

}  // namespace whit::author
