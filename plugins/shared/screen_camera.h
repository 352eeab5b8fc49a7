// What perspective and orthographic cameras share: a window on the screen, a lens, a shutter.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/plugin/camera.h"

namespace whit {

/// A camera whose film is a window on a plane. The window is x in [-1, 1] along the shorter side of the frame and
/// in proportion along the longer one, unless "screenwindow" says otherwise.
class ScreenCamera : public Camera {
 public:
  float frame_aspect = 0;       ///< Width over height; 0 is the film's own.
  FloatList screen_window;      ///< x0, x1, y0, y1 on the screen; empty is the default window.
  float lens_radius = 0;        ///< Scene units; 0 is a pinhole.
  float focal_distance = 1e6f;  ///< Scene units along z.

  void check(Diagnostics& d, SourcePos statement) override {
    if (shutter_open > shutter_close) {
      d.warning(statement, "the shutter closes before it opens", "the two times are swapped");
      std::swap(shutter_open, shutter_close);
    }
    if (needs_lens() && !(focal_distance > 0)) {
      d.error(statement, "\"focaldistance\" must be above 0 where \"lensradius\" is",
              "it is the distance at which things are sharp");
    }
    if (!screen_window.given) return;
    const auto& w = screen_window.values;
    if (w.size() != 4) {
      d.error(screen_window.where, "\"screenwindow\" needs four values: x0 x1 y0 y1");
    } else if (!(std::isfinite(w[1] - w[0]) && std::isfinite(w[3] - w[2]) && w[0] != w[1] && w[2] != w[3])) {
      d.error(screen_window.where, "\"screenwindow\" has no area");
    }
  }
  bool needs_lens() const override { return lens_radius > 0; }
  std::vector<Ineffective> ineffective() const override {
    std::vector<Ineffective> all;
    if (screen_window.given) all.push_back({"frameaspectratio", "\"screenwindow\" goes before it"});
    if (!needs_lens()) all.push_back({"focaldistance", "without a \"lensradius\" everything is sharp", "lensradius"});
    return all;
  }

 protected:
  /// Screen coordinates of film positions: screen = center + step * (film - middle), y up (step.y is negative). From
  /// the middle, so that the film's symmetry survives rounding.
  struct Screen {
    Vec2f center{0, 0}, step{0, 0}, middle{0, 0};
    float x(float film_x) const { return center.x + step.x * (film_x - middle.x); }
    float y(float film_y) const { return center.y + step.y * (film_y - middle.y); }
  };

  /// The film's map to the screen, the screen scaled by `scale`; computed in double.
  Screen screen(double scale) const {
    double w[4];
    window(w);
    const Vec2d size(film.resolution), center(0.5 * (w[0] + w[1]), 0.5 * (w[2] + w[3]));
    const Vec2d step((w[1] - w[0]) / size.x, (w[2] - w[3]) / size.y);
    return {Vec2f(center * scale), Vec2f(step * scale), Vec2f(size * 0.5)};
  }

  /// Camera::to_ndc() by a map of the film, which is on the plane z = 1 or, for parallel rays, anywhere.
  Mat4d projection(const Screen& s, bool parallel) const {
    const Vec2d size(film.resolution);
    Mat4d m;
    m[0][0] = 1 / (static_cast<double>(s.step.x) * size.x);
    m[1][1] = 1 / (static_cast<double>(s.step.y) * size.y);
    const int row = parallel ? 3 : 2;  // of what is divided by w
    m[row][0] =
        (static_cast<double>(s.middle.x) - static_cast<double>(s.center.x) / static_cast<double>(s.step.x)) / size.x;
    m[row][1] =
        (static_cast<double>(s.middle.y) - static_cast<double>(s.center.y) / static_cast<double>(s.step.y)) / size.y;
    if (parallel) return m;
    m[2][2] = m[3][3] = 0, m[2][3] = m[3][2] = 1;
    return m;
  }

 private:
  void window(double out[4]) const {
    if (screen_window.given) {
      std::copy_n(screen_window.values.begin(), 4, out);
      return;
    }
    const double film_aspect = static_cast<double>(film.resolution.x) / film.resolution.y;
    const double aspect = frame_aspect > 0 ? static_cast<double>(frame_aspect) : film_aspect;
    const double x = std::max(aspect, 1.0), y = std::max(1 / aspect, 1.0);
    out[0] = -x, out[1] = x, out[2] = -y, out[3] = y;
  }
};

/// The parameters every screen camera has.
inline auto frameaspectratio_param() {
  return param(&ScreenCamera::frame_aspect, "frameaspectratio", 0.0f, Unit::None,
               "Width over height of the default screen window; 0 takes the film's.", kNonNegative);
}
inline auto screenwindow_param() {
  return param(&ScreenCamera::screen_window, "screenwindow", Unit::None,
               "Part of the screen that fills the film: x0 x1 y0 y1. By default -1 to 1 along the shorter side.");
}
inline auto lensradius_param() {
  return param(&ScreenCamera::lens_radius, "lensradius", 0.0f, Unit::Length, "Radius of the lens; 0 is a pinhole.",
               kNonNegative);
}
inline auto focaldistance_param() {
  return param(&ScreenCamera::focal_distance, "focaldistance", 1e6f, Unit::Length,
               "Distance along z of the plane that is sharp; above 0 where there is a lens.");
}

}  // namespace whit
