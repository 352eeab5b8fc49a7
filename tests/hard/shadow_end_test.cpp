// Case 19: the far end of shadow rays. A light on a surface is not shaded by it, and a light behind a surface is, however
// little the two differ.
#include <fmt/core.h>

#include <utility>
#include <vector>

#include "tests/hard/hard_case.h"
#include "tests/hard/render_text.h"

namespace whit {
namespace {

using namespace test;

/// A quad of two triangles.
std::string quad(const std::string& corners) {
  return "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [" + corners + "]\n";
}

/// The cube [-h, h]^3, its faces outwards.
std::string cube(double h) {
  std::string p;
  for (int c = 0; c < 8; ++c)
    p += fmt::format("{:.17g} {:.17g} {:.17g} ", c & 1 ? h : -h, c & 2 ? h : -h, c & 4 ? h : -h);
  return "Shape \"trianglemesh\" \"integer indices\" [0 3 1 0 2 3  4 5 7 4 7 6  0 1 5 0 5 4  2 7 3 2 6 7  0 6 2 0 4 6\n"
         "1 3 7 1 7 5] \"point P\" [" +
         p + "]\n";
}

std::string ball(double r) { return fmt::format("Shape \"sphere\" \"float radius\" {:.9g}\n", r); }

/// In the space of its statement.
std::string area_light(const std::string& shape) {
  return "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 9 9] Material \"matte\" \"rgb Kd\" [0 0 0]\n" +
         shape + " AttributeEnd\n";
}

/// The world under a transform, seen by a camera that it takes along.
struct Moved {
  std::string there, back;
};
const std::vector<Moved> kMoves{{"", ""},
                                {"Rotate 33 1 2 3", "Rotate -33 1 2 3"},
                                {"Translate 1000 2000 3000", "Translate -1000 -2000 -3000"},
                                {"Rotate 77 3 -2 1 Scale 100 100 100", "Scale .01 .01 .01 Rotate -77 3 -2 1"}};

/// The wall z = -0.1, from (-1, 0) to (1, 1), seen from above so that nothing below y = 0 comes before it.
std::string wall_scene(const Moved& moved, const std::string& world) {
  return "Film \"image\" \"integer xresolution\" 32 \"integer yresolution\" 32\nPixelFilter \"box\"\n"
         "Sampler \"halton\" \"integer pixelsamples\" 16\nIntegrator \"whitted\" \"integer maxdepth\" 1\n"
         "LookAt 0.3 .8 4  0 .5 -.1  0 1 0 " +
         moved.back + "\nCamera \"orthographic\" \"float screenwindow\" [-.4 .4 -.4 .4]\nWorldBegin\n" + moved.there +
         "\nMaterial \"matte\" \"rgb Kd\" [.5 .5 .5]\n" + quad("-1 0 -.1  1 0 -.1  1 1 -.1  -1 1 -.1") + world +
         "WorldEnd\n";
}

TEST(Hard, LightsOnSurfaces) {
  // What touches the lights' points is black and below them, so the wall is what it is without.
  HardCase worst(
      {19, "a wall lit by a light that lies on a surface, or by a lamp that stands on one",
       "4 lights at a point, 5 lamps; on planes along the axes and tilted, disks, spheres, a cube's edge and "
       "corner, and instances of these; 4 transforms",
       "relative error against the picture without the surface", 1e-4, "ends shadow rays at 0.9999 of the way"});
  std::vector<std::string> lights;
  for (const char* kind : {"point", "goniometric", "spot"}) {
    lights.push_back(
        fmt::format("LightSource \"{}\" \"rgb I\" [1 1 1]{}\n", kind,
                    *kind == 's' ? " \"point from\" [0 0 0] \"point to\" [0 .5 -1] \"float coneangle\" 89" : ""));
  }
  lights.push_back("AttributeBegin Rotate 180 0 1 0 LightSource \"projection\" \"float fov\" 160 AttributeEnd\n");
  lights.push_back(area_light(quad(".1 0 0  -.1 0 0  -.1 .1 0  .1 .1 0")));
  lights.push_back(area_light("Translate 0 .05 0 " + ball(.05)));
  lights.push_back(area_light("Translate 0 .05 0 " + cube(.05)));
  lights.push_back(
      area_light("Rotate -90 1 0 0 Shape \"cylinder\" \"float radius\" .05 \"float zmin\" 0 \"float zmax\" .1"));
  lights.push_back(area_light("Rotate -90 1 0 0 Shape \"disk\" \"float radius\" .05"));
  const std::string black = "Material \"matte\" \"rgb Kd\" [0 0 0]\n";
  std::vector<std::string> surfaces{
      quad("-1 0 -.1  -1 0 .05  1 0 .05  1 0 -.1"),
      // Through the origin; turned by what a float's cosine of 90 degrees is off.
      quad("-1 1.74846e-7 -.1  -1 1.74846e-7 .1  1 -1.74846e-7 .1  1 -1.74846e-7 -.1"),
      "AttributeBegin Rotate -90 1 0 0 Shape \"disk\" \"float radius\" .05 AttributeEnd\n",
      "AttributeBegin Translate 0 -.3 0 " + ball(.3) + "AttributeEnd\n",
      "AttributeBegin Translate 0 -.3 .3 " + cube(.3) + "AttributeEnd\n",
      "AttributeBegin Translate .3 -.3 .3 " + cube(.3) + "AttributeEnd\n"};
  // An object has both the transform of its definition and that of its place, so it is defined outside of the world's.
  const auto instance = [&](const std::string& shape, const std::string& place) {
    return "AttributeBegin Identity ObjectBegin \"o\" " + black + shape + "ObjectEnd AttributeEnd AttributeBegin " +
           place + " ObjectInstance \"o\" AttributeEnd\n";
  };
  const std::string floor = surfaces[0];
  const std::vector<std::string> instances{
      instance(floor, ""), instance("Rotate 40 1 2 3 Scale .01 .01 .01 " + floor, "Scale 100 100 100 Rotate -40 1 2 3"),
      // Mirrored and made wider along its normal, which leaves it what it is.
      instance(floor, "Scale -1 7 1"), instance(cube(.3), "Translate 0 -.3 .3"),
      instance(ball(.3), "Translate 0 -.3 0")};
  surfaces.insert(surfaces.end(), instances.begin(), instances.end());
  for (const Moved& moved : kMoves) {
    for (size_t l = 0; l < lights.size(); ++l) {
      const Rendered alone(wall_scene(moved, lights[l]));
      for (size_t s = 0; s < surfaces.size(); ++s) {
        const Rendered touched(wall_scene(moved, lights[l] + black + surfaces[s]), {}, {}, Planned::Warnings::Allowed);
        for (size_t i = 0; i < alone.rgb().size(); ++i) {
          const double right = static_cast<double>(alone.rgb()[i]), found = static_cast<double>(touched.rgb()[i]);
          worst.see(std::abs(found - right) / (right + 1e-6), fmt::format("light {} surface {} {}", l, s, moved.there));
        }
      }
    }
  }
}

/// A floor below what may let light out of it.
std::string closed(const std::string& world) {
  return "Film \"image\" \"integer xresolution\" 48 \"integer yresolution\" 48\n"
         "Sampler \"halton\" \"integer pixelsamples\" 16\nIntegrator \"whitted\" \"integer maxdepth\" 3\n"
         "LookAt 0 -6 2  0 0 -.5  0 0 1\nCamera \"perspective\" \"float fov\" 60\nWorldBegin\n" +
         world + "Material \"matte\" \"rgb Kd\" [.8 .8 .8]\n" + quad("-6 -6 -1.5  6 -6 -1.5  6 6 -1.5  -6 6 -1.5") +
         "WorldEnd\n";
}

TEST(Hard, LampsInShells) {
  // Whatever is inside a closed opaque shell is dark outside.
  HardCase worst({19, "a lamp wholly inside an opaque shell", "balls and cubes in one another, gaps of 1e-3 to 1e-6",
                  "brightest pixel", 0, "leaks from gaps of 1e-4 on"});
  const auto see = [&](const std::string& world, const std::string& where) {
    // Shapes as near as this may be reported as coincident.
    const Rendered picture(closed(world), {}, {}, Planned::Warnings::Allowed);
    for (const float v : picture.rgb()) worst.see(static_cast<double>(v), where);
  };
  const double corner = std::sqrt(3.0);
  for (const double gap : {1e-3, 1e-4, 1e-5, 1e-6}) {
    const double inner = 1 - gap;
    const std::vector<std::pair<std::string, std::string>> pairs{
        {ball(inner), ball(1)}, {cube(inner), cube(1)}, {ball(inner), cube(1)}, {cube(inner / corner), ball(1)}};
    for (size_t i = 0; i < pairs.size(); ++i) {
      see(area_light(pairs[i].first) + pairs[i].second, fmt::format("gap {} pair {}", gap, i));
    }
  }
  for (const double gap : {1e-3, 1e-4, 1e-5}) {
    see("AttributeBegin Translate .1 .2 .3 Rotate 33 1 2 3 Scale .3 .3 .3\n" + area_light(ball(1 - gap)) + ball(1) +
            "AttributeEnd\n",
        fmt::format("gap {} turned balls", gap));
    see("AttributeBegin Rotate 33 1 2 3\n" + area_light(cube(1 - gap)) + cube(1) + "AttributeEnd\n",
        fmt::format("gap {} turned cubes", gap));
    see("ObjectBegin \"shell\" " + cube(1) + "ObjectEnd ObjectInstance \"shell\"\n" + area_light(cube(1 - gap)),
        fmt::format("gap {} instanced shell", gap));
  }
}

TEST(Hard, LightsBehindWalls) {
  // Inside a closed cube or ball, next to its surface: the floor below is dark.
  HardCase worst({19, "lights at a point behind a wall", "gaps of 1e-3 to 1e-6 inside a cube, a turned one, and a ball",
                  "brightest pixel", 0, ""});
  const std::vector<std::string> walls{cube(1), ball(1),
                                       "AttributeBegin Rotate 33 1 2 3 " + cube(1) + "AttributeEnd\n"};
  for (const double gap : {1e-3, 1e-4, 1e-5, 1e-6}) {
    for (const char* at : {"0 {} 0", "{} 0 0", "0 0 {}"}) {
      for (size_t i = 0; i < walls.size(); ++i) {
        // The light goes with its cube.
        const std::string where = fmt::format(fmt::runtime(at), fmt::format("{:.17g}", gap - 1));
        const std::string light = fmt::format(
            "AttributeBegin {} Translate {} LightSource \"point\" \"rgb I\" [99 99 99] "
            "AttributeEnd\n",
            i == 2 ? "Rotate 33 1 2 3" : "", where);
        const Rendered picture(closed(light + walls[i]));
        for (const float v : picture.rgb()) {
          worst.see(static_cast<double>(v), fmt::format("gap {} wall {} at {}", gap, i, where));
        }
      }
    }
  }
}

}  // namespace
}  // namespace whit
