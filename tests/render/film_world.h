// A small world for tests of films.
#pragma once

#include <string>

#include "core/session/session.h"

namespace whit::test {

/// A grey ball in front of a brighter sky, 40 x 24 pixels, with what is varied.
struct FilmWorld {
  ParsedFile file;
  BuiltWorld built;
  const Scene& scene() const { return *built.scene; }
};

inline FilmWorld film_world(const std::string& filter, const std::string& sampler = "random") {
  FilmWorld out;
  out.file = read_scene_text("scene",
                             "Film \"image\" \"integer xresolution\" [40] \"integer yresolution\" [24]\n"
                             "Camera \"perspective\" \"float fov\" [40]\n" +
                                 filter + "Sampler \"" + sampler +
                                 "\"\nWorldBegin\n"
                                 "LightSource \"infinite\" \"rgb L\" [1 2 3]\n"
                                 "Translate 0 0 5 Material \"matte\" Shape \"sphere\"\nWorldEnd\n");
  out.built = build_world(plan_world(out.file.worlds.at(0), *out.file.sources));
  return out;
}

inline constexpr const char* kGaussian = "PixelFilter \"gaussian\" \"float xwidth\" [2] \"float ywidth\" [2]\n";

}  // namespace whit::test
