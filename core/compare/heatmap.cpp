#include "core/compare/heatmap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/compare/small_font.h"
#include "core/image/write.h"

namespace whit {
namespace {

constexpr int kEnoughWidth = 400, kEnoughHeight = 1200;  // Up to this a picture is enlarged.
constexpr ByteColour kPaper{24, 24, 26}, kInk{228, 226, 222};

// What is drawn on, for write_image().
struct Canvas {
  int width, height;
  std::vector<float> rgb;

  Canvas(int w, int h) : width(w), height(h), rgb(3 * static_cast<size_t>(w) * static_cast<size_t>(h)) {
    fill(0, 0, w, h, kPaper);
  }
  void fill(int x0, int y0, int w, int h, const ByteColour& colour) {
    for (int y = std::max(0, y0); y < std::min(height, y0 + h); ++y)
      for (int x = std::max(0, x0); x < std::min(width, x0 + w); ++x)
        for (size_t c = 0; c < 3; ++c)
          rgb[3 * (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)) + c] =
              static_cast<float>(colour[c]) / 255;
  }
  void write(int x, int y, int dot, std::string_view text) {
    for (size_t i = 0; i < text.size(); ++i) {
      const DotLetter letter = dot_letter(text[i]);
      for (int row = 0; row < 7; ++row)
        for (int column = 0; column < 5; ++column)
          if (letter[static_cast<size_t>(row)] >> (4 - column) & 1)
            fill(x + (6 * static_cast<int>(i) + column) * dot, y + row * dot, dot, dot, kInk);
    }
  }
};

// A whole number of pixels for each of a picture's, so that a person sees something.
int enlargement(int width, int height) {
  const int wide = (kEnoughWidth + width - 1) / width;
  return std::max(1, std::min(wide, kEnoughHeight / height));
}

void draw_picture(Canvas& canvas, int left, int zoom, int width, std::span<const float> difference, HeatSign sign,
                  double full) {
  for (size_t i = 0; i < difference.size(); ++i) {
    const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
    canvas.fill(left + x * zoom, y * zoom, zoom, zoom, heat_colour(double{difference[i]}, sign, full));
  }
}

// The colours from one end to the other, numbers beneath, what they are of beside; and what green is where there is some.
void draw_bar(Canvas& canvas, int top, int dot, HeatSign sign, double full, bool has_nan) {
  const std::string what = sign == HeatSign::Absolute ? "|A-B|" : "A-B";
  const int margin = 8 * dot, thick = 8 * dot, y = top + margin;
  const int left = margin + dot * dot_width(what) + margin;
  const int right = canvas.width - margin - (has_nan ? dot * dot_width("NaN") + thick + 12 * dot : 0);
  canvas.write(margin, y + dot / 2, dot, what);
  for (int x = left; x < right; ++x) {
    const double t = (x - left) / std::max(1.0, right - left - 1.0);
    canvas.fill(x, y, 1, thick, heat_colour(full * (sign == HeatSign::Absolute ? t : 2 * t - 1), sign, full));
  }
  const bool signs = sign == HeatSign::Signed;
  for (const double t : {0.0, 0.5, 1.0}) {
    const double value = full * (signs ? 2 * t - 1 : t);
    const std::string text = value == 0 ? "0" : fmt::format("{}{:.3g}", signs && value > 0 ? "+" : "", value);
    const int wide = dot * dot_width(text), at = left + static_cast<int>(std::lround(t * (right - left - 1)));
    canvas.fill(at - dot / 2, y + thick, dot, 3 * dot, kInk);
    canvas.write(std::clamp(at - wide / 2, left, right - wide), y + thick + 5 * dot, dot, text);
  }
  if (!has_nan) return;
  canvas.fill(right + margin, y, thick, thick, kNanColour);
  canvas.write(right + margin + thick + 4 * dot, y + dot / 2, dot, "NaN");
}

}  // namespace

std::string write_heatmap(const std::string& path, const PicturePair& pair, HeatSign sign, double full) {
  const std::vector<float> difference = difference_of(pair, shown_channels(pair), sign);
  if (difference.empty()) return fmt::format("\"{}\" is not written: there are no pixels", path);
  if (!(full > 0)) full = heat_scale(difference);
  const int zoom = enlargement(pair.width(), pair.height());
  const int wide = zoom * pair.width(), high = zoom * pair.height(), dot = std::max(1, wide / 480);
  Canvas canvas(std::max(wide, kEnoughWidth * 3 / 4), high + 36 * dot);
  draw_picture(canvas, (canvas.width - wide) / 2, zoom, pair.width(), difference, sign, full);
  const bool has_nan = std::any_of(difference.begin(), difference.end(), [](float d) { return std::isnan(d); });
  draw_bar(canvas, high, dot, sign, full, has_nan);
  OutputImage image;
  image.width = canvas.width;
  image.height = canvas.height;
  image.rgb = canvas.rgb;
  return write_image(path, image).error;
}

}  // namespace whit
