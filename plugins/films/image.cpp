// The picture: its size, the part of it that is rendered, and the file it goes to.

#include <algorithm>
#include <limits>

#include "core/plugin/film.h"
#include "core/plugin/registry.h"

namespace whit {
namespace {

class ImageFilm final : public Film {
 public:
  int x_resolution = 1280, y_resolution = 720;  ///< Pixels.
  FloatList crop;                               ///< x0, x1, y0, y1 in [0, 1]; empty is everything.
  float image_scale = 1;
  float diagonal = 35;  ///< Millimetres.
  float max_luminance = std::numeric_limits<float>::infinity();
  std::string file;
  std::string display_view;
  float stops = 0;
  StringList asked_aovs;

  void check(Diagnostics& d, SourcePos) override {
    if (!crop.given) return;
    if (crop.size() != 4) {
      d.error(crop.where, "\"cropwindow\" needs four values: x0 x1 y0 y1");
      return;
    }
    double c[4];
    crop_window(c);
    if (!(c[0] < c[1] && c[2] < c[3])) d.error(crop.where, "\"cropwindow\" has no area inside the picture");
  }

  Vec2i resolution() const override { return {x_resolution, y_resolution}; }
  void crop_window(double out[4]) const override {
    out[0] = out[2] = 0, out[1] = out[3] = 1;
    if (crop.size() != 4) return;
    for (int axis = 0; axis < 4; axis += 2) {
      const auto [low, high] = std::minmax(crop.values[axis], crop.values[axis + 1]);
      out[axis] = std::clamp(low, 0.0, 1.0), out[axis + 1] = std::clamp(high, 0.0, 1.0);
    }
  }
  double diagonal_metres() const override { return static_cast<double>(diagonal) * 0.001; }
  double scale() const override { return image_scale; }
  double max_sample_luminance() const override { return max_luminance; }
  const std::string& file_name() const override { return file; }
  const std::string& view() const override { return display_view; }
  double exposure() const override { return stops; }
  const StringList& aovs() const override { return asked_aovs; }
};

constexpr Range kResolution{1, 65536};

const Register<ImageFilm> image{
    "image",
    "A picture in a file.",
    param(&ImageFilm::x_resolution, "xresolution", 1280, Unit::Pixels, "Width of the picture.", kResolution),
    param(&ImageFilm::y_resolution, "yresolution", 720, Unit::Pixels, "Height of the picture.", kResolution),
    param(&ImageFilm::crop, "cropwindow", Unit::None,
          "Part of the picture that is rendered: x0 x1 y0 y1 as fractions. By default all of it."),
    param(&ImageFilm::image_scale, "scale", 1.0f, Unit::None, "Factor of all pixels."),
    param(&ImageFilm::diagonal, "diagonal", 35.0f, Unit::Millimetres, "Diagonal of the film, for realistic cameras."),
    param(&ImageFilm::max_luminance, "maxsampleluminance", std::numeric_limits<float>::infinity(), Unit::Radiance,
          "Brighter samples are dimmed to this luminance; by default none are.", kPositive),
    param(&ImageFilm::file, "filename", "", Unit::None,
          "File of the picture; its ending chooses the format. By default the scene's name with .exr."),
    param(&ImageFilm::display_view, "view", "", Unit::None,
          "Display view of the 8-bit picture: sRGB, \"ACES SDR\", exposure=E, or one of the OCIO config's. By default "
          "sRGB."),
    param(&ImageFilm::stops, "exposure", 0.0f, Unit::None, "Stops by which the 8-bit picture is brightened."),
    param(&ImageFilm::asked_aovs, "aovs", Unit::None,
          "What an .exr holds beside its colours, like \"N\" \"albedo\"; `whit help aovs` lists all.")};

}  // namespace
}  // namespace whit
