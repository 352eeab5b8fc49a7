// Cameras and lights.
#include <fmt/format.h>

#include <numbers>

#include "core/gltf/check_parts.h"

namespace whit::gltf {
namespace {

using Need = Item::Need;

void check_camera(const Item& camera) {
  const int type = camera.choice("type", std::vector<const char*>{"perspective", "orthographic"}, Need::Required);
  if (type < 0) return;
  const char* key = type == 0 ? "perspective" : "orthographic";
  if (!camera.has(key)) camera.error_at(key, "is missing");
  camera.object(key, [&](const Item& lens) {
    // A picture of one row or column has such a shape; beyond it there is none.
    constexpr Bounds kShape{1e-5, 1e5}, kSize{0, 1e30, true};
    // Everything in front of it is seen, whatever lies between these.
    const auto near = lens.number("znear", type == 0 ? kPositive : kNotNegative, Need::Required);
    const auto far = lens.number("zfar", kPositive, type == 0 ? Need::Optional : Need::Required);
    if (near && far && !(*far > *near))
      lens.error_at("zfar", fmt::format("must be above znear, {}, and is {}", *near, *far));
    if (type == 1) {
      lens.number("xmag", kSize, Need::Required), lens.number("ymag", kSize, Need::Required);
      return;
    }
    const auto yfov = lens.number("yfov", {0, std::numbers::pi, true}, Need::Required);
    if (yfov && *yfov >= std::numbers::pi) lens.error_at("yfov", "must be below pi: it is in radians");
    lens.number("aspectRatio", kShape);
  });
}

void check_light(const Item& light) {
  const int type = light.choice("type", std::vector<const char*>{"directional", "point", "spot"}, Need::Required);
  light.numbers("color", 3, kColorFactor);
  light.number("intensity", kBright);
  light.number("range", kPositive);
  if (type == 2 && !light.has("spot")) light.error_at("spot", "is missing");
  light.object("spot", [](const Item& spot) {
    constexpr double kRight = std::numbers::pi / 2, kRounding = 1e-6;
    const double inner = spot.number("innerConeAngle", {0, kRight + kRounding}).value_or(0);
    const double outer = spot.number("outerConeAngle", {0, kRight + kRounding, true}).value_or(kRight / 2);
    if (!(inner < outer + kRounding))
      spot.error_at("innerConeAngle", fmt::format("must be below outerConeAngle, {}, and is {}", outer, inner));
  });
}

}  // namespace

void check_cameras(const CheckContext& c) {
  c.root.objects("cameras", [](const Item& camera, size_t) { check_camera(camera); });
  c.root.object("extensions", [](const Item& extensions) {
    extensions.object("KHR_lights_punctual", [](const Item& e) {
      e.objects("lights", [](const Item& light, size_t) { check_light(light); });
    });
  });
}

}  // namespace whit::gltf
